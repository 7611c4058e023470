#include "lm/tone.h"

#include "fx/log.h"
#include "lm/status.h"

/* round(255 (n / 1023)^gamma) */
static uint8_t grey_of_step(uint32_t n, uint32_t gamma_q8)
{
    if (n == 0) {
        return 0;
    }
    /* log2(n / 1023) is -10..0 in Q16; times gamma up to 4: above -2^22. */
    const int32_t log2_q16 = fx_log2_q16(n) - fx_log2_q16(LM_TONE_STEPS - 1);
    const uint32_t power_q16 = fx_exp2_q16((int32_t)((int64_t)log2_q16 * (int32_t)gamma_q8 / 256));
    return (uint8_t)((255u * power_q16 + 32768u) >> 16);
}

int lm_tone_set(struct lm_tone *t, const struct lm_tone_config *config)
{
    const int32_t span_q8 = config->white_q8 - config->black_q8;
    if (span_q8 < 256 || config->gamma_q8 < 26 || config->gamma_q8 > 1024) {
        return LM_ERR_RANGE;
    }
    t->black_q8 = config->black_q8;
    t->scale_q16 = ((uint32_t)(LM_TONE_STEPS - 1) << 16) / (uint32_t)span_q8;
    for (uint32_t n = 0; n < LM_TONE_STEPS; n++) {
        t->grey[n] = grey_of_step(n, config->gamma_q8);
    }
    return LM_OK;
}

void lm_tone_run(const struct lm_tone *t, const int32_t *level_q8, uint8_t *grey, uint32_t cells)
{
    /* One step beyond the window is enough to know that it is beyond: the clamp before the product keeps it in
     * 32 bits (window below 2^16, scale below 2^18 * 65536 / 256). */
    const int32_t span_q8 = (int32_t)(((uint32_t)(LM_TONE_STEPS - 1) << 16) / t->scale_q16) + 1;
    for (uint32_t i = 0; i < cells; i++) {
        int32_t above_q8 = level_q8[i] - t->black_q8;
        above_q8 = above_q8 < 0 ? 0 : above_q8;
        above_q8 = above_q8 > span_q8 ? span_q8 : above_q8;
        uint32_t step = ((uint32_t)above_q8 * t->scale_q16 + 32768u) >> 16;
        step = step < LM_TONE_STEPS ? step : LM_TONE_STEPS - 1;
        grey[i] = t->grey[step];
    }
}
