#include "../plain.h"
#include "neon.h"

static inline int32x4x4_t neon_load_16(const int32_t *from)
{
    return neon_load_8_and_8(from, from + 8);
}

/* The sums of both, less `less_q8` and not below `least_db_q8`, into `to_db_q8`, which may be
 * either. Returns how many cells these are: whole sixteens. */
static inline uint32_t neon_sum(const int32_t *sum_q8, const int32_t *level_db_q8, int32_t less_q8,
                                int32_t least_db_q8, int32_t *to_db_q8, uint32_t cells)
{
    const uint32_t whole = cells & ~15u;
    const int32x4_t less = vdupq_n_s32(less_q8), least = vdupq_n_s32(least_db_q8);
    const uint8x16x4_t lows = vld1q_u8_x4(fx_table_db_sum_lines[0]);
    const uint8x16x4_t highs = vld1q_u8_x4(fx_table_db_sum_lines[1]);
    const uint8x16x4_t falls = vld1q_u8_x4(fx_table_db_sum_lines[2]);
    for (size_t i = 0; i < whole; i += 16) {
        int32x4x4_t sum = neon_db_q8_sum(lows, highs, falls, neon_load_16(sum_q8 + i),
                                         neon_load_16(level_db_q8 + i));
        for (size_t k = 0; k < 4; k++) {
            sum.val[k] = vmaxq_s32(vsubq_s32(sum.val[k], less), least);
        }
        neon_store_8_and_8(to_db_q8 + i, to_db_q8 + i + 8, sum);
    }
    return whole;
}

void lm_k_levels_add(int32_t *sum_db_q8, const int32_t *level_db_q8, uint32_t cells)
{
    const uint32_t whole = neon_sum(sum_db_q8, level_db_q8, 0, INT32_MIN, sum_db_q8, cells);
    if (whole < cells) {
        lm_k_levels_add_c(sum_db_q8 + whole, level_db_q8 + whole, cells - whole);
    }
}

void lm_k_levels_mean(const int32_t *sum_db_q8, int32_t less_db_q8, int32_t least_db_q8,
                      int32_t *level_db_q8, uint32_t cells)
{
    const uint32_t whole =
        neon_sum(sum_db_q8, level_db_q8, less_db_q8, least_db_q8, level_db_q8, cells);
    if (whole < cells) {
        lm_k_levels_mean_c(sum_db_q8 + whole, less_db_q8, least_db_q8, level_db_q8 + whole,
                           cells - whole);
    }
}

void lm_k_highest(const int32_t *level_db_q8, int32_t *highest_db_q8, uint32_t cells)
{
    for (size_t i = 0; i < cells; i += LM_K_HIGHEST_CELLS) {
        const int32x4x4_t level = vld1q_s32_x4(level_db_q8 + i);
        *highest_db_q8++ = vmaxvq_s32(vmaxq_s32(vmaxq_s32(level.val[0], level.val[1]),
                                                vmaxq_s32(level.val[2], level.val[3])));
    }
}

static inline int16x8_t neon_narrow_8(const int32_t *from)
{
    return vqmovn_high_s32(vqmovn_s32(vld1q_s32(from)), vld1q_s32(from + 4));
}

static inline int16x8_t neon_held(int32_t x)
{
    return vqmovn_high_s32(vqmovn_s32(vdupq_n_s32(x)), vdupq_n_s32(x));
}

uint32_t lm_k_stand_out(const int32_t *level_db_q8, int32_t least_db_q8, int32_t above_db_q8)
{
    const uint8x16_t bit = {1, 2, 4, 8, 16, 32, 64, 128, 1, 2, 4, 8, 16, 32, 64, 128};
    const int16x8_t least = neon_held(least_db_q8), above = neon_held(above_db_q8);
    int16x8_t level[3];
    uint8x16_t does[2];
    for (size_t n = 0; n < 3; n++) {
        level[n] = neon_narrow_8(level_db_q8 - LM_K_BESIDE + 8 * n);
    }
    for (size_t n = 0; n < 2; n++) {
        const int16x8_t cell = vextq_s16(level[n], level[n + 1], LM_K_BESIDE);
        const int16x8_t most = vqsubq_s16(cell, above);
        does[n] = vreinterpretq_u8_u16(
            vandq_u16(vcgeq_s16(cell, least),
                      vandq_u16(vcgeq_s16(most, level[n]), vcgeq_s16(most, level[n + 1]))));
    }
    const uint8x16_t mask = vandq_u8(vuzp1q_u8(does[0], does[1]), bit);
    return vaddv_u8(vget_low_u8(mask)) | (uint32_t)vaddv_u8(vget_high_u8(mask)) << 8;
}

void lm_k_side_lobes(const int16_t *side_db_q8, int32_t point_db_q8, int32_t *level_db_q8)
{
    const int32x4_t point = vdupq_n_s32(point_db_q8), below = vdupq_n_s32(LM_K_LOBES_BELOW_DB_Q8);
    const int16x8_t side[2] = {vld1q_s16(side_db_q8), vld1q_s16(side_db_q8 + 8)};
    const int32x4x4_t level = neon_load_16(level_db_q8);
    const int32x4x4_t lobe = {
        {vaddw_s16(point, vget_low_s16(side[0])), vaddw_high_s16(point, side[0]),
         vaddw_s16(point, vget_low_s16(side[1])), vaddw_high_s16(point, side[1])}};
    int32x4x4_t sum =
        neon_db_q8_sum(vld1q_u8_x4(fx_table_db_sum_lines[0]), vld1q_u8_x4(fx_table_db_sum_lines[1]),
                       vld1q_u8_x4(fx_table_db_sum_lines[2]), level, lobe);
    for (size_t k = 0; k < 4; k++) {
        const uint32x4_t counts = vcgtq_s32(lobe.val[k], vsubq_s32(level.val[k], below));
        sum.val[k] = vbslq_s32(counts, sum.val[k], level.val[k]);
    }
    neon_store_8_and_8(level_db_q8, level_db_q8 + 8, sum);
}
