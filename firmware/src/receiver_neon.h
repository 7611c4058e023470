/* Signal, noise and logarithm of eight bins at a time, by the vectors of 64-bit Arm, to the bit as
 * in receiver.c. Returns how many bins it did, which is none on other machines. */
#ifndef RECEIVER_NEON_H
#define RECEIVER_NEON_H

#include <stddef.h>

#include "fx/log.h"
#include "fx/neon.h"
#include "lm/receiver.h"
#include "lm/speckle.h"

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

/* Four bins' noise, whose hashes have such sums. */
static inline int32x4_t neon_noise_q8(const int32_t *table_q8, const int32_t *noise_q8,
                                      int32x4_t rise_q8, uint32x4_t sum)
{
    const uint32x4_t slice = vshrq_n_u32(fx_neon_hash3_of_sum(sum), 22);
    return vaddq_s32(vaddq_s32(vld1q_s32(noise_q8), rise_q8),
                     fx_neon_lookup(table_q8, vreinterpretq_s32_u32(slice)));
}

static inline uint32_t detect_neon(const struct lm_receiver *r, int32_t rise_q8, uint32_t line,
                                   uint32_t epoch, const uint32_t *power_q24,
                                   int32_t *restrict level_q8)
{
    const uint32x4_t from = {0, 1, 2, 3};
    const uint32_t of_bin = fx_hash3_sum(0, 1, 0), whole = r->cells & ~7u;
    const int32_t *const table_q8 = lm_speckle_q8[r->looks_log2];
    const int32x4_t rise = vdupq_n_s32(rise_q8);
    uint32x4_t sum = vmlaq_n_u32(vdupq_n_u32(fx_hash3_sum(line, 0, epoch)), from, of_bin);
    for (size_t i = 0; i < whole; i += 8) {
        const uint32x4_t next = vaddq_u32(sum, vdupq_n_u32(4 * of_bin));
        const int32x4x2_t noise = {{neon_noise_q8(table_q8, r->noise_q8 + i, rise, sum),
                                    neon_noise_q8(table_q8, r->noise_q8 + i + 4, rise, next)}};
        const int32x4x2_t both = fx_neon_db_q8_sum(neon_signal_q8(power_q24 + i), noise);
        vst1q_s32(level_q8 + i, vsubq_s32(both.val[0], vld1q_s32(r->fall_q8 + i)));
        vst1q_s32(level_q8 + i + 4, vsubq_s32(both.val[1], vld1q_s32(r->fall_q8 + i + 4)));
        sum = vaddq_u32(next, vdupq_n_u32(4 * of_bin));
    }
    return whole;
}

#else

static inline uint32_t detect_neon(const struct lm_receiver *r, int32_t rise_q8, uint32_t line,
                                   uint32_t epoch, const uint32_t *power_q24, int32_t *level_q8)
{
    return (void)r, (void)rise_q8, (void)line, (void)epoch, (void)power_q24, (void)level_q8, 0;
}

#endif

#endif
