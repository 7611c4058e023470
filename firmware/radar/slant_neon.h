/* Levels into powers, sixteen at a time and in their place, by the vectors of 64-bit Arm. Returns
 * how many it did, which is none on other machines. */
#ifndef SLANT_NEON_H
#define SLANT_NEON_H

#include <stddef.h>
#include <stdint.h>

#include "fx/neon.h"

#if FX_HAS_NEON

/* No vector gathers here: loads side by side take two numbers each where the addresses allow. */
static inline uint32_t fetch_neon(const int32_t *restrict level_q8, const int32_t *restrict cell_of,
                                  int32_t *restrict bin_q8, uint32_t cells)
{
    const uint32_t whole = cells & ~7u;
    for (size_t i = 0; i < whole; i += 8) {
        for (size_t k = i; k < i + 8; k++) {
            bin_q8[k] = level_q8[cell_of[k]];
        }
    }
    return whole;
}

/* In place. */
static inline uint32_t power_neon(uint32_t *power_q24, uint32_t cells)
{
    const uint32_t whole = cells & ~15u;
    for (size_t i = 0; i < whole; i += 16) {
        const int32_t *level_q8 = (const int32_t *)power_q24 + i;
        const int32x4x4_t level = {{vld1q_s32(level_q8), vld1q_s32(level_q8 + 4),
                                    vld1q_s32(level_q8 + 8), vld1q_s32(level_q8 + 12)}};
        const uint32x4x4_t power = fx_neon_power_q24(level);
        for (size_t k = 0; k < 4; k++) {
            vst1q_u32(power_q24 + i + 4 * k, power.val[k]);
        }
    }
    return whole;
}

#else

static inline uint32_t fetch_neon(const int32_t *level_q8, const int32_t *cell_of, int32_t *bin_q8,
                                  uint32_t cells)
{
    return (void)level_q8, (void)cell_of, (void)bin_q8, (void)cells, 0;
}

static inline uint32_t power_neon(uint32_t *power_q24, uint32_t cells)
{
    return (void)power_q24, (void)cells, 0;
}

#endif

#endif
