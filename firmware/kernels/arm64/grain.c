#include "neon_curve.h"

enum { NEON_CELLS = 16 }; /* that a turn takes */

void lm_k_grain_add(const struct lm_k_curve *curve, const int8_t *grain_q5,
                    int32_t *restrict level_q8, uint32_t cells)
{
    const struct neon_curve lines = neon_curve_of(curve);
    for (size_t i = 0; i < cells; i += NEON_CELLS) {
        const int16x8x2_t db_q8 = neon_curve_db_q8(&lines, vld1q_s8(grain_q5 + i));
        vst1q_s32_x4(level_q8 + i, neon_add_16(vld1q_s32_x4(level_q8 + i), db_q8));
    }
}

void lm_k_grain_floor(const struct lm_k_curve *curve, const int8_t *grain_q5, int32_t floor_q8,
                      const int32_t *level_q8, int32_t *restrict noisy_q8, uint32_t cells)
{
    const struct neon_curve lines = neon_curve_of(curve);
    const uint8x16x4_t lows = vld1q_u8_x4(fx_table_db_sum_lines[0]);
    const uint8x16x4_t highs = vld1q_u8_x4(fx_table_db_sum_lines[1]);
    const uint8x16x4_t falls = vld1q_u8_x4(fx_table_db_sum_lines[2]);
    const int32x4_t one = vdupq_n_s32(floor_q8);
    const int32x4x4_t floor = {{one, one, one, one}};
    for (size_t i = 0; i < cells; i += NEON_CELLS) {
        const int32x4x4_t level = vld1q_s32_x4(level_q8 + i);
        const int32x4x4_t sum = neon_db_q8_sum(lows, highs, falls, level, floor);
        const int16x8x2_t db_q8 = neon_curve_db_q8(&lines, vld1q_s8(grain_q5 + i));
        vst1q_s32_x4(noisy_q8 + i, neon_add_16(sum, db_q8));
    }
}
