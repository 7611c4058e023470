/* landmass-db: from imagery, exemplars and terrain to the database image of the display unit. */
#include "commands.h"
#include "gdal_start.h"

#include "hs/error.h"

#include <stdio.h>
#include <string.h>

struct command {
    const char *name;
    const char *help;
    int (*run)(int argc, char **argv);
};

static const struct command commands[] = {
    {"train", "learn the classes of an image from exemplar pixels", db_cmd_train},
    {"segment", "give each pixel of an image its class", db_cmd_segment},
    {"correct", "apply manual corrections to a class raster", db_cmd_correct},
    {"reflect", "give each pixel its radar reflectivity", db_cmd_reflect},
    {"build", "make the database image from classes, reflectivity and terrain", db_cmd_build},
    {"inspect", "print what a database image holds", db_cmd_inspect},
    {"verify", "check every byte of a database image", db_cmd_verify},
    {"picture", "draw a plane of a database image", db_cmd_picture},
};

enum { COMMAND_COUNT = sizeof commands / sizeof commands[0] };

static void print_menu(FILE *out)
{
    fputs(
        "landmass-db: build the radar database of the display unit\n\n"
        "Usage: landmass-db COMMAND [options]\n\nCommands:\n",
        out);
    for (int i = 0; i < COMMAND_COUNT; i++) {
        fprintf(out, "  %-9s %s\n", commands[i].name, commands[i].help);
    }
    fputs("\n`landmass-db COMMAND --help` explains a command.\n", out);
}

int main(int argc, char **argv)
{
    hs_set_program("landmass-db");
    if (argc < 2) {
        print_menu(stderr);
        return HS_EXIT_USAGE;
    }
    if (strcmp(argv[1], "--help") == 0) {
        print_menu(stdout);
        return HS_EXIT_OK;
    }
    db_gdal_start();
    for (int i = 0; i < COMMAND_COUNT; i++) {
        if (strcmp(argv[1], commands[i].name) == 0) {
            return commands[i].run(argc - 1, argv + 1);
        }
    }
    hs_error(argv[1], "see landmass-db --help", "there is no such command");
    return HS_EXIT_USAGE;
}
