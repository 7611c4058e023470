#include "lm/tile_read.h"

#include "lm/kernels_map.h"

struct lm_ground lm_tile_ground(const struct lm_tile *tile, uint32_t north, uint32_t east)
{
    return lm_k_tile_sample(lm_tile_origin(tile), 0, lm_tile_base_of(tile, tile).scale, north,
                            east);
}

void lm_tile_read(const struct lm_tile *pool, const struct lm_tile_coords *coords, uint32_t first,
                  uint32_t end, struct lm_scan_line *line)
{
    const uint32_t groups = (end - first + LM_LANES - 1) / LM_LANES;
    uint32_t *const cell_behind = line->cell + end;
    int32_t *const elevation_behind = line->elevation_m_q14 + end;
    for (int lane = 0; lane < LM_LANES; lane++) {
        cell_behind[lane] = 0; /* the last group reads these too: any tile of the pool will do */
        elevation_behind[lane] = 0;
    }
    lm_k_tile_read(lm_tile_origin(pool), coords, first, groups, line->cell, line->elevation_m_q14);
}
