#include "lm/line.h"

/* Behind speckle and noise, which belong to the clutter: what a target returns is its own. */
static void add_targets(struct lm_line *line, const struct lm_line_setup *setup)
{
    const struct lm_target_sight sight = {line->sight.horizon, 40 + setup->grid->tangent_shift};
    const struct lm_line_targets *t = setup->targets;
    lm_target_add(t->items, t->near, &t->where, &sight, line->sight.level_q8);
}

lm_horizon_q40_t lm_line_render(struct lm_line *line, struct lm_tile_cache *tiles,
                                const struct lm_line_setup *setup,
                                const struct lm_ground_path *path, lm_horizon_q40_t horizon)
{
    const uint32_t cells = setup->grid->cells;
    lm_scan_line_run(&line->ground, tiles, &setup->sampling, path, cells);
    horizon = lm_aspect_run(setup->grid, setup->aspect, &tiles->db->classes, &line->ground, horizon,
                            &line->sight);
    lm_speckle_run(setup->speckle, line->ground.noise, line->sight.level_q8, cells);
    if (setup->targets) {
        add_targets(line, setup);
    }
    lm_tone_run(setup->tone, line->sight.level_q8, line->grey, cells);
    return horizon;
}
