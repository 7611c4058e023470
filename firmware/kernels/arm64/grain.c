#include "neon_curve.h"

enum { NEON_CELLS = 16 }; /* that a turn takes */

void lm_k_grain_add(const struct lm_k_curve *curve, const int8_t *grain_q5,
                    int16_t *restrict level_q8, uint32_t cells)
{
    const struct neon_curve lines = neon_curve_of(curve);
    for (size_t i = 0; i < cells; i += NEON_CELLS) {
        const int16x8x2_t db_q8 = neon_curve_db_q8(&lines, vld1q_s8(grain_q5 + i));
        const int16x8x2_t level = vld1q_s16_x2(level_q8 + i);
        vst1q_s16_x2(level_q8 + i, neon_add_16(level, db_q8));
    }
}

void lm_k_grain_floor(const struct lm_k_curve *curve, const int8_t *grain_q5, int32_t floor_q8,
                      const int16_t *level_q8, int16_t *restrict noisy_q8, uint32_t cells)
{
    const struct neon_curve lines = neon_curve_of(curve);
    const struct neon_sum_rows rows = neon_sum_rows();
    const int16x8_t floor = neon_held_8(vdupq_n_s32(floor_q8), vdupq_n_s32(floor_q8));
    for (size_t i = 0; i < cells; i += NEON_CELLS) {
        const int16x8x2_t level = vld1q_s16_x2(level_q8 + i), other = {{floor, floor}};
        const uint16x8x2_t more_q13 =
            neon_look_up_more_q13(&rows, neon_db_sum_of_levels(level, other));
        const int16x8x2_t sum = neon_db_sum_raised(level, other, more_q13);
        const int16x8x2_t db_q8 = neon_curve_db_q8(&lines, vld1q_s8(grain_q5 + i));
        vst1q_s16_x2(noisy_q8 + i, neon_add_16(sum, db_q8));
    }
}

/* Eight numbers between two of the field. Sums are below 2^15. */
static inline int8x8_t neon_between(int8x8_t first, uint8x8_t first_q7, int8x8_t second,
                                    uint8x8_t second_q7)
{
    const int16x8_t sum_q7 =
        vmlaq_s16(vmulq_s16(vmovl_s8(first), vreinterpretq_s16_u16(vmovl_u8(first_q7))),
                  vmovl_s8(second), vreinterpretq_s16_u16(vmovl_u8(second_q7)));
    return vqrshrn_n_s16(sum_q7, 7);
}

/* Sixteen cells lie among seventeen columns: they are looked up in registers. Weights of ways from
 * 1 to 64 are those of the first, read backwards; those of 0 to 63 the second's. */
void lm_k_grain_stretch(const uint8_t *weight_q7, uint32_t step_q16, const int8_t *column_q5,
                        int8_t *grain_q5, uint32_t cells)
{
    const uint8x16x4_t first_q7 = vld1q_u8_x4(weight_q7 + 1), second_q7 = vld1q_u8_x4(weight_q7);
    const uint32x4_t k = {0, 1, 2, 3};
    const uint32x4_t step = vdupq_n_u32(4 * step_q16);
    uint32x4_t at_q16 = vmulq_n_u32(k, step_q16);
    for (uint32_t i = 0; i < cells; i += NEON_CELLS) {
        const int8_t *const from = column_q5 + ((i * step_q16) >> 16);
        const int8x16x2_t columns = {{vld1q_s8(from), vld1q_s8(from + 16)}};
        uint32x4x4_t at;
        for (size_t n = 0; n < 4; n++) {
            at.val[n] = at_q16;
            at_q16 = vaddq_u32(at_q16, step);
        }
        const uint16x8x2_t whole = neon_upper_halves(at), part = neon_lower_halves(at);
        const uint8x16_t way = vshrq_n_u8(
            vuzp2q_u8(vreinterpretq_u8_u16(part.val[0]), vreinterpretq_u8_u16(part.val[1])), 2);
        const uint8x16_t column = neon_lower_bytes(whole);
        const uint8x16_t west = vsubq_u8(column, vdupq_laneq_u8(column, 0));
        const int8x16_t first = vqtbl2q_s8(columns, west);
        const int8x16_t second = vqtbl2q_s8(columns, vaddq_u8(west, vdupq_n_u8(1)));
        const uint8x16_t of_first =
            vqtbl4q_u8(first_q7, vsubq_u8(vdupq_n_u8(LM_K_GRAIN_WAY - 1), way));
        const uint8x16_t of_second = vqtbl4q_u8(second_q7, way);
        vst1_s8(grain_q5 + i, neon_between(vget_low_s8(first), vget_low_u8(of_first),
                                           vget_low_s8(second), vget_low_u8(of_second)));
        vst1_s8(grain_q5 + i + 8, neon_between(vget_high_s8(first), vget_high_u8(of_first),
                                               vget_high_s8(second), vget_high_u8(of_second)));
    }
}
