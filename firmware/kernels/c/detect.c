#include "draws.h"
#include "fx/log.h"
#include "fx/sat.h"
#include "lm/kernels_radar.h"

static inline int32_t signal_db_q8(uint32_t power_q24)
{
    return fx_db_q8_vec(power_q24) - LM_K_UNIT_Q24_DB_Q8;
}

void lm_k_detect(const struct lm_k_receiver *receiver, const uint32_t *restrict power_q24,
                 int16_t *restrict level_db_q8, uint32_t cells)
{
    const struct lm_k_receiver r = *receiver;
    const int32_t rise = r.rise_db_q8 + LM_K_DETECT_BIAS_DB_Q8;
    int32_t draw_db_q8[LM_CELLS_ROOM];
    draw(r.row_db_q8, r.entry, draw_db_q8, cells);
    for (uint32_t i = 0; i < cells; i++) {
        const int32_t noise = fx_sat_i16(fx_sat_i16(r.noise_db_q8[i] + rise) + draw_db_q8[i]);
        const int32_t signal = fx_sat_i16(signal_db_q8(power_q24[i]) + LM_K_DETECT_BIAS_DB_Q8);
        const int32_t sum = fx_sat_i16(fx_db_q8_sum_vec(signal, noise)) - LM_K_DETECT_BIAS_DB_Q8;
        level_db_q8[i] = fx_sat_i16(fx_sat_i16(sum) - fx_sat_i16(r.fall_db_q8[i]));
    }
}

void lm_k_detect_in_rain(const struct lm_k_receiver *receiver, const struct lm_k_rain *in_rain,
                         const uint32_t *restrict power_q24, int16_t *restrict level_db_q8,
                         uint32_t cells)
{
    const struct lm_k_receiver r = *receiver;
    const struct lm_k_rain w = *in_rain;
    int32_t draw_db_q8[LM_CELLS_ROOM];
    draw(r.row_db_q8, r.entry, draw_db_q8, cells);
    for (uint32_t i = 0; i < cells; i++) {
        const int32_t noise_db_q8 =
            fx_db_q8_sum_vec(r.noise_db_q8[i] + r.rise_db_q8, w.rain_db_q8[i]);
        const int32_t left_db_q8 = signal_db_q8(power_q24[i]) - w.loss_db_q8[i];
        /* draw() fills every cell.
         * NOLINTNEXTLINE(clang-analyzer-core.UndefinedBinaryOperatorResult) */
        const int32_t drawn_db_q8 = noise_db_q8 + draw_db_q8[i];
        level_db_q8[i] = fx_sat_i16(fx_db_q8_sum_vec(left_db_q8, drawn_db_q8) - r.fall_db_q8[i]);
    }
}
