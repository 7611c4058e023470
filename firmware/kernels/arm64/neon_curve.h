/* Speckle of the grain's numbers by a curve: lm/kernels_clutter.h. */
#ifndef NEON_CURVE_H
#define NEON_CURVE_H

#include "lm/kernels_clutter.h"
#include "neon.h"

/* A curve's lines in registers: lower bytes and upper bytes. Those of numbers from 0 on come first,
 * so that the upper bits of a number choose its line as they are. */
struct neon_curve {
    uint8x16_t base[2], rise[2];
};

static inline void neon_curve_rows(const int32_t *table, uint8x16_t rows[2])
{
    const int32x4x4_t word = vld1q_s32_x4(table);
    const uint8x16_t first =
        vreinterpretq_u8_s16(vmovn_high_s32(vmovn_s32(word.val[0]), word.val[1]));
    const uint8x16_t second =
        vreinterpretq_u8_s16(vmovn_high_s32(vmovn_s32(word.val[2]), word.val[3]));
    rows[0] = vuzp1q_u8(second, first);
    rows[1] = vuzp2q_u8(second, first);
}

static inline struct neon_curve neon_curve_of(const struct lm_k_curve *curve)
{
    struct neon_curve c;
    neon_curve_rows(curve->base_db_q8, c.base);
    neon_curve_rows(curve->rise_db_q8, c.rise);
    return c;
}

/* The speckle of sixteen numbers. A rise times 15 takes 16 bits. */
static inline int16x8x2_t neon_curve_db_q8(const struct neon_curve *curve, int8x16_t grain_q5)
{
    const uint8x16_t c = vreinterpretq_u8_s8(grain_q5);
    const uint8x16_t line = vshrq_n_u8(c, 4), place = vandq_u8(c, vdupq_n_u8(15));
    const uint16x8x2_t base = neon_words_of_16(curve->base, line);
    const uint16x8x2_t rise = neon_words_of_16(curve->rise, line);
    const uint16x8_t low = vmulq_u16(rise.val[0], vmovl_u8(vget_low_u8(place)));
    const uint16x8_t high = vmulq_u16(rise.val[1], vmovl_high_u8(place));
    return (int16x8x2_t){{vreinterpretq_s16_u16(vsraq_n_u16(base.val[0], low, 4)),
                          vreinterpretq_s16_u16(vsraq_n_u16(base.val[1], high, 4))}};
}

/* Sixteen levels, each with its speckle added. */
static inline int16x8x2_t neon_add_16(int16x8x2_t level_db_q8, int16x8x2_t db_q8)
{
    return (int16x8x2_t){{vqaddq_s16(level_db_q8.val[0], db_q8.val[0]),
                          vqaddq_s16(level_db_q8.val[1], db_q8.val[1])}};
}

#endif
