#include "lm/line.h"

lm_horizon_q40_t lm_line_render(struct lm_line *line, struct lm_tile_cache *tiles,
                                const struct lm_line_setup *setup,
                                const struct lm_ground_path *path, lm_horizon_q40_t horizon)
{
    const uint32_t cells = setup->grid->cells;
    lm_scan_line_run(&line->ground, tiles, &setup->sampling, path, cells);
    horizon = lm_aspect_run(setup->grid, setup->aspect, &tiles->db->classes, &line->ground, horizon,
                            &line->sight);
    lm_speckle_run(setup->speckle, line->ground.noise, line->sight.level_q8, cells);
    lm_tone_run(setup->tone, line->sight.level_q8, line->grey, cells);
    return horizon;
}
