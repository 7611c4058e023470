/* Grown: a pattern on the ground of what nature has made uneven: bends of borders, and crowns of
 * trees. It repeats itself every LM_K_GROWN_SIDE texels, and belongs to the ground: a place has the
 * same texel in every picture.
 *
 * A texel is 2^LM_GROWN_TEXEL_LOG2 BAM of latitude high, and as many of longitude wide times those
 * of a cell's zone: 1.2 m. The build makes the table (host-sim/tables); its law is in
 * docs/EQUATIONS.md, "Finer than the map". */
#ifndef LM_GROWN_H
#define LM_GROWN_H

#include <stdint.h>

#include "lm/kernels_map.h"

enum { LM_GROWN_TEXEL_LOG2 = 7 };

/* `grown_shift` of four texels a cell, where they are not those of crowns. */
enum { LM_GROWN_CELL_SHIFT = 32 - LM_TILE_CELLS_LOG2 - 2 };

/* Texels as in struct lm_k_blend. */
extern const uint16_t lm_grown[LM_K_GROWN_WORDS];

#endif
