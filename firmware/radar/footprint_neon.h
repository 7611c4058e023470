/* Sums of azimuths by the vectors of 64-bit Arm: sixteen cells at a time, to the bit as in
 * footprint.c. Returns how many cells it did, which is none on other machines. */
#ifndef FOOTPRINT_NEON_H
#define FOOTPRINT_NEON_H

#include <stddef.h>

#include "fx/neon.h"
#include "lm/footprint.h"

#if FX_HAS_NEON

static inline int32x4x4_t neon_load_16(const int32_t *from)
{
    return fx_neon_load_8_and_8(from, from + 8);
}

/* The sums of both, less `less_q8` and not below `least_q8`, into `to_q8`, which may be either. */
static inline uint32_t sum_neon(const int32_t *sum_q8, const int32_t *level_q8, int32_t less_q8,
                                int32_t least_q8, int32_t *to_q8, uint32_t cells)
{
    const uint32_t whole = cells & ~15u;
    const int32x4_t less = vdupq_n_s32(less_q8), least = vdupq_n_s32(least_q8);
    const uint8x16x4_t lows = vld1q_u8_x4(fx_table_db_sum_lines[0]);
    const uint8x16x4_t highs = vld1q_u8_x4(fx_table_db_sum_lines[1]);
    const uint8x16x4_t falls = vld1q_u8_x4(fx_table_db_sum_lines[2]);
    for (size_t i = 0; i < whole; i += 16) {
        int32x4x4_t sum = fx_neon_db_q8_sum(lows, highs, falls, neon_load_16(sum_q8 + i),
                                            neon_load_16(level_q8 + i));
        for (size_t k = 0; k < 4; k++) {
            sum.val[k] = vmaxq_s32(vsubq_s32(sum.val[k], less), least);
        }
        fx_neon_store_8_and_8(to_q8 + i, to_q8 + i + 8, sum);
    }
    return whole;
}

#else

static inline uint32_t sum_neon(const int32_t *sum_q8, const int32_t *level_q8, int32_t less_q8,
                                int32_t least_q8, int32_t *to_q8, uint32_t cells)
{
    return (void)sum_q8, (void)level_q8, (void)less_q8, (void)least_q8, (void)to_q8, (void)cells, 0;
}

#endif

#endif
