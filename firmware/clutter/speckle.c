#include "lm/speckle.h"

#include "lm/kernels_clutter.h"

_Static_assert((int)LM_NOISE_LOOKS_LOG2_MAX == (int)LM_LOOKS_LOG2_MAX,
               "looks of the noise table and of the radar table");

_Static_assert((int)LM_NOISE_BLOCK == LM_LANES, "lm/noise.h has what lm/kernels_clutter.h wants");

void lm_speckle_run(const struct lm_speckle_config *config, const struct lm_noise_key *noise_key,
                    int32_t *level_db_q8, uint32_t cells)
{
    struct lm_noise_line noise;
    lm_noise_line_set(&noise, noise_key, cells);
    lm_k_noise_add(lm_noise_db_q8[config->looks_log2], noise.entry, level_db_q8, cells);
}
