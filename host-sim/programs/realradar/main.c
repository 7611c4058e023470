/* landmass-realradar: the simulation beside real radar. */
#include "commands.h"

#include "hs/error.h"

#include <stdio.h>
#include <string.h>

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
