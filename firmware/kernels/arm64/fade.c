#include "lm/kernels_radar.h"
#include "neon.h"

enum { NEON_CELLS = 16 };

/* The floor of sixteen cells from cell `from` on: none before cell `first`. */
static inline uint32x4x4_t neon_floor(uint32x4_t floor, uint32_t first, uint32_t from)
{
    const uint32x4_t k = {0, 1, 2, 3}, start = vdupq_n_u32(first);
    uint32x4x4_t of;
    for (uint32_t n = 0; n < 4; n++) {
        of.val[n] = vandq_u32(floor, vcgeq_u32(vaddq_u32(vdupq_n_u32(from + 4 * n), k), start));
    }
    return of;
}

void lm_k_fade(const struct lm_k_fade *lent, uint32_t *restrict power_q24, uint32_t cells)
{
    const struct lm_k_fade f = *lent; /* no store can change it */
    const uint32x4_t floor = vdupq_n_u32(f.floor_q24);
    uint32x4x4_t of = neon_floor(floor, f.first, 0);
    for (uint32_t i = 0; i < cells; i += NEON_CELLS) {
        uint32x4x4_t power = vld1q_u32_x4(power_q24 + i);
        const uint32x4x4_t speckle = vld1q_u32_x4(f.speckle_q24 + i);
        for (size_t n = 0; n < 4; n++) {
            const uint32x4_t filled = vqaddq_u32(power.val[n], of.val[n]);
            power.val[n] = vqshrn_high_n_u64(
                vqshrn_n_u64(vmull_u32(vget_low_u32(filled), vget_low_u32(speckle.val[n])), 24),
                vmull_high_u32(filled, speckle.val[n]), 24);
        }
        vst1q_u32_x4(power_q24 + i, power);
        if (i < f.first) {
            of = neon_floor(floor, f.first, i + NEON_CELLS);
        }
    }
}
