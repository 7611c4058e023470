/* What tiles say at the places of a line: the innermost loop of a scan line. docs/EQUATIONS.md,
 * "Ground in a cell". */
#ifndef LM_TILE_READ_H
#define LM_TILE_READ_H

#include <stdint.h>

#include "lm/db.h"
#include "lm/kernels_map.h"
#include "lm/scan_line.h"

/* What a tile that has passed lm_tile_check says at one place. */
struct lm_ground lm_tile_ground(const struct lm_tile *tile, uint32_t north, uint32_t east);

/* A line is read in two steps. First every run of cells is told which tile of the pool it lies in:
 * line->cell[k] is the record and line->elevation_q14[k] the scale of its lm_tile_base. Then cell
 * and elevation of each of first..end - 1 come to stand there; the LM_LANES behind them lose their
 * meaning. None when first is end. */
void lm_tile_read(const struct lm_tile *pool, const struct lm_tile_coords *coords, uint32_t first,
                  uint32_t end, struct lm_scan_line *line);

#endif
