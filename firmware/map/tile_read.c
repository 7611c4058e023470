#include "lm/tile_read.h"

#include "lm/kernels_map.h"

struct lm_ground lm_tile_ground(const struct lm_tile *tile, uint32_t north, uint32_t east)
{
    return lm_k_tile_sample(lm_tile_origin(tile), 0, lm_tile_base_of(tile, tile).scale, north,
                            east);
}

/* Fill the last group of cells first..end - 1, which is read whole: any tile of the pool will do.
 * Returns how many groups there are. */
static uint32_t fill_groups(uint32_t first, uint32_t end, struct lm_scan_line *line)
{
    uint32_t *const cell = line->cell + end;
    int32_t *const elevation_m_q14 = line->elevation_m_q14 + end;
    for (int lane = 0; lane < LM_LANES; lane++) {
        cell[lane] = 0;
    }
    for (int lane = 0; lane < LM_LANES; lane++) {
        elevation_m_q14[lane] = 0;
    }
    return (end - first + LM_LANES - 1) / LM_LANES;
}

void lm_tile_read(const struct lm_tile *pool, const struct lm_tile_coords *coords, uint32_t first,
                  uint32_t end, struct lm_scan_line *line)
{
    const uint32_t groups = fill_groups(first, end, line);
    lm_k_tile_read(lm_tile_origin(pool), coords, first, groups, line->cell, line->elevation_m_q14);
}

void lm_tile_blend(const struct lm_k_blend *map, const struct lm_tile_coords *coords,
                   uint32_t first, uint32_t end, struct lm_scan_line *line)
{
    const uint32_t groups = fill_groups(first, end, line);
    lm_k_tile_blend(map, coords, first, groups, line->cell, line->elevation_m_q14);
}
