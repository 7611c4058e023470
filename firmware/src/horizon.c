#include "lm/horizon.h"

#include "fx/sat.h"
#include "horizon_neon.h"

static int32_t highest(const struct lm_range_grid *grid, const struct lm_legend *legend,
                       const struct lm_scan_line *line)
{
    if (FX_HAS_NEON && grid->cells - grid->first >= NEON_CELLS) {
        return highest_neon(grid, legend, line);
    }
    int32_t tangent = INT32_MIN;
    for (uint32_t i = grid->first; i < grid->cells; i++) {
        tangent = fx_max_i32(tangent, tangent_of(grid, legend, line, i));
    }
    return tangent;
}

lm_horizon_q40_t lm_horizon_behind(const struct lm_range_grid *grid, const struct lm_legend *legend,
                                   const struct lm_scan_line *line)
{
    if (grid->first >= grid->cells) {
        return LM_HORIZON_OPEN;
    }
    return highest(grid, legend, line) * ((int64_t)1 << (40 - grid->tangent_bits));
}
