#include "lm/kernels_map.h"

void lm_k_replace(uint32_t classes, uint32_t by, uint32_t *cell, uint32_t cells)
{
    for (uint32_t i = 0; i < cells; i++) {
        cell[i] = (classes >> (cell[i] >> 4 & 15) & 1) != 0 ? by : cell[i];
    }
}
