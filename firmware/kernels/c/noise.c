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

void lm_k_noise_add(const int16_t *row_db_q8, const uint32_t *entry, int32_t *restrict level_db_q8,
                    uint32_t cells)
{
    int32_t draw_db_q8[LM_CELLS_ROOM];
    draw(row_db_q8, entry, draw_db_q8, cells);
    for (uint32_t i = 0; i < cells; i++) {
        level_db_q8[i] += draw_db_q8[i];
    }
}
