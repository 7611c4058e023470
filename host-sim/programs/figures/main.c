/* landmass-figures: figures of the documentation, drawn with the firmware's own functions. */
#include "figures.h"

#include "hs/error.h"

#include <stdio.h>
#include <string.h>

static const struct figure {
    const char *name, *help;
    int (*draw)(const char *path);
} figures[] = {
    {"figure1",
     "Heaton, Figure 1: nine corner reflectors seen by a high- and a low-resolution radar",
     figure1_draw},
    {"table1", "Heaton, Table 1: the lobes of flat plates, one way as printed and two ways as used",
     table1_draw},
};
enum { FIGURES = sizeof figures / sizeof figures[0] };

static void print_help(void)
{
    printf(
        "usage: landmass-figures FIGURE FILE.png\n\n"
        "Draw a figure of the documentation (docs/targets.md) with the firmware's own functions.\n"
        "A FILE.png that stands already is replaced whole, or left alone if anything fails.\n\n"
        "Figures:\n");
    for (int i = 0; i < FIGURES; i++) {
        printf("  %-8s %s\n", figures[i].name, figures[i].help);
    }
}

int main(int argc, char **argv)
{
    hs_set_program("landmass-figures");
    if (argc == 2 && (strcmp(argv[1], "--help") == 0 || strcmp(argv[1], "-h") == 0)) {
        print_help();
        return HS_EXIT_OK;
    }
    if (argc != 3) {
        hs_error("command line", "try landmass-figures --help", "expected FIGURE FILE.png");
        return HS_EXIT_USAGE;
    }
    for (int i = 0; i < FIGURES; i++) {
        if (strcmp(argv[1], figures[i].name) == 0) {
            return figures[i].draw(argv[2]) == 0 ? HS_EXIT_OK : HS_EXIT_FAILED;
        }
    }
    hs_error(argv[1], "landmass-figures --help lists the figures", "there is no such figure");
    return HS_EXIT_USAGE;
}
