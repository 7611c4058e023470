/* Signal, noise and logarithm of eight bins at a time, by the vectors of 64-bit Arm, to the bit as
 * in receiver.c. Not for other machines, where it is never called. */
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
    const struct fx_neon_db_sum lines = fx_neon_db_sum_lines();
    for (size_t i = 0; i < cells; i += LM_NOISE_BLOCK) {
        const int16x8_t draw_q8 = vld1q_s16(row_q8 + noise->entry[i / LM_NOISE_BLOCK]);
        const int32x4_t low = vaddq_s32(vld1q_s32(r->noise_q8 + i), rise);
        const int32x4_t high = vaddq_s32(vld1q_s32(r->noise_q8 + i + 4), rise);
        const int32x4x2_t noisy = {
            {vaddw_s16(low, vget_low_s16(draw_q8)), vaddw_high_s16(high, draw_q8)}};
        const int32x4x2_t both = fx_neon_db_q8_sum(&lines, neon_signal_q8(power_q24 + i), noisy);
        vst1q_s32(level_q8 + i, vsubq_s32(both.val[0], vld1q_s32(r->fall_q8 + i)));
        vst1q_s32(level_q8 + i + 4, vsubq_s32(both.val[1], vld1q_s32(r->fall_q8 + i + 4)));
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
