/* The points of a row by plain C, from any of them on: the kernel lm_k_tile_row of c/, and the end
 * of a row in other folders. */
#ifndef TILE_ROW_H
#define TILE_ROW_H

#include "lm/kernels_map.h"

/* `rise` is that of the point before the first. */
static inline void put_points(struct lm_tile_point *points, const struct lm_tile_point *south,
                              const struct lm_k_strips *strips, uint32_t first, uint32_t rise)
{
    /* Apart from the sums, loops of vectors. */
    uint16_t cell[LM_TILE_POINTS], left[LM_TILE_POINTS];
    for (uint32_t i = first; i < LM_TILE_POINTS; i++) {
        const uint32_t folded = (uint32_t)strips->left_high[i] << 8 | strips->left_low[i];
        left[i] = (uint16_t)((folded >> 1) ^ (0 - (folded & 1)));
        cell[i] = (uint16_t)(strips->gamma[i] << 8 | strips->class_height[i]);
    }
    for (uint32_t i = first; i < LM_TILE_POINTS; i++) {
        rise += left[i];
        points[i] = (struct lm_tile_point){cell[i], (uint16_t)(south[i].post + rise)};
    }
}

#endif
