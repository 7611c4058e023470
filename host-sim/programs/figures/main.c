/* landmass-figures: figures of the documentation, drawn with the firmware's own functions. */
#include "figures.h"

#include "hs/error.h"
#include "hs/menu.h"
#include "hs/options.h"

#include <stddef.h>

/* Draw what argv[0] names. */
static int run(int (*draw)(const char *path), const struct hs_usage *usage, int argc, char **argv)
{
    const char *path = NULL;
    int exit_code;
    const struct hs_option options[] = {
        {"FILE.png", HS_OUTPUT_ARGUMENT, &path, 0, 0, NULL,
         "the picture; one that stands already is replaced whole, or left alone if anything fails",
         true},
    };
    if (!hs_options_read(usage, options, sizeof options / sizeof options[0], argc, argv,
                         &exit_code)) {
        return exit_code;
    }
    return draw(path) == 0 ? HS_EXIT_OK : HS_EXIT_FAILED;
}

static int run_figure1(int argc, char **argv)
{
    const struct hs_usage usage = {
        "figure1",
        "Heaton, Figure 1: nine corner reflectors seen by a high- and a low-resolution radar",
        "See docs/targets.md."};
    return run(figure1_draw, &usage, argc, argv);
}

static int run_table1(int argc, char **argv)
{
    const struct hs_usage usage = {
        "table1",
        "Heaton, Table 1: the lobes of flat plates, one way as printed and two ways as used",
        "See docs/targets.md."};
    return run(table1_draw, &usage, argc, argv);
}

int main(int argc, char **argv)
{
    static const struct hs_command commands[] = {
        {"figure1", "nine corner reflectors at two resolutions: Heaton, Figure 1", run_figure1},
        {"table1", "the lobes of flat plates: Heaton, Table 1", run_table1},
    };
    const struct hs_menu menu = {.program = "landmass-figures",
                                 .purpose =
                                     "figures of the documentation, by the firmware's functions",
                                 .commands = commands,
                                 .count = sizeof commands / sizeof commands[0]};
    return hs_menu_main(&menu, argc, argv);
}
