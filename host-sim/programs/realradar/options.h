/* Command lines of landmass-realradar. */
#ifndef REALRADAR_OPTIONS_H
#define REALRADAR_OPTIONS_H

#include <getopt.h>

/* Read options that all take a text into `values[option.val]`. `options` ends with the help option
 * ('h') and a null. Prints `help` when asked for it. Returns:
 * - HS_EXIT_OK: go on; optind is the first argument that is no option,
 * - -1: the help was printed,
 * - HS_EXIT_USAGE: the error was reported. */
int rr_read_options(int argc, char **argv, const struct option *options, const char *help,
                    const char **values);

#endif
