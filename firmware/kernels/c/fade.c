#include "lm/kernels_radar.h"

void lm_k_add_slope(uint32_t *power_q24, uint32_t cells, uint32_t from_q24, uint32_t step)
{
    for (uint32_t i = 0; i < cells; i++) {
        const uint32_t floor_q24 =
            ((from_q24 << LM_K_SLOPE_PLACES) + i * step) >> LM_K_SLOPE_PLACES;
        const uint32_t sum_q24 = power_q24[i] + floor_q24;
        power_q24[i] = sum_q24 < floor_q24 ? UINT32_MAX : sum_q24;
    }
}

void lm_k_fade(const uint32_t *restrict speckle_q24, uint32_t *restrict power_q24, uint32_t cells)
{
    for (uint32_t i = 0; i < cells; i++) {
        const uint64_t product = (uint64_t)power_q24[i] * speckle_q24[i] >> 24;
        power_q24[i] = product < UINT32_MAX ? (uint32_t)product : UINT32_MAX;
    }
}
