#include "lm/line.h"

#include "fx/mem.h"
#include "lm/crests.h"
#include "lm/level.h"

lm_horizon_q40_t lm_line_trace(struct lm_line *line, struct lm_tile_cache *tiles,
                               const struct lm_line_setup *setup, const struct lm_ground_path *path,
                               lm_horizon_q40_t horizon)
{
    const uint32_t cells = setup->grid->cells;
    lm_scan_line_run(&line->ground, tiles, setup->lod, setup->blend, path, cells);
    if (setup->detail) {
        lm_detail_patch_draw(setup->detail, setup->number, &line->ground, cells);
    }
    if (setup->has_crests) {
        lm_crests_raise(setup->grid, &line->ground, line->lit.scratch);
    }
    horizon = lm_illuminate(setup->grid, setup->class_lut, setup->class_gain, &line->ground,
                            horizon, &line->lit);
    lm_sea_run(setup->sea, line->ground.cell, line->lit.level_db_q8);
    return horizon;
}

bool lm_line_add_targets(struct lm_line *line, const struct lm_range_grid *grid,
                         const struct lm_line_targets *targets)
{
    const struct lm_target_horizon horizon = {line->lit.horizon, grid->tangent_bits};
    struct lm_target_line where = targets->where;
    where.clutter_db_q8 = line->lit.level_db_q8;
    where.elevation_m_q14 = line->ground.elevation_m_q14;
    for (uint32_t i = 0; i < grid->cells; i++) {
        line->steady.level_db_q8[i] = LM_LEVEL_SHADOW;
    }
    int16_t *level_db_q8 = line->steady.level_db_q8;
    uint32_t cells = lm_target_line_add(targets->candidates, &where, &horizon, level_db_q8);
    if (targets->live->count != 0) {
        cells += lm_target_line_add(targets->live, &where, &horizon, level_db_q8);
    }
    if (cells == 0) {
        return false;
    }
    memcpy(line->steady.horizon, line->lit.horizon, sizeof line->steady.horizon);
    return true;
}
