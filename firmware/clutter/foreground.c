#include "lm/foreground.h"

#include "lm/kernels_clutter.h"
#include "lm/units.h"
#include "tops.h"

lm_horizon_q40_t lm_foreground_line_horizon(const struct lm_range_grid *grid,
                                            const struct lm_class_lut *class_lut,
                                            const struct lm_scan_line *line)
{
    if (grid->first >= grid->cells) {
        return LM_HORIZON_OPEN;
    }
    const struct lm_k_tops tops = tops_of(grid, class_lut, line);
    return lm_k_highest_tangent(&tops) * ((int64_t)1 << (40 - grid->tangent_bits));
}

void lm_foreground_set(struct lm_foreground *f, const struct lm_db *db,
                       const struct lm_illumination_config *config, uint32_t end_m_q8,
                       const struct lm_range_grid *behind)
{
    f->start_m_q8 = end_m_q8 / 16;
    f->cell_m_q8 = (end_m_q8 - f->start_m_q8) / LM_FOREGROUND_CELLS;
    f->lod = lm_scan_lod(db, lm_mm_of_m_q8(f->cell_m_q8));
    lm_range_grid_set(&f->grid, config, f->start_m_q8 + f->cell_m_q8 / 2, f->cell_m_q8,
                      LM_FOREGROUND_CELLS, behind->height_m_q10, behind->reference_m_q10);
}

lm_horizon_q40_t lm_foreground_horizon(const struct lm_foreground *f,
                                       const struct lm_class_lut *class_lut,
                                       struct lm_tile_cache *tiles,
                                       const struct lm_ground_path *path, struct lm_scan_line *line)
{
    lm_scan_line_run(line, tiles, f->lod, NULL, path, LM_FOREGROUND_CELLS);
    return lm_foreground_line_horizon(&f->grid, class_lut, line);
}
