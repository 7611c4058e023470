/* Tile point: a cell and an elevation post, the part of a tile record that every cell of a line
 * reads. Format: docs/FORMATS.md, 1.6. */
#ifndef LM_TILE_POINT_H
#define LM_TILE_POINT_H

#include <stdint.h>

#include "fx/sat.h"
#include "lm/units.h"

/* Sides of a tile, in cells, in posts and in points of its record.
 *
 *     row 65   .   p---p---p-   -p       A point is a cell and the post at its south-west corner.
 *     row 64   .   |   |   |     |       Rows and columns 1..64 are the tile's own. Row 0 and
 *              :   :   :   :     :       column 0 repeat the neighbours to the south and the west,
 *     row 1    .   p---p---p-   -p       row 65 and column 65 those to the north and the east.
 *     row 0    .   .   .   .     .
 *     column   0   1   2   3     65
 *
 * Posts at the corners of the tile's own cells are those of rows and columns 1..65. What blends the
 * four cells around a place, whose middles lie half a cell in, never leaves the record. */
enum {
    LM_TILE_CELLS = 64,
    LM_TILE_CELLS_LOG2 = 6,
    LM_TILE_POSTS = 65,
    LM_TILE_POINTS = 66,
    LM_TILE_BORDER = 1 /* row and column of the tile's own south-west point */
};

/* Reflectivity codes of cells: gamma in dB = code / 2 - 80, which is -80.0..+47.5 dB. */
enum {
    LM_GAMMA_CODE_STEP_LOG2 = 7,
    LM_GAMMA_CODE_STEP_DB_Q8 = 1 << LM_GAMMA_CODE_STEP_LOG2,
    LM_GAMMA_CODE_ZERO_DB_Q8 = LM_DB_Q8(-80)
};

/* Codes that decibels come to, to the nearest. */
static inline int32_t lm_gamma_codes_of(int32_t db_q8)
{
    return (db_q8 + LM_GAMMA_CODE_STEP_DB_Q8 / 2) >> LM_GAMMA_CODE_STEP_LOG2;
}

/* The cell of a record with `codes` more reflectivity, which ends at those of codes 0 and 255. What
 * stands above the record's 16 bits is left away. */
static inline uint16_t lm_cell_brightened(uint32_t cell, int32_t codes)
{
    const int32_t code = fx_clamp_i32((int32_t)(cell >> 8 & 255) + codes, 0, 255);
    return (uint16_t)((uint32_t)code << 8 | (cell & 255));
}

/* A cell and the elevation post at its south-west corner. They are stored side by side because
 * every reader needs both: one little-endian word, with the cell in its low half. */
struct lm_tile_point {
    uint16_t cell; /* bits 15..8 reflectivity code, 7..4 class, 3..0 structure height code */
    uint16_t post; /* elevation above the tile's base, in steps of 2^post_shift / 64 metres */
};

#endif
