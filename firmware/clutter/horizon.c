#include "lm/horizon.h"

#include "lm/kernels_clutter.h"
#include "tops.h"

lm_horizon_q40_t lm_horizon_behind(const struct lm_range_grid *grid, const struct lm_legend *legend,
                                   const struct lm_scan_line *line)
{
    if (grid->first >= grid->cells) {
        return LM_HORIZON_OPEN;
    }
    const struct lm_k_tops tops = tops_of(grid, legend, line);
    return lm_k_highest_tangent(&tops) * ((int64_t)1 << (40 - grid->tangent_bits));
}

void lm_runup_set(struct lm_runup *r, const struct lm_db *db, const struct lm_aspect_config *config,
                  uint32_t end_q8, const struct lm_range_grid *behind)
{
    r->start_q8 = end_q8 / 16;
    r->cell_q8 = (end_q8 - r->start_q8) / LM_RUNUP_CELLS;
    r->level = lm_scan_level(db, lm_mm_of_metres_q8(r->cell_q8));
    lm_range_grid_set(&r->grid, config, r->start_q8 + r->cell_q8 / 2, r->cell_q8, LM_RUNUP_CELLS,
                      behind->height_q10, behind->reference_q10);
}

lm_horizon_q40_t lm_runup_trace(const struct lm_runup *r, const struct lm_legend *legend,
                                struct lm_tile_cache *tiles, const struct lm_ground_path *path,
                                struct lm_scan_line *line)
{
    lm_scan_line_run(line, tiles, r->level, path, LM_RUNUP_CELLS);
    return lm_horizon_behind(&r->grid, legend, line);
}
