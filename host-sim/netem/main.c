/* landmass-netem: reflection learned from radar pictures. */
#include "commands.h"
#include "gdal_start.h"

#include "hs/error.h"

#include <stdio.h>
#include <string.h>

static const struct command {
    const char *name, *help;
    int (*run)(int argc, char **argv);
} commands[] = {
    {"register", "find from where chips were taken that do not say so", nm_cmd_register},
    {"train", "learn the reflection of a target from real chips", nm_cmd_train},
    {"score", "simulated chips beside real ones: MSE, SSIM, CW-SSIM and a picture", nm_cmd_score},
    {"simulate", "chips of any aspect by what was learned", nm_cmd_simulate},
    {"plot", "draw what was learned: loss, reflection curves, kernels", nm_cmd_plot},
    {"recover", "hide a law in made chips, learn it, and tell how well it was found",
     nm_cmd_recover},
    {"response", "impulse response and speckle beside a real radar's", nm_cmd_response},
    {"paper", "the whole experiment of the paper on the full MSTAR set", nm_cmd_paper},
};
enum { COMMANDS = sizeof commands / sizeof commands[0] };

static void print_menu(FILE *out)
{
    fputs(
        "landmass-netem: reflection learned from radar pictures\n\n"
        "Usage: landmass-netem COMMAND [options]\n\nCommands:\n",
        out);
    for (int i = 0; i < COMMANDS; i++) {
        fprintf(out, "  %-9s %s\n", commands[i].name, commands[i].help);
    }
    fputs("\n`landmass-netem COMMAND --help` explains a command; docs/netem.md the method.\n", out);
}

int main(int argc, char **argv)
{
    hs_set_program("landmass-netem");
    if (argc < 2) {
        print_menu(stderr);
        return HS_EXIT_USAGE;
    }
    if (strcmp(argv[1], "--help") == 0) {
        print_menu(stdout);
        return HS_EXIT_OK;
    }
    db_gdal_start();
    for (int i = 0; i < COMMANDS; i++) {
        if (strcmp(argv[1], commands[i].name) == 0) {
            return commands[i].run(argc - 1, argv + 1);
        }
    }
    hs_error(argv[1], "see landmass-netem --help", "there is no such command");
    return HS_EXIT_USAGE;
}
