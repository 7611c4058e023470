#include <stdbool.h>

#include "fx/log.h"
#include "fx/sat.h"
#include "lm/kernels_radar.h"

void lm_k_levels_add(int32_t *restrict sum_db_q8, const int32_t *restrict level_db_q8,
                     uint32_t cells)
{
    for (uint32_t i = 0; i < cells; i++) {
        sum_db_q8[i] = fx_db_q8_sum_vec(sum_db_q8[i], level_db_q8[i]);
    }
}

void lm_k_levels_mean(const int32_t *restrict sum_db_q8, int32_t less_db_q8, int32_t least_db_q8,
                      int32_t *restrict level_db_q8, uint32_t cells)
{
    for (uint32_t i = 0; i < cells; i++) {
        const int32_t all_db_q8 = fx_db_q8_sum_vec(sum_db_q8[i], level_db_q8[i]);
        level_db_q8[i] = fx_max_i32(all_db_q8 - less_db_q8, least_db_q8);
    }
}

void lm_k_highest(const int32_t *level_db_q8, int32_t *restrict highest_db_q8, uint32_t cells)
{
    const uint32_t blocks = (cells + LM_K_HIGHEST_CELLS - 1) / LM_K_HIGHEST_CELLS;
    for (uint32_t n = 0; n < blocks; n++, level_db_q8 += LM_K_HIGHEST_CELLS) {
        int32_t highest = level_db_q8[0];
        for (uint32_t i = 1; i < LM_K_HIGHEST_CELLS; i++) {
            highest = fx_max_i32(highest, level_db_q8[i]);
        }
        highest_db_q8[n] = highest;
    }
}

static inline int32_t held(int32_t x)
{
    return fx_clamp_i32(x, INT16_MIN, INT16_MAX);
}

uint32_t lm_k_stand_out(const int32_t *level_db_q8, int32_t least_db_q8, int32_t above_db_q8)
{
    uint32_t mask = 0;
    for (uint32_t k = 0; k < LM_K_HIGHEST_CELLS; k++) {
        const int32_t *const cell = level_db_q8 + k;
        const int32_t most_db_q8 = held(held(*cell) - held(above_db_q8));
        const bool does = held(*cell) >= held(least_db_q8) &&
                          held(cell[-LM_K_BESIDE]) <= most_db_q8 &&
                          held(cell[LM_K_BESIDE]) <= most_db_q8;
        mask |= (uint32_t)does << k;
    }
    return mask;
}

void lm_k_side_lobes(const int16_t *restrict side_db_q8, int32_t point_db_q8,
                     int32_t *restrict level_db_q8)
{
    for (uint32_t i = 0; i < LM_K_LOBES; i++) {
        const int32_t lobe_db_q8 = point_db_q8 + side_db_q8[i], level = level_db_q8[i];
        const int32_t sum_db_q8 = fx_db_q8_sum_vec(level, lobe_db_q8);
        level_db_q8[i] = lobe_db_q8 > level - LM_K_LOBES_BELOW_DB_Q8 ? sum_db_q8 : level;
    }
}
