#include "fx/sat.h"
#include "lm/kernels_radar.h"

/* Powers that saturate stay below 2^32. */
void lm_k_fade(const struct lm_k_fade *f, uint32_t *restrict power_q24, uint32_t cells)
{
    const uint32_t most_q24 = UINT32_MAX - f->floor_q24;
    for (uint32_t i = 0; i < cells; i++) {
        const uint32_t filled_q24 =
            i < f->first ? power_q24[i] : fx_min_u32(power_q24[i], most_q24) + f->floor_q24;
        const uint64_t product = (uint64_t)filled_q24 * f->speckle_q24[i] >> 24;
        power_q24[i] = product < UINT32_MAX ? (uint32_t)product : UINT32_MAX;
    }
}
