#include "../plain.h"
#include "neon.h"

/* There is no gather here: loads side by side take two numbers each where the addresses allow. */
void lm_k_gather(const int16_t *restrict level_db_q8, const int32_t *restrict cell_of,
                 int16_t *restrict bin_db_q8, uint32_t cells)
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

void lm_k_powers_of_levels(const int16_t *restrict level_db_q8, uint32_t *restrict power_q24,
                           uint32_t cells)
{
    const uint32_t whole = cells & ~15u;
    for (size_t i = 0; i < whole; i += 16) {
        const uint32x4x4_t power =
            neon_power_q24(vld1q_s16(level_db_q8 + i), vld1q_s16(level_db_q8 + i + 8));
        for (size_t k = 0; k < 4; k++) {
            vst1q_u32(power_q24 + i + 4 * k, power.val[k]);
        }
    }
    if (whole < cells) {
        lm_k_powers_of_levels_c(level_db_q8 + whole, power_q24 + whole, cells - whole);
    }
}

/* Eight levels, LM_K_STRIDE apart, over the highest that counts. */
static inline int16x8_t neon_over(const int16_t *level_db_q8, int16x8_t most)
{
    _Static_assert(LM_K_STRIDE == 4, "as many vectors");
    return vminq_s16(vqsubq_s16(vld4q_s16(level_db_q8).val[0], most), vdupq_n_s16(0));
}

/* Sixteen levels a turn, of 64 numbers: the LM_K_STRIDE - 1 behind the last level are read, too. */
uint32_t lm_k_sum_powers(const int16_t *level_db_q8, int16_t most_db_q8, uint32_t count)
{
    enum { TURN = 16 * LM_K_STRIDE };
    const int16x8_t most = vdupq_n_s16(most_db_q8);
    uint32x4_t sum_q24 = vdupq_n_u32(0);
    for (; count >= 16; count -= 16, level_db_q8 += TURN) {
        const uint32x4x4_t power =
            neon_power_q24(neon_over(level_db_q8, most), neon_over(level_db_q8 + TURN / 2, most));
        sum_q24 = vaddq_u32(sum_q24, vaddq_u32(vaddq_u32(power.val[0], power.val[1]),
                                               vaddq_u32(power.val[2], power.val[3])));
    }
    const uint32_t rest_q24 = count ? lm_k_sum_powers_c(level_db_q8, most_db_q8, count) : 0;
    return vaddvq_u32(sum_q24) + rest_q24;
}
