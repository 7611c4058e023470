#include "hs/menu.h"

#include "hs/error.h"
#include "hs/report.h"
#include "lm/version.h"
#include "manual.h"

#include <stdbool.h>
#include <stdio.h>
#include <string.h>

static void print_menu(const struct hs_menu *menu, FILE *out)
{
    fprintf(out, "%s: %s\n\nUsage: %s COMMAND [options]\n\nCommands:\n", menu->program,
            menu->purpose, menu->program);
    for (int i = 0; i < menu->count; i++) {
        fprintf(out, "  %-9s  %s\n", menu->commands[i].name, menu->commands[i].help);
    }
    fprintf(out,
            "\n`%s COMMAND --help` explains a command, --help=man as a manual page.\n"
            "--version prints the version.\n%s",
            menu->program, menu->closing ? menu->closing : "");
}

static void print_list(const struct hs_menu *menu)
{
    for (int i = 0; i < menu->count; i++) {
        printf("%s\t\t\n", menu->commands[i].name);
    }
    printf("--help\t\t\n--version\t\t\n");
}

static void print_manual(const struct hs_menu *menu)
{
    manual_begin("", menu->purpose);
    printf(".SH SYNOPSIS\n.B ");
    manual_text(menu->program);
    printf(
        "\n.I COMMAND\n[options]\n.SH DESCRIPTION\nEach command has a manual page of its own.\n");
    manual_paragraphs(menu->closing ? menu->closing : "");
    printf(".SH COMMANDS\n");
    for (int i = 0; i < menu->count; i++) {
        printf(".TP\n\\fB");
        manual_text(menu->program);
        manual_text("-");
        manual_text(menu->commands[i].name);
        printf("\\fR(1)\n");
        manual_text(menu->commands[i].help);
        printf("\n");
    }
    manual_exit_status();
}

/* Print what `word` asks for, as hs_options_explain does. */
static bool explain(const struct hs_menu *menu, const char *word)
{
    if (strcmp(word, "--help") == 0 || strcmp(word, "-h") == 0) {
        print_menu(menu, stdout);
    } else if (strcmp(word, "--help=man") == 0) {
        print_manual(menu);
    } else if (strcmp(word, "--help=list") == 0) {
        print_list(menu);
    } else if (strcmp(word, "--version") == 0) {
        printf("%s %s\n", menu->program, LM_VERSION);
    } else {
        return false;
    }
    return true;
}

int hs_menu_main(const struct hs_menu *menu, int argc, char **argv)
{
    hs_set_program(menu->program);
    if (argc < 2) {
        print_menu(menu, stderr);
        return HS_EXIT_USAGE;
    }
    if (explain(menu, argv[1])) {
        return HS_EXIT_OK;
    }
    for (int i = 0; i < menu->count; i++) {
        if (strcmp(argv[1], menu->commands[i].name) == 0) {
            if (menu->start) {
                menu->start();
            }
            return hs_report_end(menu->commands[i].run(argc - 1, argv + 1));
        }
    }
    char remedy[96];
    snprintf(remedy, sizeof remedy, "see %s --help", menu->program);
    hs_error(argv[1], remedy, "there is no such command");
    return HS_EXIT_USAGE;
}
