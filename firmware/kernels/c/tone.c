#include "fx/sat.h"
#include "lm/kernels_radar.h"

void lm_k_tone(const struct lm_k_tone_curve *tone, const int16_t *level_db_q8,
               uint8_t *restrict grey, uint32_t cells)
{
    const int32_t black_db_q8 = tone->black_db_q8, white_db_q8 = tone->white_db_q8;
    const int32_t step_log2 = tone->step_log2, *grey_of_step = tone->grey_of_step;
    const int32_t start_db_q8 = black_db_q8 - (1 << step_log2 >> 1); /* half a step before black */
    for (uint32_t i = 0; i < cells; i++) {
        const int32_t above_db_q8 =
            fx_clamp_i32(level_db_q8[i], black_db_q8, white_db_q8) - start_db_q8;
        grey[i] = (uint8_t)grey_of_step[above_db_q8 >> step_log2];
    }
}
