/* Tile reader: cell and elevation at points of resident tiles, the innermost loop of a scan line.
 * Law: docs/EQUATIONS.md, "Ground in a cell". The loop itself is a kernel: lm/kernels_map.h. */
#ifndef LM_TILE_READ_H
#define LM_TILE_READ_H

#include <stdint.h>

#include "lm/db.h"
#include "lm/kernels_map.h"
#include "lm/scan_line.h"

/* Cell and elevation at one point of a tile that has passed lm_tile_check. `north` and `east` are
 * fractions of the tile's side times 2^32, from its south-west corner. */
struct lm_ground lm_tile_ground(const struct lm_tile *tile, uint32_t north, uint32_t east);

/* Read cells first..end - 1 of a line in place: the second of the two passes of a scan line.
 *
 *                           before: the tile of the cell      after
 *     cell[k]               lm_tile_base.record               as in struct lm_tile_point
 *     elevation_m_q14[k]    lm_tile_base.scale                metres * 16384
 *
 * - `pool` is the cache's first tile, to which `record` counts. Tiles have passed lm_tile_check.
 * - The point of cell k in its tile is `coords` at k, each coordinate modulo 2^32.
 * - The LM_LANES entries from `end` on are overwritten and mean nothing afterwards.
 * - No cell is read if first equals end.
 *
 * Cost: that of lm_k_tile_read. */
void lm_tile_read(const struct lm_tile *pool, const struct lm_tile_coords *coords, uint32_t first,
                  uint32_t end, struct lm_scan_line *line);

/* The same for cells that are shorter than the map's. `map` is prepared for the pool. Cost: that of
 * lm_k_tile_blend. */
void lm_tile_blend(const struct lm_k_blend *map, const struct lm_tile_coords *coords,
                   uint32_t first, uint32_t end, struct lm_scan_line *line);

#endif
