/* Tile point: a cell and an elevation post, the part of a tile record that every cell of a line
 * reads. Format: docs/FORMATS.md, 1.6. */
#ifndef LM_TILE_POINT_H
#define LM_TILE_POINT_H

#include <stdint.h>

#include "lm/units.h"

/* Sides of a tile, in cells and in posts.
 *
 *     post 64 p---p---p-   -p       Posts lie at the corners of cells. Post (r, c) is the
 *     cell 63 |   |   |     |       south-west corner of cell (r, c). Posts 64 repeat posts 0 of
 *             :   :   :     :       the neighbours to the north and the east.
 *     post 1  p---p---p-   -p
 *     cell 0  |   |   |     |
 *     post 0  p---p---p-   -p                                                       */
enum { LM_TILE_CELLS = 64, LM_TILE_CELLS_LOG2 = 6, LM_TILE_POSTS = 65 };

/* Reflectivity codes of cells: gamma in dB = code / 2 - 80, which is -80.0..+47.5 dB. */
enum { LM_GAMMA_CODE_STEP_DB_Q8 = 128, LM_GAMMA_CODE_ZERO_DB_Q8 = LM_DB_Q8(-80) };

/* A cell and the elevation post at its south-west corner. They are stored side by side because
 * every reader needs both: one little-endian word, with the cell in its low half. */
struct lm_tile_point {
    uint16_t cell; /* bits 15..8 reflectivity code, 7..4 class, 3..0 structure height code */
    uint16_t post; /* elevation above the tile's base, in steps of 2^post_shift / 64 metres */
};

#endif
