#include "fx/log.h"
#include "fx/sat.h"
#include "lm/kernels_radar.h"

void lm_k_gather(const int16_t *restrict level_db_q8, const int32_t *restrict cell_of,
                 int16_t *restrict bin_db_q8, uint32_t cells)
{
    for (uint32_t i = 0; i < cells; i++) {
        bin_db_q8[i] = level_db_q8[cell_of[i]];
    }
}

void lm_k_powers_of_levels(const int16_t *restrict level_db_q8, uint32_t *restrict power_q24,
                           uint32_t cells)
{
    for (uint32_t i = 0; i < cells; i++) {
        power_q24[i] = fx_power_q24_vec(level_db_q8[i]);
    }
}

uint32_t lm_k_sum_powers(const int16_t *level_db_q8, int16_t most_db_q8, uint32_t count)
{
    enum { PART = 64 };
    uint32_t sum_q24 = 0;
    for (uint32_t first = 0; first < count; first += PART) {
        /* Side by side, so that the loop over powers becomes vectors. */
        const uint32_t cells = fx_min_u32(count - first, PART);
        int32_t over_db_q8[PART];
        for (uint32_t i = 0; i < cells; i++, level_db_q8 += LM_K_STRIDE) {
            over_db_q8[i] = fx_min_i32(*level_db_q8 - most_db_q8, 0);
        }
        for (uint32_t i = 0; i < cells; i++) {
            sum_q24 += fx_power_q24_vec(over_db_q8[i]);
        }
    }
    return sum_q24;
}
