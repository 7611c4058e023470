#include "lm/tone.h"

#include "fx/log.h"
#include "fx/sat.h"
#include "lm/status.h"

/* round(255 v^gamma) for v = above / span, 0..1. */
static uint8_t grey_of(int32_t above_q8, int32_t span_q8, int32_t gamma_q8)
{
    if (above_q8 <= 0) {
        return 0;
    }
    /* log2 v is -16..0 in Q16; times gamma up to 4: above -2^22. */
    const int32_t log2_q16 =
        fx_log2_q16((uint32_t)fx_min_i32(above_q8, span_q8)) - fx_log2_q16((uint32_t)span_q8);
    const uint32_t power_q16 = fx_exp2_q16((int32_t)((int64_t)log2_q16 * gamma_q8 / 256));
    return (uint8_t)((255u * power_q16 + 32768u) >> 16);
}

int lm_tone_set(struct lm_tone *t, const struct lm_tone_config *config)
{
    const int32_t span_q8 = config->white_q8 - config->black_q8;
    if (span_q8 < 256 || config->gamma_q8 < 26 || config->gamma_q8 > 1024) {
        return LM_ERR_RANGE;
    }
    for (int32_t n = 0; n < LM_TONE_STEPS; n++) {
        const int32_t middle_q8 = LM_TONE_LOWEST_Q8 + n * LM_TONE_STEP_Q8 + LM_TONE_STEP_Q8 / 2;
        t->grey[n] = grey_of(middle_q8 - config->black_q8, span_q8, config->gamma_q8);
    }
    return LM_OK;
}

void lm_tone_run(const struct lm_tone *t, const int32_t *level_q8, uint8_t *restrict grey,
                 uint32_t cells)
{
    for (uint32_t i = 0; i < cells; i++) {
        const int32_t step = (level_q8[i] - LM_TONE_LOWEST_Q8) >> 4;
        grey[i] = (uint8_t)t->grey[fx_clamp_i32(step, 0, LM_TONE_STEPS - 1)];
    }
}
