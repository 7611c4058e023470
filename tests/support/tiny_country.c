#include "tiny_country.h"

#include <math.h>

static struct tiny_cell cell_at(void *ctx, const struct tiny_place *p)
{
    (void)ctx;
    if (hypot(p->east_m + 2000, p->north_m) < 1500) {
        return (struct tiny_cell){-40, TINY_WATER, 0};
    }
    const bool is_house =
        fabs(remainder(p->east_m, 400)) < 50 && fabs(remainder(p->north_m, 400)) < 50;
    return is_house ? (struct tiny_cell){0, TINY_STRUCTURE, 5}
                    : (struct tiny_cell){-18, TINY_SOIL, 0};
}

static double elevation_at(void *ctx, const struct tiny_place *p)
{
    (void)ctx;
    return 300 + 80 * sin(p->east_m / 900) * cos(p->north_m / 1300);
}

struct tiny_spec tiny_country(uint8_t tiles)
{
    struct tiny_spec spec = tiny_spec_at(46, 11);
    spec.shift0 = 11;
    spec.rows = spec.columns = tiles;
    spec.cell = cell_at;
    spec.elevation_m = elevation_at;
    return spec;
}
