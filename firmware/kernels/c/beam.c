#include "lm/kernels_radar.h"

/* The sum / 2^16 of the powers' halves: as weights add up to 2^16, the sum of either half fits 32
 * bits, and the upper one's is whole. */
static uint32_t sum_of(const uint32_t *const power_q24[LM_K_TAPS], const uint32_t *weight_q16,
                       uint32_t i)
{
    uint32_t upper = 0, lower = 0;
    for (uint32_t j = 0; j < LM_K_TAPS; j++) {
        upper += (power_q24[j][i] >> 16) * weight_q16[j];
        lower += (power_q24[j][i] & 0xffff) * weight_q16[j];
    }
    return upper + (lower >> 16);
}

void lm_k_beam_sum(const uint32_t *const power_q24[LM_K_TAPS], const uint32_t *weight_q16,
                   uint32_t *restrict sum_q24, uint32_t cells)
{
    const uint32_t *power[LM_K_TAPS];
    uint32_t weight[LM_K_TAPS];
    for (uint32_t j = 0; j < LM_K_TAPS; j++) {
        power[j] = power_q24[j];
        weight[j] = weight_q16[j];
    }
    for (uint32_t i = 0; i < cells; i++) {
        sum_q24[i] = sum_of(power, weight, i);
    }
}
