#include "lm/coverage.h"

#include "lm/db.h"

enum { SAMPLE_CELLS = 16 };

void lm_coverage_add(struct lm_coverage *c, const struct lm_scan_line *line, uint32_t cells)
{
    c->seen_lod = line->coarsest_lod > c->seen_lod ? line->coarsest_lod : c->seen_lod;
    c->cells_coarse += line->coarse_cells;
    c->cells_drawn += cells;
    for (uint32_t i = 0; i < cells; i += SAMPLE_CELLS) {
        c->cells_seen++;
        c->cells_none += line->cell[i] == LM_CELL_NONE;
    }
}

void lm_coverage_judge(struct lm_coverage *c)
{
    c->is_off_map = 2 * c->cells_none > c->cells_seen;
    c->coarsest_lod = 4 * c->cells_coarse > c->cells_drawn ? c->seen_lod : 0;
}

void lm_coverage_restart(struct lm_coverage *c)
{
    c->cells_none = c->cells_seen = 0;
    c->cells_coarse = c->cells_drawn = 0;
    c->seen_lod = 0;
}

uint32_t lm_coverage_coarse_mm(const struct lm_coverage *c, const struct lm_db *db, uint8_t lod,
                               uint32_t picture_cell_mm)
{
    const uint32_t cell_mm = lm_db_cell_mm(db, lod > c->coarsest_lod ? lod : c->coarsest_lod);
    return cell_mm > picture_cell_mm + picture_cell_mm / 8 ? cell_mm : 0;
}
