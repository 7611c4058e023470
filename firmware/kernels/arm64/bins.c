#include "../plain.h"
#include "neon.h"

/* There is no gather here: loads side by side take two numbers each where the addresses allow. */
void lm_k_gather(const int32_t *restrict level_db_q8, const int32_t *restrict cell_of,
                 int32_t *restrict bin_db_q8, uint32_t cells)
{
    const uint32_t whole = cells & ~7u;
    for (size_t i = 0; i < whole; i += 8) {
        for (size_t k = i; k < i + 8; k++) {
            bin_db_q8[k] = level_db_q8[cell_of[k]];
        }
    }
    if (whole < cells) {
        lm_k_gather_c(level_db_q8, cell_of + whole, bin_db_q8 + whole, cells - whole);
    }
}

void lm_k_powers_of_levels(uint32_t *line, uint32_t cells)
{
    const uint32_t whole = cells & ~15u;
    for (size_t i = 0; i < whole; i += 16) {
        const int32_t *level_db_q8 = (const int32_t *)line + i;
        const int32x4x4_t level = {{vld1q_s32(level_db_q8), vld1q_s32(level_db_q8 + 4),
                                    vld1q_s32(level_db_q8 + 8), vld1q_s32(level_db_q8 + 12)}};
        const uint32x4x4_t power = neon_power_q24(level);
        for (size_t k = 0; k < 4; k++) {
            vst1q_u32(line + i + 4 * k, power.val[k]);
        }
    }
    if (whole < cells) {
        lm_k_powers_of_levels_c(line + whole, cells - whole);
    }
}
