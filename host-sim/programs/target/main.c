/* landmass-target: the radar picture of a model by ray tracing and a law of reflection. */
#include "commands.h"

#include "hs/menu.h"

#include <malloc.h>

static const struct hs_command commands[] = {
    {"model", "check a model, describe it, draw it, write it as OBJ", target_cmd_model},
    {"trace", "trace a model and keep every reflection", target_cmd_trace},
    {"render", "make the radar picture of a model, or of traced records", target_cmd_render},
    {"map", "tell which part of a model made each point of its picture", target_cmd_map},
    {"sheet", "draw a model and its radar picture side by side, over azimuth", target_cmd_sheet},
    {"bake", "make the signature of a model, for the display unit", target_cmd_bake},
    {"curves", "draw the reflection laws: Niu and others, Figures 3 to 6", target_cmd_curves},
    {"materials", "print the built-in surfaces in the form of a file", target_cmd_materials},
    {"bench", "measure rays a second, beside bare Embree", target_cmd_bench},
};

int main(int argc, char **argv)
{
    /* Keep the memory of one picture for the next: having it cleared again costs as much as
     * tracing. */
    mallopt(M_MMAP_THRESHOLD, 32 << 20);
    mallopt(M_TRIM_THRESHOLD, 1 << 30);
    const struct hs_menu menu = {.program = "landmass-target",
                                 .purpose = "the radar picture of a target, from its model",
                                 .commands = commands,
                                 .count = sizeof commands / sizeof commands[0],
                                 .closing =
                                     "landmass-netem learns the reflection from real chips.\n"};
    return hs_menu_main(&menu, argc, argv);
}
