#include "lm/speckle.h"

void lm_speckle_run(const struct lm_speckle_config *config, const int32_t *noise,
                    int32_t *restrict level_q8, uint32_t cells)
{
    const int32_t *speckle_q8 = lm_speckle_q8[config->looks_log2];
    for (uint32_t i = 0; i < cells; i++) {
        const int32_t level =
            level_q8[i] > config->noise_floor_q8 ? level_q8[i] : config->noise_floor_q8;
        level_q8[i] = level + speckle_q8[noise[i]];
    }
}
