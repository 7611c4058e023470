/* Layover at the limits of a patch: cells too near to be shown, and structures displaced farther
 * than the line is long. Its law is tested in tests/unit/firmware/radar/test_sar_effects.c. */
#include "check.h"
#include "lm/layover.h"
#include "lm/level.h"
#include "tiny_image.h"

#include <string.h>

enum { CELLS = 96, CODE = 15 /* 100 m */, LEVEL_Q8 = 7 * 256 };

static struct lm_scan_line ground;
static int16_t level_q8[LM_CELLS_ROOM], laid_q8[LM_LAYOVER_ROOM];

static const int16_t *run(const struct lm_layover_view *view)
{
    struct lm_layover layover;
    memset(&ground, 0, sizeof ground);
    for (int i = 0; i < LM_CELLS_ROOM; i++) {
        level_q8[i] = LEVEL_Q8;
    }
    ground.cell[CELLS / 2] = CODE;
    lm_layover_set(&layover, tiny_classes(), view);
    return lm_layover_run(&layover, &ground, level_q8, laid_q8);
}

TEST(cells_that_are_not_shown_stay_dark_whatever_is_laid_over_them)
{
    const struct lm_layover_view view = {
        .lean_q16 = 1 << 15, .cell_m_q8 = 256, .first = 30, .cells = CELLS};
    const int16_t *shown_q8 = run(&view); /* the tower's top is 50 cells nearer */
    for (uint32_t i = 0; i < view.first; i++) {
        assert_int_equal(shown_q8[i], LM_LEVEL_SHADOW);
    }
    assert_true(shown_q8[view.first + 1] > LM_LEVEL_SHADOW);
}

TEST(what_is_displaced_farther_than_any_line_is_long_is_in_no_cell)
{
    const struct lm_layover_view steep = {
        .lean_q16 = (1 << 17) - 1, .cell_m_q8 = 1, .cells = CELLS};
    const struct lm_layover_view flat = {.lean_q16 = 0, .cell_m_q8 = 256, .cells = CELLS};
    int16_t steep_q8[CELLS];
    memcpy(steep_q8, run(&steep), sizeof steep_q8);
    const int16_t *flat_q8 = run(&flat);
    for (int i = 0; i < CELLS; i++) {
        assert_true(steep_q8[i] <= flat_q8[i]); /* the tower has gone from its cell, to nowhere */
    }
    assert_int_equal(flat_q8[CELLS / 2], LEVEL_Q8);
    assert_true(steep_q8[CELLS / 2] < LEVEL_Q8);
}
