#include "lm/kernels_radar.h"
#include "neon.h"

enum { NEON_CELLS = 16 };

/* The floors of eight cells are `at`. The last cells, fewer than eight, are taken one by one. */
void lm_k_add_slope(uint32_t *power_q24, uint32_t cells, uint32_t from_q24, uint32_t step)
{
    const uint32x4_t k = {0, 1, 2, 3}, eight = vdupq_n_u32(8 * step), one = vdupq_n_u32(step);
    uint32x4x2_t at, power;
    at.val[0] = vmlaq_n_u32(vdupq_n_u32(from_q24 << LM_K_SLOPE_PLACES), k, step);
    at.val[1] = vaddq_u32(at.val[0], vdupq_n_u32(4 * step));
    uint32_t i = 0;
    for (; i + 8 <= cells; i += 8) {
        power = vld1q_u32_x2(power_q24 + i);
        for (size_t n = 0; n < 2; n++) {
            power.val[n] = vqaddq_u32(power.val[n], vshrq_n_u32(at.val[n], LM_K_SLOPE_PLACES));
            at.val[n] = vaddq_u32(at.val[n], eight);
        }
        vst1q_u32_x2(power_q24 + i, power);
    }
    for (; i < cells; i++, at.val[0] = vaddq_u32(at.val[0], one)) {
        const uint32x4_t floor = vshrq_n_u32(at.val[0], LM_K_SLOPE_PLACES);
        power_q24[i] = vqadds_u32(power_q24[i], vgetq_lane_u32(floor, 0));
    }
}

void lm_k_fade(const uint32_t *restrict speckle_q24, uint32_t *restrict power_q24, uint32_t cells)
{
    for (uint32_t i = 0; i < cells; i += NEON_CELLS) {
        uint32x4x4_t power = vld1q_u32_x4(power_q24 + i);
        const uint32x4x4_t speckle = vld1q_u32_x4(speckle_q24 + i);
        for (size_t n = 0; n < 4; n++) {
            power.val[n] = vqshrn_high_n_u64(
                vqshrn_n_u64(vmull_u32(vget_low_u32(power.val[n]), vget_low_u32(speckle.val[n])),
                             24),
                vmull_high_u32(power.val[n], speckle.val[n]), 24);
        }
        vst1q_u32_x4(power_q24 + i, power);
    }
}
