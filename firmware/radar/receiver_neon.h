/* Signal, noise and logarithm of sixteen bins at a time, by the vectors of 64-bit Arm, to the bit
 * as in receiver.c. Not for other machines, where it is never called. */
#ifndef RECEIVER_NEON_H
#define RECEIVER_NEON_H

#include <stddef.h>

#include "fx/log.h"
#include "fx/neon.h"
#include "lm/noise.h"
#include "lm/receiver.h"

enum { UNIT_Q24_DB_Q8 = 24 * FX_DB_OCTAVE_Q14 / 64 }; /* what 2^24 is to 1 */

#if FX_HAS_NEON

static inline int32x4x2_t neon_signal_q8(const uint32_t *power_q24)
{
    const int32x4_t unit = vdupq_n_s32(-UNIT_Q24_DB_Q8);
    const int32x4_t nothing = vdupq_n_s32(fx_db_q8_of_many(0) - UNIT_Q24_DB_Q8);
    const uint32x4x2_t power = {{vld1q_u32(power_q24), vld1q_u32(power_q24 + 4)}};
    const int32x4x2_t some = fx_neon_add_db_q8((int32x4x2_t){{unit, unit}}, power);
    return (int32x4x2_t){{vbslq_s32(vceqzq_u32(power.val[0]), nothing, some.val[0]),
                          vbslq_s32(vceqzq_u32(power.val[1]), nothing, some.val[1])}};
}

static inline void detect_neon(const struct lm_receiver *r, int32_t rise_q8,
                               const struct lm_noise_line *noise, const uint32_t *power_q24,
                               int32_t *restrict level_q8)
{
    const int16_t *const row_q8 = lm_noise_q8[r->looks_log2];
    const uint32_t cells = r->cells;
    const int32x4_t rise = vdupq_n_s32(rise_q8);
    const uint8x16x4_t lows = vld1q_u8_x4(fx_table_db_sum_lines[0]);
    const uint8x16x4_t highs = vld1q_u8_x4(fx_table_db_sum_lines[1]);
    const uint8x16x4_t falls = vld1q_u8_x4(fx_table_db_sum_lines[2]);
    for (size_t i = 0; i < cells; i += 2 * LM_NOISE_BLOCK) {
        /* A block that is left over is done twice at once. */
        const size_t next = i + LM_NOISE_BLOCK < cells ? i + LM_NOISE_BLOCK : i;
        const int16x8_t draw_q8[2] = {vld1q_s16(row_q8 + noise->entry[i / LM_NOISE_BLOCK]),
                                      vld1q_s16(row_q8 + noise->entry[next / LM_NOISE_BLOCK])};
        const int32x4x4_t mean = fx_neon_load_8_and_8(r->noise_q8 + i, r->noise_q8 + next);
        const int32x4x4_t fall = fx_neon_load_8_and_8(r->fall_q8 + i, r->fall_q8 + next);
        const int32x4x2_t signal[2] = {neon_signal_q8(power_q24 + i),
                                       neon_signal_q8(power_q24 + next)};
        int32x4x4_t noisy, level;
        for (size_t n = 0; n < 2; n++) {
            noisy.val[2 * n] =
                vaddw_s16(vaddq_s32(mean.val[2 * n], rise), vget_low_s16(draw_q8[n]));
            noisy.val[2 * n + 1] = vaddw_high_s16(vaddq_s32(mean.val[2 * n + 1], rise), draw_q8[n]);
        }
        const int32x4x4_t both = {
            {signal[0].val[0], signal[0].val[1], signal[1].val[0], signal[1].val[1]}};
        level = fx_neon_db_q8_sum(lows, highs, falls, both, noisy);
        for (size_t k = 0; k < 4; k++) {
            level.val[k] = vsubq_s32(level.val[k], fall.val[k]);
        }
        fx_neon_store_8_and_8(level_q8 + i, level_q8 + next, level);
    }
}

#else

static inline void detect_neon(const struct lm_receiver *r, int32_t rise_q8,
                               const struct lm_noise_line *noise, const uint32_t *power_q24,
                               int32_t *restrict level_q8)
{
    (void)r, (void)rise_q8, (void)noise, (void)power_q24, (void)level_q8;
}

#endif

#endif
