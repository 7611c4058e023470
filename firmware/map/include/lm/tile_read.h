/* What tiles say at the places of a line: the innermost loop of a scan line. docs/EQUATIONS.md,
 * "Ground in a cell". */
#ifndef LM_TILE_READ_H
#define LM_TILE_READ_H

#include <stdint.h>

#include "lm/db.h"
#include "lm/scan_line.h"
#include "lm/track.h"

/* Where the cells of a line lie in their tiles, in fractions of a tile's side: 2^32 is the whole,
 * so that none lies outside, and the way from one tile into the next is a sum that overflows. */
struct lm_places {
    struct lm_track north, east;
};

struct lm_ground {
    uint32_t cell; /* as in the record */
    int32_t
        elevation_q14; /* metres * 16384, up to 8 too low; four posts weighted by 1/256 each way */
};

/* What a tile that has passed lm_tile_check says at one place. */
struct lm_ground lm_tile_ground(const struct lm_tile *tile, uint32_t north, uint32_t east);

/* A line is read in two steps. First every run of cells is told which tile of the pool it lies in:
 * line->cell[k] is the record and line->elevation_q14[k] the scale of its lm_tile_base. Then cell
 * and elevation of each of first..end - 1 come to stand there; the LM_LANES behind them lose their
 * meaning. None when first is end. */
void lm_tile_read(const struct lm_tile *restrict pool, const struct lm_places *places,
                  uint32_t first, uint32_t end, struct lm_scan_line *restrict line);

#endif
