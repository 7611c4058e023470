/* landmass-realradar: the simulation beside real radar. */
#include "commands.h"

#include "hs/menu.h"

int main(int argc, char **argv)
{
    static const struct hs_command commands[] = {
        {"focus", "make a picture of a real phase history; score speckle and points", rr_cmd_focus},
        {"classes", "rank and spread of the classes of a database beside a real radar picture",
         rr_cmd_classes},
    };
    const struct hs_menu menu = {.program = "landmass-realradar",
                                 .purpose =
                                     "compare what the display draws with what radars measured",
                                 .commands = commands,
                                 .count = sizeof commands / sizeof commands[0],
                                 .closing = "docs/realradar.md has the results.\n"};
    return hs_menu_main(&menu, argc, argv);
}
