/* landmass-target: the radar picture of a model by ray tracing and a law of reflection. */
#include "commands.h"

#include "hs/error.h"

#include <malloc.h>
#include <stdio.h>
#include <string.h>

static const struct command {
    const char *name, *help;
    int (*run)(int argc, char **argv);
} commands[] = {
    {"model", "check a model, describe it, draw it, write it as OBJ", target_cmd_model},
    {"trace", "trace a model and keep every reflection", target_cmd_trace},
    {"render", "make the radar picture of a model, or of traced records", target_cmd_render},
    {"sheet", "draw a model and its radar picture side by side, over azimuth", target_cmd_sheet},
    {"curves", "draw the reflection laws: paper B, Figures 3 to 6", target_cmd_curves},
    {"materials", "print the built-in surfaces in the form of a file", target_cmd_materials},
    {"bench", "measure rays a second, beside bare Embree", target_cmd_bench},
};
enum { COMMANDS = sizeof commands / sizeof commands[0] };

static void print_menu(FILE *out)
{
    fputs(
        "landmass-target: the radar picture of a target, from its model\n\n"
        "Usage: landmass-target COMMAND [options]\n\nCommands:\n",
        out);
    for (int i = 0; i < COMMANDS; i++) {
        fprintf(out, "  %-9s  %s\n", commands[i].name, commands[i].help);
    }
    fputs(
        "\n`landmass-target COMMAND --help` explains a command.\n"
        "landmass-netem learns the reflection from real chips.\n",
        out);
}

int main(int argc, char **argv)
{
    hs_set_program("landmass-target");
    /* Keep the memory of one picture for the next: having it cleared again costs as much as
     * tracing. */
    mallopt(M_MMAP_THRESHOLD, 32 << 20);
    mallopt(M_TRIM_THRESHOLD, 1 << 30);
    if (argc < 2) {
        print_menu(stderr);
        return HS_EXIT_USAGE;
    }
    if (strcmp(argv[1], "--help") == 0) {
        print_menu(stdout);
        return HS_EXIT_OK;
    }
    for (int i = 0; i < COMMANDS; i++) {
        if (strcmp(argv[1], commands[i].name) == 0) {
            return commands[i].run(argc - 1, argv + 1);
        }
    }
    hs_error(argv[1], "see landmass-target --help", "there is no such command");
    return HS_EXIT_USAGE;
}
