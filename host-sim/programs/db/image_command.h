/* Command line of the sub-commands that look at an image: FILE first, then options. */
#ifndef DB_IMAGE_COMMAND_H
#define DB_IMAGE_COMMAND_H

#include "hs/options.h"

/* Take FILE from argv[1] and read the options after it, as db_options_read does; `usage->command`
 * should name FILE for --help. Returns true when the command shall go on, with *path borrowed from
 * argv. */
bool image_command_read(const struct db_usage *usage, const struct db_option *options, size_t count,
                        int argc, char **argv, const char **path, int *exit_code);

#endif
