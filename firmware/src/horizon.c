#include "lm/horizon.h"

#include "aspect_line.h"
#include "fx/sat.h"

lm_horizon_q40_t lm_horizon_behind(const struct lm_range_grid *grid, const struct lm_legend *legend,
                                   const struct lm_scan_line *line)
{
    if (grid->first >= grid->cells) {
        return LM_HORIZON_OPEN;
    }
    int32_t highest = INT32_MIN;
    for (uint32_t i = grid->first; i < grid->cells; i++) {
        highest = fx_max_i32(highest, tangent_of(grid, legend, line, i));
    }
    return highest * ((int64_t)1 << (40 - grid->tangent_bits));
}
