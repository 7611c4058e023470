#include "hs/menu.h"
#include "hs/error.h"

#include <stdio.h>
#include <string.h>

static void print_menu(const struct hs_menu *menu, FILE *out)
{
    fprintf(out, "%s: %s\n\nUsage: %s COMMAND [options]\n\nCommands:\n", menu->program,
            menu->purpose, menu->program);
    for (int i = 0; i < menu->count; i++) {
        fprintf(out, "  %-9s  %s\n", menu->commands[i].name, menu->commands[i].help);
    }
    fprintf(out, "\n`%s COMMAND --help` explains a command.\n%s", menu->program,
            menu->closing ? menu->closing : "");
}

int hs_menu_main(const struct hs_menu *menu, int argc, char **argv)
{
    hs_set_program(menu->program);
    if (argc < 2) {
        print_menu(menu, stderr);
        return HS_EXIT_USAGE;
    }
    if (strcmp(argv[1], "--help") == 0) {
        print_menu(menu, stdout);
        return HS_EXIT_OK;
    }
    for (int i = 0; i < menu->count; i++) {
        if (strcmp(argv[1], menu->commands[i].name) == 0) {
            if (menu->start) {
                menu->start();
            }
            return menu->commands[i].run(argc - 1, argv + 1);
        }
    }
    char remedy[96];
    snprintf(remedy, sizeof remedy, "see %s --help", menu->program);
    hs_error(argv[1], remedy, "there is no such command");
    return HS_EXIT_USAGE;
}
