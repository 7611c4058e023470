/* A line's targets: which cells they may write. */
#include "check.h"
#include "lm/level.h"
#include "lm/line.h"
#include "target_support.h"
#include "wgs84.h"

enum { CELLS = 100, MARK = 12345 };

/* Behind the line's cells the arrays go on, and with the most cells that a radar has they end
 * there. */
TEST(the_cells_of_the_line_are_emptied_and_no_other)
{
    static struct lm_line line;
    static struct lm_target_candidates none;
    static struct lm_range_grid grid;
    const struct lm_line_targets targets = {.candidates = &none, .live = &none};
    grid.cells = CELLS;
    for (uint32_t i = 0; i < LM_CELLS_ROOM; i++) {
        line.steady.level_db_q8[i] = MARK;
    }
    assert_false(lm_line_add_targets(&line, &grid, &targets));
    for (uint32_t i = 0; i < LM_CELLS_ROOM; i++) {
        assert_int_equal(line.steady.level_db_q8[i], i < CELLS ? LM_LEVEL_SHADOW : MARK);
    }
}

/* A target due north or due east of 46 N 11 E, selected from there. */
static void select_target(struct lm_target_candidates *candidates, struct lm_target *target,
                          double azimuth_deg)
{
    double to[2];
    wgs84_direct(46, 11, azimuth_deg, 20200, &to[0], &to[1]);
    *target = point_at(to[0], to[1], 0, 10);
    const struct lm_target_set set = {.items = target, .count = 1};
    const struct lm_target_query query = {.position = {hs_bam(46), hs_bam(11)}, .reach_m = 40000};
    lm_target_candidates_select(candidates, &set, &query);
    assert_int_equal(candidates->count, 1);
}

/* A line to the north meets those of the image, the live ones, both or none. */
TEST(a_line_has_targets_if_it_meets_one_of_the_image_or_a_live_one)
{
    static struct lm_line line;
    static struct lm_target_candidates of_image, live;
    static struct lm_range_grid grid;
    struct lm_target target[2];
    const uint32_t cell_m_q8 = 400 * 256;
    grid.cells = CELLS;
    grid.tangent_bits = 20;
    for (uint32_t i = 0; i < LM_CELLS_ROOM; i++) {
        line.lit.horizon[i] = INT32_MIN;
    }
    for (uint32_t met = 0; met < 4; met++) {
        select_target(&of_image, &target[0], met & 1 ? 0 : 90);
        select_target(&live, &target[1], met & 2 ? 0 : 90);
        const struct lm_line_targets targets = {&of_image,
                                                &live,
                                                {.position = {hs_bam(46), hs_bam(11)},
                                                 .width = FX_BAM_DEG(1),
                                                 .first_m_q8 = cell_m_q8 / 2,
                                                 .cell_m_q8 = cell_m_q8,
                                                 .cells = CELLS,
                                                 .height_m_q10 = 3000 * 1024,
                                                 .wavelength_um = X_BAND_UM}};
        assert_int_equal(lm_line_add_targets(&line, &grid, &targets), met != 0);
        for (uint32_t i = 0; i < CELLS; i++) {
            assert_int_equal(line.steady.level_db_q8[i] != LM_LEVEL_SHADOW, met != 0 && i == 50);
        }
    }
}
