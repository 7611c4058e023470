/* Kernel of the map: cells and elevations that tiles of the cache have at the places of a line.
 *
 * Kernels are the loops over a line's cells that some machines have vectors for. Each takes a whole
 * line and returns a whole line. firmware/kernels/c/ has them for every machine; another folder
 * beside it has the same functions for one architecture (arm64), equal to the bit. The board's
 * make file chooses: `KERNELS := arm64`. What holds for all of them:
 *
 * - Every pointer is borrowed for the call, and arrays that are not said to be the same are apart.
 * - Arrays need the alignment of their type, no more.
 * - A kernel reads and writes whole groups of cells. An array of a line has LM_CELLS_ROOM entries
 *   (lm/lanes.h), and no kernel touches one behind the last group that holds a cell. A group has
 *   16 cells unless the function says otherwise. What a kernel leaves in a group behind the last
 *   cell means nothing; what it finds there may be anything.
 * - No kernel fails, waits, or keeps anything between two calls.
 * - Costs are instructions a cell in the loops that gcc 12 makes of arm64/ for the Cortex-A53. */
#ifndef LM_KERNELS_MAP_H
#define LM_KERNELS_MAP_H

#include <stdbool.h>
#include <stdint.h>

#include "fx/lerp.h"
#include "fx/mem.h"
#include "lm/quadratic.h"
#include "lm/tile_point.h"

/* Coordinates of a line's cells in their tiles, as fractions of a tile's side times 2^32: no place
 * lies outside a tile, and the way from one tile into the next is a sum that overflows.
 *
 *     2^32 +---------------+      bits 31..26  row or column of the cell, 0..63
 *          |               |      bits 25..18  place in the cell, 0..255 / 256
 *    north |         x     |      bits 17..0   left out
 *          |               |
 *        0 +---------------+
 *          0     east    2^32 */
struct lm_tile_coords {
    struct lm_quadratic north, east;
};

/* Ground at one position of a tile. */
struct lm_ground {
    uint32_t cell; /* as in the record */
    int32_t
        elevation_m_q14; /* terrain, metres * 16384; up to 8 too low: weights are 1/256 each way */
};

/* Number of a record's own point: vectors gather by the numbers of words, and fetch by bytes. */
static inline int32_t lm_k_point_of(uint32_t record)
{
    return (int32_t)(record / (uint32_t)sizeof(struct lm_tile_point));
}

/* One cell of lm_k_tile_read, for those who look at a single place.
 *
 * `points`: the first tile's own south-west point in a pool (lm_tile_origin). `record`: from there
 * to that of the tile in question, in bytes below 2^27. `scale`: elevation of the tile's base in
 * Q14, a multiple of 256, less the number of bits (4..8) by which a post in Q16 is shifted down to
 * metres in Q14.
 *
 * The four posts around the place are blended (fx/lerp.h). The post's part and the base are below
 * 2^29. Indices are signed, because then a loop of this becomes vector gathers. */
static inline struct lm_ground lm_k_tile_sample(const struct lm_tile_point *points, uint32_t record,
                                                int32_t scale, uint32_t north, uint32_t east)
{
    const int32_t row = (int32_t)(north >> 26), column = (int32_t)(east >> 26);
    const int32_t at = lm_k_point_of(record) + row * LM_TILE_POINTS + column;
    const uint32_t south_west = fx_load_u32(points + at), south_east = fx_load_u32(points + at + 1);
    const uint32_t north_west = fx_load_u32(points + at + LM_TILE_POINTS);
    const uint32_t north_east = fx_load_u32(points + at + LM_TILE_POINTS + 1);
    const uint32_t post_q16 = fx_bilerp_u16_q16(
        (uint16_t)(south_west >> 16), (uint16_t)(south_east >> 16), (uint16_t)(north_west >> 16),
        (uint16_t)(north_east >> 16), east << 6 >> 24, north << 6 >> 24);
    const uint32_t shift = (0u - (uint32_t)scale) & 0xFF;
    return (struct lm_ground){.cell = south_west & 0xFFFF,
                              .elevation_m_q14 = scale + (int32_t)(post_q16 >> shift)};
}

/* Read the tiles at cells first..first + 8 * groups - 1 of a line, in place.
 *
 * Before: cell[k] is the `record` and elevation_m_q14[k] the `scale` of lm_k_tile_sample for the
 * tile that cell k lies in, also for the cells that fill the last group of 8. After: the cell as in
 * the record, and the elevation of the terrain in metres * 16384.
 *
 * `points` as there, of tiles that have passed lm_tile_check. Cost: 10 a cell. */
void lm_k_tile_read(const struct lm_tile_point *points, const struct lm_tile_coords *places,
                    uint32_t first, uint32_t groups, uint32_t *cell, int32_t *elevation_m_q14);

/* Side of the pattern of what has grown, in texels, and its table: the first row and column stand
 * behind the last once more. */
enum {
    LM_K_GROWN_SIDE = 64,
    LM_K_GROWN_STRIDE = LM_K_GROWN_SIDE + 1,
    LM_K_GROWN_WORDS = LM_K_GROWN_STRIDE * LM_K_GROWN_STRIDE
};

/* A border between two natural classes leans by n = 230/256 of a bend; half of that in 128ths. */
enum { LM_K_LEAN_OF_BEND_Q7 = 115 };

/* The map as lm_k_tile_blend reads it. Bit k of a mask is for class k. Borders between two natural
 * classes are bent by the pattern of what has grown, and heights of crowned classes follow it.
 * Those of flat ones are not blended: then their elevation is the terrain's. */
struct lm_k_blend {
    const struct lm_tile_point *points; /* as in lm_k_tile_sample */
    /* A texel is a word: bits 7..0 how far borders are bent, -128..127; 15..8 how much higher than
     * the map's crowns are, (n - 128) / 256. Row by row from the south-west. */
    const uint16_t *grown;
    const uint16_t *height_dm_of_code; /* LM_K_CODES entries; differences up to 3.2 km */
    uint32_t grown_shift;              /* from a place in its tile to texels; 4..26 */
    bool is_stepped; /* the nearest texel counts alone, not the four around a place */
    uint32_t natural, crowned, flat;
};

/* Read the tiles like lm_k_tile_read, for cells that are shorter than the map's: blend the four
 * cells whose middles are around each place. Law: docs/EQUATIONS.md, "Finer than the map".
 *
 * - cell[k]: of the cells of the class that wins, the one that has most weight, as in the record.
 *   In the upper half is what its reflectivity lacks to that of the blend: 1/256 dB, signed, in
 *   steps of 1/64 dB. Reflectivities of one class must be within 63.5 dB.
 * - elevation_m_q14[k]: of the terrain, and what the cell's height lacks to that of the blend.
 *
 * Points beside the own ones of a tile are read, too. Cost: 26 a cell where all that is around is
 * of one class, up to 48 elsewhere, and 7 more if it is not stepped. */
void lm_k_tile_blend(const struct lm_k_blend *map, const struct lm_tile_coords *places,
                     uint32_t first, uint32_t groups, uint32_t *cell, int32_t *elevation_m_q14);

/* Replace the cells of the classes that are bits of `classes` by `by`. Writes no entry behind the
 * last cell. Cost: 2 a cell. */
void lm_k_replace(uint32_t classes, uint32_t by, uint32_t *cell, uint32_t cells);

/* A row of a stored tile (docs/FORMATS.md, 1.6): reflectivity, class and height of its cells, and
 * what is left of its posts, low and high bytes. */
struct lm_k_strips {
    uint8_t gamma[LM_TILE_POINTS], class_height[LM_TILE_POINTS], left_low[LM_TILE_POINTS],
        left_high[LM_TILE_POINTS];
};

/* Make the points of a row of its strips. What is left of a post is its rise above the post south
 * of it, less the rise of the post west of it; all numbers are modulo 2^16, and the first column
 * rises from 0. Signs stand in bit 0: 0, -1, 1, -2 ... are stored as 0, 1, 2, 3 ... `points` and
 * `south` have LM_TILE_POINTS; writes no more. Cost: 4 a point. */
void lm_k_tile_row(struct lm_tile_point *points, const struct lm_tile_point *south,
                   const struct lm_k_strips *strips);

#endif
