#include "draws.h"
#include "lm/kernels_clutter.h"

void lm_k_class_gain(const int32_t *gain_db_q8, const uint32_t *cell, int32_t *restrict level_db_q8,
                     uint32_t cells)
{
    for (uint32_t i = 0; i < cells; i++) {
        /* Signed: becomes a gather. */
        level_db_q8[i] += gain_db_q8[(int32_t)cell[i] >> 4 & (LM_K_CODES - 1)];
    }
}
