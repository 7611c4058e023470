/* Sums of azimuths by the vectors of 64-bit Arm: sixteen cells at a time, to the bit as in
 * footprint.c. Each function returns how many cells it did, which is none on other machines. */
#ifndef FOOTPRINT_NEON_H
#define FOOTPRINT_NEON_H

#include <stddef.h>

#include "fx/neon.h"
#include "lm/aspect.h"
#include "lm/footprint.h"

#if FX_HAS_NEON

static inline int32x4x4_t neon_load_16(const int32_t *from)
{
    return fx_neon_load_8_and_8(from, from + 8);
}

static inline uint32_t add_neon(int32_t *restrict sum_q8, const int32_t *restrict level_q8,
                                uint32_t cells)
{
    const uint32_t whole = cells & ~15u;
    const uint8x16x4_t lows = vld1q_u8_x4(fx_table_db_sum_lines[0]);
    const uint8x16x4_t highs = vld1q_u8_x4(fx_table_db_sum_lines[1]);
    const uint8x16x4_t falls = vld1q_u8_x4(fx_table_db_sum_lines[2]);
    for (size_t i = 0; i < whole; i += 16) {
        const int32x4x4_t sum = fx_neon_db_q8_sum(lows, highs, falls, neon_load_16(sum_q8 + i),
                                                  neon_load_16(level_q8 + i));
        fx_neon_store_8_and_8(sum_q8 + i, sum_q8 + i + 8, sum);
    }
    return whole;
}

static inline uint32_t mean_neon(const int32_t *restrict sum_q8, int32_t less_q8,
                                 int32_t *restrict level_q8, uint32_t cells)
{
    const uint32_t whole = cells & ~15u;
    const int32x4_t less = vdupq_n_s32(less_q8), shadow = vdupq_n_s32(LM_LEVEL_SHADOW);
    const uint8x16x4_t lows = vld1q_u8_x4(fx_table_db_sum_lines[0]);
    const uint8x16x4_t highs = vld1q_u8_x4(fx_table_db_sum_lines[1]);
    const uint8x16x4_t falls = vld1q_u8_x4(fx_table_db_sum_lines[2]);
    for (size_t i = 0; i < whole; i += 16) {
        int32x4x4_t sum = fx_neon_db_q8_sum(lows, highs, falls, neon_load_16(sum_q8 + i),
                                            neon_load_16(level_q8 + i));
        for (size_t k = 0; k < 4; k++) {
            sum.val[k] = vmaxq_s32(vsubq_s32(sum.val[k], less), shadow);
        }
        fx_neon_store_8_and_8(level_q8 + i, level_q8 + i + 8, sum);
    }
    return whole;
}

#else

static inline uint32_t add_neon(int32_t *sum_q8, const int32_t *level_q8, uint32_t cells)
{
    return (void)sum_q8, (void)level_q8, (void)cells, 0;
}

static inline uint32_t mean_neon(const int32_t *sum_q8, int32_t less_q8, int32_t *level_q8,
                                 uint32_t cells)
{
    return (void)sum_q8, (void)less_q8, (void)level_q8, (void)cells, 0;
}

#endif

#endif
