#include "lm/line.h"

lm_horizon_q40_t lm_line_trace(struct lm_line *line, struct lm_tile_cache *tiles,
                               const struct lm_line_setup *setup, const struct lm_ground_path *path,
                               lm_horizon_q40_t horizon)
{
    const uint32_t cells = setup->grid->cells;
    lm_scan_line_run(&line->ground, tiles, setup->level, path, cells);
    horizon = lm_aspect_run(setup->grid, setup->legend, &line->ground, horizon, &line->sight);
    lm_texture_run(setup->texture, &setup->raster, line->ground.cell, line->sight.level_q8, cells);
    return horizon;
}

void lm_line_add_targets(struct lm_line *line, const struct lm_range_grid *grid,
                         const struct lm_line_targets *targets)
{
    const struct lm_target_sight sight = {line->sight.horizon, grid->tangent_bits};
    lm_target_add(targets->near, &targets->where, &sight, line->sight.level_q8);
}
