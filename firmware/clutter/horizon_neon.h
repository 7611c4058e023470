/* The highest look over a line by the vectors of 64-bit Arm, to the bit what horizon.c finds. Not
 * for other machines, where it is never called. */
#ifndef HORIZON_NEON_H
#define HORIZON_NEON_H

#include "aspect_neon.h"

#if FX_HAS_NEON

static inline int32x4_t neon_highest_of(int32x4_t highest, int32x4x4_t tangent)
{
    return vmaxq_s32(highest, vmaxq_s32(vmaxq_s32(tangent.val[0], tangent.val[1]),
                                        vmaxq_s32(tangent.val[2], tangent.val[3])));
}

/* Of the cells from grid->first on, of which there are a turn at least: the last turn ends with the
 * line and takes some cells once more. */
static inline int32_t highest_neon(const struct lm_range_grid *grid, const struct lm_legend *legend,
                                   const struct lm_scan_line *line)
{
    const struct neon_legend l = neon_legend_of(legend);
    const uint32_t last = grid->cells - NEON_CELLS;
    int32x4_t highest = vdupq_n_s32(INT32_MIN);
    for (uint32_t i = grid->first, end = 0; end < grid->cells; i = end) {
        const uint32_t begin = i < last ? i : last;
        const struct neon_place at = {.elevation_q14 =
                                          (const uint32_t *)line->elevation_q14 + begin,
                                      .fall_q14 = (const uint32_t *)grid->fall_q14 + begin,
                                      .inverse_range = grid->inverse_range + begin};
        const uint8x16_t lower =
            fx_neon_lower_bytes(fx_neon_lower_halves(vld1q_u32_x4(line->cell + begin)));
        highest = neon_highest_of(highest,
                                  neon_tangents(&l, &at, vandq_u8(lower, vdupq_n_u8(CODES - 1))));
        end = begin + NEON_CELLS;
    }
    return vmaxvq_s32(highest);
}

#else

enum { NEON_CELLS = LM_CELLS_ROOM }; /* no line has so many */

static inline int32_t highest_neon(const struct lm_range_grid *grid, const struct lm_legend *legend,
                                   const struct lm_scan_line *line)
{
    (void)grid, (void)legend, (void)line;
    return 0;
}

#endif
#endif
