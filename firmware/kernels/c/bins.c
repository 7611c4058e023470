#include "fx/log.h"
#include "lm/kernels_radar.h"

void lm_k_gather(const int32_t *restrict level_db_q8, const int32_t *restrict cell_of,
                 int32_t *restrict bin_db_q8, uint32_t cells)
{
    for (uint32_t i = 0; i < cells; i++) {
        bin_db_q8[i] = level_db_q8[cell_of[i]];
    }
}

void lm_k_powers_of_levels(uint32_t *line, uint32_t cells)
{
    for (uint32_t i = 0; i < cells; i++) {
        line[i] = fx_power_q24_vec((int32_t)line[i]);
    }
}
