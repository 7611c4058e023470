/* A far shore by the vectors of 64-bit Arm, eight cells at a time, to the bit as in shore.h. */
#ifndef SHORE_NEON_H
#define SHORE_NEON_H

#include <stddef.h>

#include "fx/neon.h"
#include "lm/aspect.h"

/* MARK_WATER in each of eight bytes. */
#define EACH_IS_WATER 0x0101010101010101

#if FX_HAS_NEON

/* The marks of eight cells. */
static inline uint64_t neon_marks(const struct lm_legend *legend, const uint32_t *cell)
{
    const uint16x8_t halves = vuzp1q_u16(vreinterpretq_u16_u32(vld1q_u32(cell)),
                                         vreinterpretq_u16_u32(vld1q_u32(cell + 4)));
    const uint8x8_t class_index = vshr_n_u8(vmovn_u16(halves), 4);
    const uint8x8_t mark = vqtbl1_u8(vld1q_u8(legend->bytes.mark), class_index);
    return vget_lane_u64(vreinterpret_u64_u8(mark), 0);
}

/* Add to four levels what is positive of the shore, where there is light. */
static inline void neon_brighten(int32_t *level_q8, int32x4_t shore_q8)
{
    const int32x4_t old_q8 = vld1q_s32(level_q8), zero = vdupq_n_s32(0);
    const uint32x4_t is_dark = vceqq_s32(old_q8, vdupq_n_s32(LM_LEVEL_SHADOW));
    const int32x4_t more_q8 = vbslq_s32(is_dark, zero, vmaxq_s32(shore_q8, zero));
    vst1q_s32(level_q8, vaddq_s32(old_q8, more_q8));
}

/* What add_shore does, for whole groups of eight cells without water; returns how many cells these
 * are. */
static inline uint32_t neon_add_shore(const struct lm_range_grid *grid,
                                      const struct lm_legend *legend,
                                      const struct lm_scan_line *line, uint32_t first,
                                      struct lm_sight *sight)
{
    static const int32_t number[8] = {0, 1, 2, 3, 4, 5, 6, 7};
    const int32_t fall_q8 = grid->shore_fall_q8;
    uint32_t i = first;
    for (int32_t shore_q8 = legend->shore_q8; i + 8 <= grid->cells && shore_q8 > 0;
         i += 8, shore_q8 -= 8 * fall_q8) {
        if ((neon_marks(legend, line->cell + i) & EACH_IS_WATER) != 0) {
            break;
        }
        const int32x4_t all_q8 = vdupq_n_s32(shore_q8);
        for (size_t k = 0; k < 8; k += 4) {
            neon_brighten(sight->level_q8 + i + k,
                          vmlsq_n_s32(all_q8, vld1q_s32(number + k), fall_q8));
        }
    }
    return i - first;
}

#else

static inline uint32_t neon_add_shore(const struct lm_range_grid *grid,
                                      const struct lm_legend *legend,
                                      const struct lm_scan_line *line, uint32_t first,
                                      struct lm_sight *sight)
{
    (void)grid, (void)legend, (void)line, (void)first, (void)sight;
    return 0;
}

#endif

#endif
