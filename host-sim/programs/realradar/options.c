#include "options.h"

#include "hs/error.h"

#include <stdio.h>

int rr_read_options(int argc, char **argv, const struct option *options, const char *help,
                    const char **values)
{
    opterr = 0;
    optind = 1;
    for (int c; (c = getopt_long(argc, argv, "h", options, NULL)) != -1;) {
        if (c == 'h') {
            fputs(help, stdout);
            return -1;
        }
        if (c == '?') {
            hs_error(argv[0], "see landmass-realradar COMMAND --help",
                     "has an unknown option, or one without its value");
            return HS_EXIT_USAGE;
        }
        values[c] = optarg;
    }
    return HS_EXIT_OK;
}
