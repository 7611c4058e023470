/* Draws of a line's cells, block by block: lm/kernels_clutter.h. */
#ifndef DRAWS_H
#define DRAWS_H

#include <stddef.h>
#include <stdint.h>

#include "lm/lanes.h"

/* Those of whole blocks. */
static inline void draw(const int16_t *row_db_q8, const uint32_t *entry,
                        int32_t *restrict draw_db_q8, uint32_t cells)
{
    const uint32_t *const end = entry + (cells + LM_LANES - 1) / LM_LANES;
    for (; entry != end; entry++, draw_db_q8 += LM_LANES) {
        for (int k = 0; k < LM_LANES; k++) {
            draw_db_q8[k] = row_db_q8[*entry + (size_t)k];
        }
    }
}

#endif
