/* The GPIO driver, from inside a machine that has lines:
 *
 *     gpio_probe SECONDS OUTPUT INPUT...
 *
 * Prints "open" when it has the lines, then for each change of the inputs "levels" and their bits,
 * of INPUTs from the first on; edges light OUTPUT and put it out by turns. Ends with "counts EDGES
 * ERRORS". Keys are active low. */
#include "drv/gpio.h"

#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

static double now_s(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + (double)t.tv_nsec * 1e-9;
}

int main(int argc, char **argv)
{
    static struct drv_gpio g;
    setvbuf(stdout, NULL, _IOLBF, 0);
    if (argc < 4 || drv_gpio_open(&g) != 0 || drv_gpio_add_output(&g, argv[2], false) < 0) {
        printf("fault %s\n", g.error);
        return 1;
    }
    for (int i = 3; i < argc; i++) {
        if (drv_gpio_add_input(&g, argv[i], true) < 0) {
            printf("fault %s\n", g.error);
        }
    }
    uint64_t shown = drv_gpio_levels(&g);
    bool is_lit = false;
    printf("open %u inputs, levels %llx\n", g.input_count, (unsigned long long)shown);
    for (const double end_s = now_s() + atof(argv[1]); now_s() < end_s;) {
        struct pollfd wake = {.fd = g.fd, .events = POLLIN};
        (void)poll(&wake, 1, 100);
        const uint64_t edges = drv_gpio_take_edges(&g), levels = drv_gpio_levels(&g);
        if (edges != 0) {
            is_lit = !is_lit;
            drv_gpio_set(&g, 0, is_lit);
            printf("edges %llx levels %llx lit %d\n", (unsigned long long)edges,
                   (unsigned long long)levels, is_lit);
        } else if (levels != shown) {
            printf("silent change to %llx\n", (unsigned long long)levels);
        }
        shown = levels;
    }
    printf("counts %u %u\n", g.count.edges, g.count.errors);
    drv_gpio_close(&g);
    return 0;
}
