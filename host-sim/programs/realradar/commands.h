/* The two sub-commands of landmass-realradar. Each reads its own command line, argv[0] being its
 * name, and returns an exit code of hs/error.h. */
#ifndef REALRADAR_COMMANDS_H
#define REALRADAR_COMMANDS_H

#include <getopt.h>

/* A picture and the statistics of speckle and points, beside the firmware's. */
int rr_cmd_focus(int argc, char **argv);

/* Order and spread of the classes of a database beside a radar's picture. */
int rr_cmd_classes(int argc, char **argv);

/* Read options that all take a text into `values[option.val]`. Returns HS_EXIT_OK to go on, -1
 * after
 * --help, or HS_EXIT_USAGE with the error reported. `options` ends with the help option ('h') and a
 * null. */
int rr_read_options(int argc, char **argv, const struct option *options, const char *help,
                    const char **values);

/* Make the folder, if need be, and write "folder/name" into `path`. Returns 0, or -1 with the error
 * reported. */
int rr_output_path(char *path, unsigned size, const char *folder, const char *name);

#endif
