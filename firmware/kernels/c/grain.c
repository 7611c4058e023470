#include "curve.h"
#include "fx/log.h"
#include "fx/sat.h"

void lm_k_grain_add(const struct lm_k_curve *curve, const int8_t *grain_q5,
                    int16_t *restrict level_db_q8, uint32_t cells)
{
    const int32_t *base_db_q8 = curve->base_db_q8, *rise_db_q8 = curve->rise_db_q8;
    for (uint32_t i = 0; i < cells; i++) {
        level_db_q8[i] =
            fx_sat_i16(level_db_q8[i] + curve_db_q8(base_db_q8, rise_db_q8, grain_q5[i]));
    }
}

void lm_k_grain_floor(const struct lm_k_curve *curve, const int8_t *grain_q5, int32_t floor_db_q8,
                      const int16_t *level_db_q8, int16_t *restrict noisy_db_q8, uint32_t cells)
{
    const int32_t *base_db_q8 = curve->base_db_q8, *rise_db_q8 = curve->rise_db_q8;
    const int32_t floor = fx_sat_i16(floor_db_q8);
    for (uint32_t i = 0; i < cells; i++) {
        const int16_t sum = fx_sat_i16(fx_db_q8_sum_vec(level_db_q8[i], floor));
        noisy_db_q8[i] = fx_sat_i16(sum + curve_db_q8(base_db_q8, rise_db_q8, grain_q5[i]));
    }
}

void lm_k_grain_stretch(const uint8_t *weight_q7, uint32_t step_q16, const int8_t *column_q5,
                        int8_t *restrict grain_q5, uint32_t cells)
{
    for (uint32_t i = 0; i < cells; i++) {
        const uint32_t at_q16 = i * step_q16;
        const int8_t *const column = column_q5 + (at_q16 >> 16);
        const uint32_t way = at_q16 >> 10 & (LM_K_GRAIN_WAY - 1);
        grain_q5[i] = lm_k_grain_between(column[0], weight_q7[LM_K_GRAIN_WAY - way], column[1],
                                         weight_q7[way]);
    }
}
