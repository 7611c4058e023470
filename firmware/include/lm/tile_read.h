/* What a tile says at the places of a straight or slightly bent track: the innermost loop of a scan
 * line. docs/DESIGN.md, "What stands there". */
#ifndef LM_TILE_READ_H
#define LM_TILE_READ_H

#include <stdint.h>

#include "lm/db.h"
#include "lm/track.h"

enum {
    LM_LANES = 8 /* cells that are worked on together: as many numbers as a wide vector holds */
};

/* The places of cells in a tile are tracks in fractions of its side: 2^32 is the whole, so that
 * none lies outside.
 *
 * Cells (as in the record) and terrain elevations (metres * 16384) of `count` places, and of those
 * behind them up to a whole number of LM_LANES, for which there must be room. Four posts are
 * weighted by 1/256, each way, without rounding. The tile must have passed lm_tile_check. */
void lm_tile_read(const struct lm_tile *restrict tile, const struct lm_track *north,
                  const struct lm_track *east, uint32_t count, uint32_t *restrict cell,
                  int32_t *restrict elevation_q14);

#endif
