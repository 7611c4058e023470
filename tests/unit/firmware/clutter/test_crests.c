/* Crests between cells against the geometry in double precision: ridges whose tops lie between two
 * points of the line, walls, and where the law is on. */
#include "check.h"
#include "lm/crests.h"
#include "tiny_image.h"

#include <math.h>
#include <string.h>

enum { CELLS = 60, CELL_M = 40, FIRST_M = 9000, ANTENNA_M = 4000 };

struct rig {
    struct lm_range_grid grid;
    struct lm_scan_line line;
    int32_t work[LM_CELLS_ROOM], before[CELLS];
};

static double range_m(double cell)
{
    return FIRST_M + cell * CELL_M;
}

/* Tangent at which a height appears, from cell numbers with fractions. */
static double tangent(double cell, double height_m)
{
    const double s = range_m(cell);
    return (height_m - ANTENNA_M) / s - s / (2 * 4.0 / 3 * 6371000);
}

static void set_line(struct rig *r, double (*height_m)(double cell))
{
    const struct lm_illumination_config config = {.shore_width_m = 1};
    memset(r, 0, sizeof *r);
    lm_range_grid_set(&r->grid, &config, FIRST_M * 256, CELL_M * 256, CELLS, ANTENNA_M * 1024, 0);
    for (int i = 0; i < CELLS; i++) {
        r->before[i] = r->line.elevation_m_q14[i] = (int32_t)lround(height_m(i) * 16384);
    }
    lm_crests_raise(&r->grid, &r->line, r->work);
}

static double raised_m(const struct rig *r, int cell)
{
    return (r->line.elevation_m_q14[cell] - r->before[cell]) / 16384.0;
}

/* A round ridge whose top lies half a cell behind cell 30. */
static double ridge_m(double cell)
{
    return fmax(1000 - 30 * (cell - 30.5) * (cell - 30.5), 500);
}

/* The line of sight falls by some 14 m a cell: the ridge of curvature 30 has its top, as the radar
 * sees it, less than half a cell behind its own. */
TEST(a_ridge_between_two_cells_is_seen_as_high_as_in_the_middle_between_them)
{
    struct rig r;
    set_line(&r, ridge_m);
    const double seen = tangent(30, r.line.elevation_m_q14[30] / 16384.0);
    const double wanted = tangent(30.5, ridge_m(30.5));
    assert_true(fabs(seen - wanted) * range_m(30) < 0.15);
    assert_true(tangent(30, ridge_m(30)) < wanted && tangent(31, ridge_m(31)) < wanted);
    for (int i = 0; i < CELLS; i++) {
        assert_true(i == 30 || raised_m(&r, i) == 0);
    }
}

/* One whose top is a cell's has no higher one beside it. */
static double centred_m(double cell)
{
    return fmax(1000 - 40 * (cell - 30) * (cell - 30) - 14 * (cell - 30), 500);
}

static double plane_m(double cell)
{
    return 800 - 9 * cell;
}

/* A cliff 300 m high, and a pit behind it. */
static double cliff_m(double cell)
{
    return cell < 20 ? 100 : cell < 40 ? 400 : 0;
}

TEST(tops_in_cells_planes_and_cliffs_are_left_as_they_are)
{
    static double (*const shapes[])(double) = {centred_m, plane_m, cliff_m};
    for (size_t k = 0; k < sizeof shapes / sizeof *shapes; k++) {
        struct rig r;
        set_line(&r, shapes[k]);
        for (int i = 0; i < CELLS; i++) {
            assert_true(raised_m(&r, i) == 0);
        }
    }
}

TEST(they_count_in_long_cells_of_the_finest_lod_that_are_not_blended)
{
    const struct lm_db db = {.finest = 1};
    assert_true(lm_crests_are_wanted(&db, 1, false, 24000));
    assert_false(lm_crests_are_wanted(&db, 1, false, 23999));
    assert_false(lm_crests_are_wanted(&db, 2, false, 40000));
    assert_false(lm_crests_are_wanted(&db, 1, true, 40000));
}
