/* Points of a tile: the part of a tile record that is read for every cell of a line.
 * docs/FORMATS.md, 1.6. */
#ifndef LM_TILE_POINT_H
#define LM_TILE_POINT_H

#include <stdint.h>

enum {
    LM_TILE_CELLS = 64, /* along one side */
    LM_TILE_CELLS_LOG2 = 6,
    LM_TILE_POSTS = 65 /* elevation posts at the cells' corners, shared with the neighbours */
};

/* Reflectivity codes: gamma in dB = code / 2 - 80, so -80.0 .. +47.5 dB. */
enum { LM_GAMMA_CODE_STEP_DB_Q8 = 128, LM_GAMMA_CODE_ZERO_DB_Q8 = -80 * 256 };

/* A cell and the elevation post at its south-west corner: side by side, because whoever looks at
 * one needs the other. A loop loads both as one little-endian word, cell in the low half. */
struct lm_tile_point {
    uint16_t cell; /* bits 15..8 reflectivity code, 7..4 class, 3..0 structure height code */
    uint16_t post; /* elevation above the tile's base, in steps of 2^post_shift / 64 m */
};

#endif
