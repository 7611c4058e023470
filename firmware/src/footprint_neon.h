/* Sums of azimuths by the vectors of 64-bit Arm: eight cells at a time, to the bit as in
 * footprint.c. Each function returns how many cells it did, which is none on other machines. */
#ifndef FOOTPRINT_NEON_H
#define FOOTPRINT_NEON_H

#include <stddef.h>

#include "fx/neon.h"
#include "lm/aspect.h"
#include "lm/footprint.h"

#if FX_HAS_NEON

static inline int32x4x2_t neon_load_8(const int32_t *from)
{
    return (int32x4x2_t){{vld1q_s32(from), vld1q_s32(from + 4)}};
}

static inline uint32_t add_neon(int32_t *restrict sum_q8, const int32_t *restrict level_q8,
                                uint32_t cells)
{
    const uint32_t whole = cells & ~7u;
    const struct fx_neon_db_sum lines = fx_neon_db_sum_lines();
    for (size_t i = 0; i < whole; i += 8) {
        const int32x4x2_t sum =
            fx_neon_db_q8_sum(&lines, neon_load_8(sum_q8 + i), neon_load_8(level_q8 + i));
        vst1q_s32(sum_q8 + i, sum.val[0]);
        vst1q_s32(sum_q8 + i + 4, sum.val[1]);
    }
    return whole;
}

static inline uint32_t mean_neon(const int32_t *restrict sum_q8, int32_t less_q8,
                                 int32_t *restrict level_q8, uint32_t cells)
{
    const uint32_t whole = cells & ~7u;
    const struct fx_neon_db_sum lines = fx_neon_db_sum_lines();
    const int32x4_t less = vdupq_n_s32(less_q8), shadow = vdupq_n_s32(LM_LEVEL_SHADOW);
    for (size_t i = 0; i < whole; i += 8) {
        const int32x4x2_t sum =
            fx_neon_db_q8_sum(&lines, neon_load_8(sum_q8 + i), neon_load_8(level_q8 + i));
        vst1q_s32(level_q8 + i, vmaxq_s32(vsubq_s32(sum.val[0], less), shadow));
        vst1q_s32(level_q8 + i + 4, vmaxq_s32(vsubq_s32(sum.val[1], less), shadow));
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
