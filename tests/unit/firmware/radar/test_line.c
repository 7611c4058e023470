/* A line's targets: which cells they may write. */
#include "check.h"
#include "lm/level.h"
#include "lm/line.h"

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
