/* The horizon behind a run-up, against the geometry in double precision and against what a line
 * that is shown leaves. */
#include "check.h"
#include "hs/rng.h"
#include "lm/foreground.h"
#include "tiny_image.h"

#include <math.h>
#include <string.h>

static const double effective_earth_m = 4.0 / 3 * 6371000;

/* Any terrain up to 4,000 m under any height code, seen from anywhere. */
struct country {
    int32_t antenna_m;
    struct lm_range_grid grid;
    struct lm_class_lut class_lut;
    struct lm_scan_line line;
    struct lm_lit_line lit;
};

static void draw_country(struct country *c, struct hs_rng *rng, int32_t antenna_m, uint32_t first_m,
                         uint32_t cells)
{
    const struct lm_illumination_config config = {.shore_width_m = 1};
    c->antenna_m = antenna_m;
    lm_class_lut_set(&c->class_lut, &config, tiny_classes());
    lm_range_grid_set(&c->grid, &config, first_m * 256, 150 * 256, cells, antenna_m * 1024, 0);
    for (uint32_t i = 0; i < cells; i++) {
        c->line.cell[i] = hs_rng_below(rng, 1 << 16);
        c->line.elevation_m_q14[i] = (int32_t)hs_rng_below(rng, 4000 * 16384);
    }
}

static double highest_tangent(const struct country *c, uint32_t first_m)
{
    double highest = -INFINITY;
    for (uint32_t i = c->grid.first; i < c->grid.cells; i++) {
        const double range_m = first_m + i * 150.0;
        const double top_m = c->line.elevation_m_q14[i] / 16384.0 +
                             tiny_classes()->height_dm[c->line.cell[i] & 15] / 10.0;
        highest =
            fmax(highest, (top_m - c->antenna_m) / range_m - range_m / (2 * effective_earth_m));
    }
    return highest;
}

TEST(it_is_the_highest_look_over_the_cells_that_are_shown)
{
    static struct country c;
    struct hs_rng rng;
    hs_rng_seed(&rng, 1);
    for (uint32_t n = 0; n < 2000; n++) {
        const uint32_t first_m = 300 + hs_rng_below(&rng, 9000);
        const uint32_t cells = 20 + hs_rng_below(&rng, LM_CELLS_MAX - 20);
        const int32_t antenna_m = (int32_t)hs_rng_below(&rng, 6000);
        draw_country(&c, &rng, antenna_m, first_m, cells);
        const lm_horizon_q40_t horizon = lm_foreground_line_horizon(&c.grid, &c.class_lut, &c.line);
        assert_true(fabs(ldexp((double)horizon, -40) - highest_tangent(&c, first_m)) < 1e-6);
        assert_true(horizon ==
                    lm_illuminate(&c.grid, &c.class_lut, NULL, &c.line, LM_HORIZON_OPEN, &c.lit));
    }
}

TEST(it_stays_open_where_no_cell_is_shown)
{
    static struct country c;
    struct hs_rng rng;
    hs_rng_seed(&rng, 2);
    draw_country(&c, &rng, 5000, 300, 14); /* up to 2,250 m, less than half the height */
    assert_int_equal(c.grid.first, 14);
    assert_true(lm_foreground_line_horizon(&c.grid, &c.class_lut, &c.line) == LM_HORIZON_OPEN);
}
