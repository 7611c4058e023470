/* What a tile says at the places of a straight or slightly bent track: the innermost loop of a scan
 * line. docs/DESIGN.md, "What stands there". */
#ifndef LM_TILE_READ_H
#define LM_TILE_READ_H

#include <stdint.h>

#include "lm/db.h"

enum {
    LM_LANES = 8 /* cells that are worked on together: as many numbers as a wide vector holds */
};

/* One coordinate of cell k in its tile, `at + k (step + k half_bend)`, as a fraction of the tile's
 * side: 2^32 is the whole, so that no value lies outside. */
struct lm_tile_track {
    uint32_t at, step, half_bend;
};

/* Cells (as in the record) and terrain elevations (metres * 16384) of `count` places, and of those
 * behind them up to a whole number of LM_LANES, for which there must be room. Four posts are
 * weighted by 1/256, each way, without rounding. The tile must have passed lm_tile_check. */
void lm_tile_read(const struct lm_tile *tile, const struct lm_tile_track *north,
                  const struct lm_tile_track *east, uint32_t count, uint32_t *cell,
                  int32_t *elevation_q14);

#endif
