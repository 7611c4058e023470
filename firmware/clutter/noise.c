#include "lm/noise.h"

void lm_noise_line_set(struct lm_noise_line *n, const struct lm_noise_key *key, uint32_t cells)
{
    const uint32_t blocks = (cells + 4 * LM_NOISE_BLOCK - 1) / (4 * LM_NOISE_BLOCK) * 4;
    const uint32_t epoch = key->epoch;
    const uint64_t column_step_q32 = key->column_step_q32;
    uint64_t column_q32 = key->column_q32;
    for (uint32_t b = 0; b < blocks; b++) {
        n->entry[b] = lm_noise_entry_in(column_q32, b, epoch);
        column_q32 += column_step_q32;
    }
}
