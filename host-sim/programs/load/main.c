/* landmass-load: a new database for a panel that is in the field. */
#include "commands.h"
#include "hs/menu.h"

int main(int argc, char **argv)
{
    static const struct hs_command commands[] = {
        {"put", "put a database into the slot that is not flown, and switch to it", load_cmd_put},
        {"send", "send a database to a panel over USB", load_cmd_send},
        {"receive", "a panel: take databases from a PC over USB", load_cmd_receive},
        {"show", "what each slot holds, and which one is flown next", load_cmd_show},
        {"verify", "check each slot record by record", load_cmd_verify},
    };
    const struct hs_menu menu = {.program = "landmass-load",
                                 .purpose = "a new database for a panel that is in the field",
                                 .commands = commands,
                                 .count = sizeof commands / sizeof commands[0]};
    return hs_menu_main(&menu, argc, argv);
}
