/* landmass-netem: reflection learned from radar pictures. */
#include "commands.h"

#include "gis/gdal_start.h"
#include "hs/menu.h"

static const struct hs_command commands[] = {
    {"register", "find from where chips were taken that do not say so", nm_cmd_register},
    {"train", "learn the reflection of a target from real chips", nm_cmd_train},
    {"score", "simulated chips beside real ones: MSE, SSIM, CW-SSIM and a picture", nm_cmd_score},
    {"simulate", "chips of any aspect by what was learned", nm_cmd_simulate},
    {"bake", "the signature of what was learned, for the display unit", nm_cmd_bake},
    {"plot", "draw what was learned: loss, reflection curves, kernels", nm_cmd_plot},
    {"recover", "hide a law in made chips, learn it, and tell how well it was found",
     nm_cmd_recover},
    {"response", "impulse response and speckle beside a real radar's", nm_cmd_response},
    {"paper", "the whole experiment of the paper on the full MSTAR set", nm_cmd_paper},
};

int main(int argc, char **argv)
{
    const struct hs_menu menu = {.program = "landmass-netem",
                                 .purpose = "reflection learned from radar pictures",
                                 .commands = commands,
                                 .count = sizeof commands / sizeof commands[0],
                                 .closing = "docs/netem.md explains the method.\n",
                                 .start = db_gdal_start};
    return hs_menu_main(&menu, argc, argv);
}
