#include <stdbool.h>

#include "fx/log.h"
#include "fx/sat.h"
#include "lm/kernels_radar.h"

void lm_k_levels_add(int16_t *restrict sum_db_q8, const int16_t *restrict level_db_q8,
                     uint32_t cells)
{
    for (uint32_t i = 0; i < cells; i++) {
        sum_db_q8[i] = fx_sat_i16(fx_db_q8_sum_vec(sum_db_q8[i], level_db_q8[i]));
    }
}

void lm_k_levels_mean(const int16_t *restrict sum_db_q8, int16_t less_db_q8,
                      int16_t *restrict level_db_q8, uint32_t cells)
{
    for (uint32_t i = 0; i < cells; i++) {
        const int32_t all_db_q8 = fx_sat_i16(fx_db_q8_sum_vec(sum_db_q8[i], level_db_q8[i]));
        level_db_q8[i] = fx_sat_i16(all_db_q8 - less_db_q8);
    }
}

void lm_k_highest(const int16_t *level_db_q8, int16_t *restrict highest_db_q8, uint32_t cells)
{
    const uint32_t blocks = (cells + LM_K_HIGHEST_CELLS - 1) / LM_K_HIGHEST_CELLS;
    for (uint32_t n = 0; n < blocks; n++, level_db_q8 += LM_K_HIGHEST_CELLS) {
        int16_t highest = level_db_q8[0];
        for (uint32_t i = 1; i < LM_K_HIGHEST_CELLS; i++) {
            highest = level_db_q8[i] > highest ? level_db_q8[i] : highest;
        }
        highest_db_q8[n] = highest;
    }
}

/* The highest of the cells LM_K_BESIDE before and behind a cell, and of those between. */
static inline int16_t highest_around(const int16_t *cell_db_q8)
{
    int16_t highest = cell_db_q8[-LM_K_BESIDE];
    for (int32_t n = 1 - LM_K_BESIDE; n <= LM_K_BESIDE; n++) {
        highest = cell_db_q8[n] > highest ? cell_db_q8[n] : highest;
    }
    return highest;
}

uint32_t lm_k_stand_out(const int16_t *level_db_q8, int16_t least_db_q8, int16_t above_db_q8)
{
    uint32_t mask = 0;
    for (uint32_t k = 0; k < LM_K_HIGHEST_CELLS; k++) {
        const int16_t *const cell_db_q8 = level_db_q8 + k;
        const int32_t most_db_q8 = fx_sat_i16(*cell_db_q8 - above_db_q8);
        const bool does = *cell_db_q8 >= least_db_q8 && *cell_db_q8 == highest_around(cell_db_q8) &&
                          cell_db_q8[-LM_K_BESIDE] <= most_db_q8 &&
                          cell_db_q8[LM_K_BESIDE] <= most_db_q8;
        mask |= (uint32_t)does << k;
    }
    return mask;
}

/* A level with a side lobe of a point added, if that counts. */
static inline int16_t with_lobe(int16_t level_db_q8, int16_t point_db_q8, int16_t side_db_q8)
{
    const int16_t lobe = fx_sat_i16(point_db_q8 + side_db_q8);
    const int16_t sum = fx_sat_i16(fx_db_q8_sum_vec(level_db_q8, lobe));
    return lobe > fx_sat_i16(level_db_q8 - LM_K_LOBES_BELOW_DB_Q8) ? sum : level_db_q8;
}

void lm_k_side_lobes(const int16_t *along_db_q8, const int16_t *across_db_q8, int16_t point_db_q8,
                     int16_t *const *around, uint32_t cell)
{
    int16_t *const point = around[LM_K_LOBES_REACH] + cell;
    for (int32_t n = -LM_K_LOBES_REACH; n <= LM_K_LOBES_REACH; n++) {
        if (n != 0) {
            int16_t *const at = around[n + LM_K_LOBES_REACH] + cell;
            *at = with_lobe(*at, point_db_q8, across_db_q8[n]);
        }
        if (n != 0 && along_db_q8) {
            point[n] = with_lobe(point[n], point_db_q8, along_db_q8[n]);
        }
    }
}
