#include "lm/kernels_map.h"

#include "lm/lanes.h"

/* Whole groups: a vector of cells has no rest. No store touches the points: it may gather. */
void lm_k_tile_read(const struct lm_tile_point *restrict points,
                    const struct lm_tile_coords *places, uint32_t first, uint32_t groups,
                    uint32_t *restrict cell, int32_t *restrict elevation_m_q14)
{
    const struct lm_tile_coords p = *places;
    for (uint32_t k = first; k < first + groups * LM_LANES; k++) {
        const uint32_t north = lm_quadratic_at(&p.north, k), east = lm_quadratic_at(&p.east, k);
        const struct lm_ground g =
            lm_k_tile_sample(points, cell[k], elevation_m_q14[k], north, east);
        cell[k] = g.cell;
        elevation_m_q14[k] = g.elevation_m_q14;
    }
}
