#include "lm/coverage.h"

#include "lm/db.h"

enum { SAMPLE_CELLS = 16 };

void lm_coverage_add(struct lm_coverage *c, const struct lm_scan_line *line, uint32_t cells)
{
    for (uint32_t i = 0; i < cells; i += SAMPLE_CELLS) {
        c->cells_seen++;
        c->cells_none += line->cell[i] == LM_CELL_NONE;
    }
}

void lm_coverage_judge(struct lm_coverage *c)
{
    c->is_off_map = 2 * c->cells_none > c->cells_seen;
}
