#include "fx/sat.h"
#include "lm/kernels_clutter.h"

void lm_k_water_gain(uint32_t water, int32_t even_db_q8, const int32_t *cell_db_q8,
                     const uint32_t *cell, int16_t *restrict level_db_q8, uint32_t cells)
{
    for (uint32_t i = 0; i < cells; i++) {
        const uint32_t is_water = water >> (cell[i] >> 4 & (LM_K_CODES - 1)) & 1;
        const int32_t gain_db_q8 = fx_sat_i16(even_db_q8 + cell_db_q8[i]);
        level_db_q8[i] = fx_sat_i16(level_db_q8[i] + (gain_db_q8 & -(int32_t)is_water));
    }
}
