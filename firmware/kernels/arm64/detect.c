#include "fx/log.h"
#include "lm/kernels_radar.h"
#include "lm/lanes.h"
#include "neon.h"

enum { NEON_CELLS = 2 * LM_LANES }; /* that a turn takes: two blocks of draws */

/* Rows of fx_table_db_sum_lines. */
struct neon_sum_lines {
    uint8x16x4_t lows, highs, falls;
};

static inline struct neon_sum_lines neon_sum_lines(void)
{
    return (struct neon_sum_lines){vld1q_u8_x4(fx_table_db_sum_lines[0]),
                                   vld1q_u8_x4(fx_table_db_sum_lines[1]),
                                   vld1q_u8_x4(fx_table_db_sum_lines[2])};
}

static inline int32x4x2_t neon_signal_q8(const uint32_t *power_q24)
{
    const int32x4_t unit = vdupq_n_s32(-LM_K_UNIT_Q24_DB_Q8);
    const int32x4_t nothing = vdupq_n_s32(fx_db_q8_vec(0) - LM_K_UNIT_Q24_DB_Q8);
    const uint32x4x2_t power = {{vld1q_u32(power_q24), vld1q_u32(power_q24 + 4)}};
    const int32x4x2_t some = neon_add_db_q8((int32x4x2_t){{unit, unit}}, power);
    return (int32x4x2_t){{vbslq_s32(vceqzq_u32(power.val[0]), nothing, some.val[0]),
                          vbslq_s32(vceqzq_u32(power.val[1]), nothing, some.val[1])}};
}

/* The signals of the bins from i and from `next` on. */
static inline int32x4x4_t neon_signals_q8(const uint32_t *power_q24, size_t i, size_t next)
{
    const int32x4x2_t a = neon_signal_q8(power_q24 + i), b = neon_signal_q8(power_q24 + next);
    return (int32x4x4_t){{a.val[0], a.val[1], b.val[0], b.val[1]}};
}

/* The mean noise of the same bins. */
static inline int32x4x4_t neon_means_q8(const struct lm_k_receiver *r, size_t i, size_t next)
{
    int32x4x4_t mean = neon_load_8_and_8(r->noise_db_q8 + i, r->noise_db_q8 + next);
    for (size_t k = 0; k < 4; k++) {
        mean.val[k] = vaddq_s32(mean.val[k], vdupq_n_s32(r->rise_db_q8));
    }
    return mean;
}

static inline int32x4x4_t neon_add_draws(const struct lm_k_receiver *r, size_t i, size_t next,
                                         int32x4x4_t noise)
{
    const int16x8_t draw_db_q8[2] = {vld1q_s16(r->row_db_q8 + r->entry[i / LM_LANES]),
                                     vld1q_s16(r->row_db_q8 + r->entry[next / LM_LANES])};
    for (size_t n = 0; n < 2; n++) {
        noise.val[2 * n] = vaddw_s16(noise.val[2 * n], vget_low_s16(draw_db_q8[n]));
        noise.val[2 * n + 1] = vaddw_high_s16(noise.val[2 * n + 1], draw_db_q8[n]);
    }
    return noise;
}

static inline int32x4x4_t neon_less(int32x4x4_t a, int32x4x4_t b)
{
    for (size_t k = 0; k < 4; k++) {
        a.val[k] = vsubq_s32(a.val[k], b.val[k]);
    }
    return a;
}

/* Signal and noise together, less the receiver's fall, of the same bins. */
static inline void neon_store_sum(const struct lm_k_receiver *r, const struct neon_sum_lines *lines,
                                  size_t i, size_t next, int32x4x4_t signal, int32x4x4_t noise,
                                  int16_t *level_db_q8)
{
    const int32x4x4_t fall = neon_load_8_and_8(r->fall_db_q8 + i, r->fall_db_q8 + next);
    const int32x4x4_t sum = neon_db_q8_sum(lines->lows, lines->highs, lines->falls, signal, noise);
    const int32x4x4_t level = neon_less(sum, fall);
    vst1q_s16(level_db_q8 + i, neon_held_8(level.val[0], level.val[1]));
    vst1q_s16(level_db_q8 + next, neon_held_8(level.val[2], level.val[3]));
}

/* The block beside block i / LM_LANES; a block that is left over is done twice at once. */
static inline size_t neon_next_block(size_t i, uint32_t cells)
{
    return i + LM_LANES < cells ? i + LM_LANES : i;
}

/* Signals of sixteen bins, biased: none is the least of 16 bits. */
static inline int16x8x2_t neon_signals_of_16(uint32x4x4_t power)
{
    const uint16x8_t unit = vdupq_n_u16(
        (uint16_t)(LM_K_DETECT_BIAS_DB_Q8 - LM_K_UNIT_Q24_DB_Q8 + NEON_31_OCTAVES_DB_Q8));
    const struct neon_levels some =
        neon_add_db_q8_of_16((uint16x8x2_t){{unit, unit}}, neon_octaves_of(power));
    int16x8x2_t signal;
    for (size_t n = 0; n < 2; n++) {
        signal.val[n] = vbslq_s16(some.is_none[n], vdupq_n_s16(INT16_MIN),
                                  vreinterpretq_s16_u16(some.level_db_q8.val[n]));
    }
    return signal;
}

/* The noise of the same bins, biased as the rise is. */
static inline int16x8x2_t neon_noise_of_16(const struct lm_k_receiver *r, size_t i, size_t next,
                                           int32x4_t rise)
{
    const size_t at[2] = {i, next};
    int16x8x2_t noise;
    for (size_t n = 0; n < 2; n++) {
        const int32_t *const mean = r->noise_db_q8 + at[n];
        const int16x8_t held =
            neon_held_8(vaddq_s32(vld1q_s32(mean), rise), vaddq_s32(vld1q_s32(mean + 4), rise));
        noise.val[n] = vqaddq_s16(held, vld1q_s16(r->row_db_q8 + r->entry[at[n] / LM_LANES]));
    }
    return noise;
}

void lm_k_detect(const struct lm_k_receiver *receiver, const uint32_t *power_q24,
                 int16_t *restrict level_q8, uint32_t cells)
{
    const struct lm_k_receiver r = *receiver;
    const struct neon_sum_lines lines = neon_sum_lines();
    const int32x4_t rise = vdupq_n_s32(r.rise_db_q8 + LM_K_DETECT_BIAS_DB_Q8);
    const int16x8_t bias = vdupq_n_s16(LM_K_DETECT_BIAS_DB_Q8);
    for (size_t i = 0; i < cells; i += NEON_CELLS) {
        const size_t next = neon_next_block(i, cells);
        const uint32x4x4_t power = {{vld1q_u32(power_q24 + i), vld1q_u32(power_q24 + i + 4),
                                     vld1q_u32(power_q24 + next), vld1q_u32(power_q24 + next + 4)}};
        const int16x8x2_t sum =
            neon_db_q8_sum_16(lines.lows, lines.highs, lines.falls, neon_signals_of_16(power),
                              neon_noise_of_16(&r, i, next, rise));
        const size_t at[2] = {i, next};
        for (size_t n = 0; n < 2; n++) {
            const int32_t *const fall = r.fall_db_q8 + at[n];
            const int16x8_t held = neon_held_8(vld1q_s32(fall), vld1q_s32(fall + 4));
            vst1q_s16(level_q8 + at[n], vqsubq_s16(vqsubq_s16(sum.val[n], bias), held));
        }
    }
}

void lm_k_detect_in_rain(const struct lm_k_receiver *receiver, const struct lm_k_rain *in_rain,
                         const uint32_t *power_q24, int16_t *restrict level_q8, uint32_t cells)
{
    const struct lm_k_receiver r = *receiver;
    const struct lm_k_rain w = *in_rain;
    const struct neon_sum_lines lines = neon_sum_lines();
    for (size_t i = 0; i < cells; i += NEON_CELLS) {
        const size_t next = neon_next_block(i, cells);
        const int32x4x4_t rain = neon_load_8_and_8(w.rain_db_q8 + i, w.rain_db_q8 + next);
        const int32x4x4_t loss = neon_load_8_and_8(w.loss_db_q8 + i, w.loss_db_q8 + next);
        const int32x4x4_t mean =
            neon_db_q8_sum(lines.lows, lines.highs, lines.falls, neon_means_q8(&r, i, next), rain);
        const int32x4x4_t signal = neon_less(neon_signals_q8(power_q24, i, next), loss);
        neon_store_sum(&r, &lines, i, next, signal, neon_add_draws(&r, i, next, mean), level_q8);
    }
}
