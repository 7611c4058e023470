/* The far shore's brightness along a line: docs/EQUATIONS.md, "Illumination". */
#ifndef SHORE_H
#define SHORE_H

#include "aspect_line.h"
#include "fx/bits.h"
#include "shore_neon.h"

/* The far shore's brightness from its first cell `i` on, where there is light. */
static inline void add_shore(const struct lm_range_grid *grid, const struct lm_legend *legend,
                             const struct lm_scan_line *line, uint32_t i, struct lm_sight *sight)
{
    const int32_t fall_q8 = grid->shore_fall_q8;
    const uint32_t done = neon_add_shore(grid, legend, line, i, sight);
    i += done;
    for (int32_t shore_q8 = legend->shore_q8 - (int32_t)done * fall_q8;
         i < grid->cells && shore_q8 > 0; i++, shore_q8 -= fall_q8) {
        if (kind_of(legend, line->cell[i]) & MARK_WATER) {
            return;
        }
        sight->level_q8[i] += sight->level_q8[i] != LM_LEVEL_SHADOW ? shore_q8 : 0;
    }
}

/* Of eight cells from `first` on. Each has a byte of `eight`, with MARK_WATER where it is behind a
 * shore. */
static inline void add_shores_of(const struct lm_range_grid *grid, const struct lm_legend *legend,
                                 const struct lm_scan_line *line, uint64_t eight, uint32_t first,
                                 struct lm_sight *sight)
{
    for (uint64_t left = eight & EACH_IS_WATER; left != 0; left &= left - 1) {
        add_shore(grid, legend, line, first + (uint32_t)fx_ctz64(left) / 8, sight);
    }
}

#endif
