#include "../plain.h"
#include "neon.h"

/* Sixteen levels at a time; the lines of the curve stay in registers. */

/* A window, eight times, and where its step 0 begins; what makes steps of the levels above that. */
struct tone_window {
    int16x8_t black_db_q8, white_db_q8;
    uint16x8_t start_db_q8; /* modulo 2^16 */
    int16x8_t minus_step_log2;
};

/* Steps of eight levels. Above the window's start, 16 bits without a sign hold all of it. */
static inline uint16x8_t neon_step(const struct tone_window *w, const int16_t *level_db_q8)
{
    const int16x8_t level = vld1q_s16(level_db_q8);
    const int16x8_t within = vminq_s16(vmaxq_s16(level, w->black_db_q8), w->white_db_q8);
    return vshlq_u16(vsubq_u16(vreinterpretq_u16_s16(within), w->start_db_q8), w->minus_step_log2);
}

void lm_k_tone(const struct lm_k_tone_curve *t, const int16_t *level_q8, uint8_t *restrict grey,
               uint32_t cells)
{
    if (!t->pieces) {
        lm_k_tone_c(t, level_q8, grey, cells);
        return;
    }
    const int32_t start_q8 = t->black_db_q8 - (1 << t->step_log2 >> 1);
    const struct tone_window window = {
        vdupq_n_s16((int16_t)t->black_db_q8), vdupq_n_s16((int16_t)t->white_db_q8),
        vdupq_n_u16((uint16_t)start_q8), vdupq_n_s16((int16_t)-t->step_log2)};
    const uint8x16x4_t lows = vld1q_u8_x4(t->pieces[0]), highs = vld1q_u8_x4(t->pieces[1]);
    const uint8x16x4_t slopes = vld1q_u8_x4(t->pieces[2]);
    const uint32_t whole = cells & ~15u;
    for (size_t i = 0; i < whole; i += 16) {
        const uint16x8_t first = neon_step(&window, level_q8 + i);
        const uint16x8_t second = neon_step(&window, level_q8 + i + 8);
        const uint8x16_t line = vshrn_high_n_u16(vshrn_n_u16(first, LM_K_TONE_PIECE_STEPS_LOG2),
                                                 second, LM_K_TONE_PIECE_STEPS_LOG2);
        const uint8x16_t place =
            vuzp1q_u8(vreinterpretq_u8_u16(first), vreinterpretq_u8_u16(second));
        const uint8x16_t low = vqtbl4q_u8(lows, line), high = vqtbl4q_u8(highs, line);
        const uint8x16_t slope = vqtbl4q_u8(slopes, line);
        const uint16x8_t first_grey_q8 = vmlal_u8(vreinterpretq_u16_u8(vzip1q_u8(low, high)),
                                                  vget_low_u8(slope), vget_low_u8(place));
        const uint16x8_t second_grey_q8 =
            vmlal_high_u8(vreinterpretq_u16_u8(vzip2q_u8(low, high)), slope, place);
        vst1q_u8(grey + i, vuzp2q_u8(vreinterpretq_u8_u16(first_grey_q8),
                                     vreinterpretq_u8_u16(second_grey_q8)));
    }
    if (whole < cells) {
        lm_k_tone_c(t, level_q8 + whole, grey + whole, cells - whole);
    }
}
