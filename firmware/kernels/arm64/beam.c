#include <arm_neon.h>
#include <stddef.h>

#include "../plain.h"

static void add_rest(const uint32_t *const power[LM_K_TAPS], const uint32_t *weight_q16,
                     uint32_t *restrict sum, uint32_t first, uint32_t cells)
{
    const uint32_t *rest[LM_K_TAPS];
    for (size_t j = 0; j < LM_K_TAPS; j++) {
        rest[j] = power[j] + first;
    }
    lm_k_beam_sum_c(rest, weight_q16, sum + first, cells - first);
}

void lm_k_beam_sum(const uint32_t *const power[LM_K_TAPS], const uint32_t *weight_q16,
                   uint32_t *restrict sum, uint32_t cells)
{
    const uint32_t whole = cells & ~15u;
    for (size_t i = 0; i < whole; i += 16) {
        uint64x2_t sums[8] = {vdupq_n_u64(0)}; /* of two cells each, below 2^48 */
        for (size_t j = 0; j < LM_K_TAPS; j++) {
            const uint32x4x4_t sample = vld1q_u32_x4(power[j] + i);
            for (size_t k = 0; k < 8; k += 2) {
                const uint32x4_t four = sample.val[k / 2];
                sums[k] = vmlal_n_u32(sums[k], vget_low_u32(four), weight_q16[j]);
                sums[k + 1] = vmlal_high_n_u32(sums[k + 1], four, weight_q16[j]);
            }
        }
        for (size_t k = 0; k < 8; k += 2) {
            const uint32x2_t low = vshrn_n_u64(sums[k], 16);
            vst1q_u32(sum + i + 2 * k, vshrn_high_n_u64(low, sums[k + 1], 16));
        }
    }
    if (whole < cells) {
        add_rest(power, weight_q16, sum, whole, cells);
    }
}
