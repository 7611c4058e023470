/* landmass-realradar: the simulation beside real radar. */
#include "commands.h"

#include "hs/error.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

static const char menu[] =
    "usage: landmass-realradar COMMAND [OPTIONS]\n"
    "Compare what the display unit draws with what real radars measured.\n"
    "\n"
    "Commands:\n"
    "  focus     make a picture of a real phase history; score speckle and points against\n"
    "            theory and the firmware\n"
    "  classes   rank and spread of the classes of a database beside a real radar picture\n"
    "\n"
    "`landmass-realradar COMMAND --help` explains a command; docs/realradar.md the results.\n"
    "Exit status: 0 done, 1 the work failed, 2 the command line makes no sense.\n";

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

int rr_output_path(char *path, unsigned size, const char *folder, const char *name)
{
    if (mkdir(folder, 0777) != 0 && errno != EEXIST) {
        return hs_error(folder, "check the folder above it", "cannot be made: %s", strerror(errno));
    }
    const int length = snprintf(path, size, "%s/%s", folder, name);
    return length > 0 && (unsigned)length < size
               ? 0
               : hs_error(folder, "use a shorter name", "the path is too long");
}

int main(int argc, char **argv)
{
    hs_set_program("landmass-realradar");
    const char *command = argc > 1 ? argv[1] : "";
    if (strcmp(command, "--help") == 0 || strcmp(command, "-h") == 0) {
        fputs(menu, stdout);
        return HS_EXIT_OK;
    }
    if (strcmp(command, "focus") == 0) {
        return rr_cmd_focus(argc - 1, argv + 1);
    }
    if (strcmp(command, "classes") == 0) {
        return rr_cmd_classes(argc - 1, argv + 1);
    }
    hs_error("command line", "see landmass-realradar --help",
             argc > 1 ? "there is no command '%s'" : "names no command%s", command);
    return HS_EXIT_USAGE;
}
