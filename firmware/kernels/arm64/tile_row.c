#include "../tile_row.h"

#include <arm_neon.h>

enum { RUN = 8 };

static inline uint16x8_t neon_pairs(const uint8_t *high, const uint8_t *low)
{
    return vorrq_u16(vshll_n_u8(vld1_u8(high), 8), vmovl_u8(vld1_u8(low)));
}

/* Each number becomes the sum of those up to it. */
static inline uint16x8_t neon_running_sum(uint16x8_t x)
{
    const uint16x8_t none = vdupq_n_u16(0);
    x = vaddq_u16(x, vextq_u16(none, x, 7));
    x = vaddq_u16(x, vextq_u16(none, x, 6));
    return vaddq_u16(x, vextq_u16(none, x, 4));
}

void lm_k_tile_row(struct lm_tile_point *points, const struct lm_tile_point *south,
                   const struct lm_k_strips *strips)
{
    uint16x8_t rise = vdupq_n_u16(0);
    uint32_t i = 0;
    for (; i + RUN <= LM_TILE_POINTS; i += RUN) {
        const uint16x8_t folded = neon_pairs(strips->left_high + i, strips->left_low + i);
        const uint16x8_t sign = vsubq_u16(vdupq_n_u16(0), vandq_u16(folded, vdupq_n_u16(1)));
        const uint16x8_t left = veorq_u16(vshrq_n_u16(folded, 1), sign);
        const uint16x8_t south_post = vld2q_u16((const uint16_t *)(south + i)).val[1];
        rise = vaddq_u16(neon_running_sum(left), vdupq_laneq_u16(rise, RUN - 1));
        const uint16x8_t cell = neon_pairs(strips->gamma + i, strips->class_height + i);
        vst2q_u16((uint16_t *)(points + i), (uint16x8x2_t){{cell, vaddq_u16(south_post, rise)}});
    }
    put_points(points, south, strips, i, vgetq_lane_u16(rise, RUN - 1));
}
