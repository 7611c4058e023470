/* Kernels of the clutter: light and shadow along a line, class gain, layover, speckle and noise
 * floor. What holds for every kernel (arrays, groups of 16 cells, ownership, costs) is in
 * lm/kernels_map.h. */
#ifndef LM_KERNELS_CLUTTER_H
#define LM_KERNELS_CLUTTER_H

#include <stdint.h>

#include "fx/sat.h"
#include "lm/lanes.h"

/* Light and shadow. Equations: docs/EQUATIONS.md, "Illumination". */

/* Marks of a class: at most one is set. */
enum { LM_K_WATER = 1, LM_K_STRUCTURE = 2, LM_K_TREES = 4, LM_K_MARK_BITS = 3 };

enum { LM_K_CODES = 16 }; /* height codes of a map, and classes */

/* The tops of a line's cells, and where they are seen from. */
struct lm_k_tops {
    uint32_t first; /* cells before this one are too near to be shown */
    uint32_t cells; /* of the line; 1..LM_CELLS_MAX */
    /* Lower half: as in a tile record (struct lm_tile_point). Upper half: what to add to the
     * reflectivity, 1/256 dB, signed; both together -80..47.5 dB. */
    const uint32_t *cell;
    const int32_t *elevation_m_q14;    /* of the terrain; magnitude below 2^29 */
    const int32_t *fall_m_q14;         /* antenna's height and the Earth's drop; below 2^30 */
    const int32_t *inverse_range;      /* 1 / range in the tangents' format and Q17 more; 0..2^31 */
    const uint16_t *height_dm_of_code; /* LM_K_CODES entries */
};

enum { LM_K_Q19_OF_DM = 52429 }; /* 2^19 / 10; times 65535 it takes 32 bits */

/* Height of a structure, metres * 16384; up to 0.4 mm more for 100 m; below 2^27. */
static inline int32_t lm_k_height_m_q14(uint16_t height_dm)
{
    return (int32_t)(height_dm * (uint32_t)LM_K_Q19_OF_DM >> 5);
}

/* Tangent of the elevation angle under which the top of cell i appears, given its structure's
 * height. The top is below 2^31 above the antenna, times 2^31. Sums have no sign, because what
 * stands behind the last cell may be anything; nor has the shift, whose 32 bits do not see it. */
static inline int32_t lm_k_tangent(const struct lm_k_tops *tops, uint32_t i, int32_t height_m_q14)
{
    const uint32_t top_m_q14 = (uint32_t)tops->elevation_m_q14[i] + (uint32_t)height_m_q14;
    const int32_t apparent_m_q14 = (int32_t)(top_m_q14 - (uint32_t)tops->fall_m_q14[i]);
    return (int32_t)((uint64_t)((int64_t)apparent_m_q14 * tops->inverse_range[i]) >> 31);
}

/* The highest tangent of cells first..cells - 1, of which there is one at least. Reads no other
 * cell. Cost: 3 a cell. */
int32_t lm_k_highest_tangent(const struct lm_k_tops *tops);

/* A line to be lit, and where the results go. */
struct lm_k_lit_line {
    struct lm_k_tops tops;
    /* Level of reflectivity code 0 where the horizon rises by 1, over LM_LEVEL_SHADOW. */
    const int16_t *gain_db_q8;
    const int16_t *class_gain_db_q8; /* LM_K_CODES entries */
    const uint8_t *mark_of_class;    /* LM_K_CODES entries */
    uint8_t edge_structure_db_q3;    /* leading edge of a structure, dB * 8 */
    uint8_t edge_trees_db_q3;        /* and of trees */
    int32_t shore_db_q8;             /* brightness of the first cell behind water */
    int32_t shore_fall_db_q8;        /* by how much each further one is darker; 0 or more */
    int32_t start;                   /* horizon before cell `first`; within 2^31 of any tangent */
    int32_t *horizon;                /* result */
    int16_t *level_db_q8;            /* result */
    int32_t *work;                   /* scratch of LM_K_LIGHT_WORK entries; too large for a stack */
};

enum {
    LM_K_SHORE_STRETCH = 32, /* cells that are searched for shores at once */
    LM_K_LIGHT_WORK = 4 * (LM_LANES + LM_CELLS_ROOM) + LM_K_SHORE_STRETCH + LM_CELLS_ROOM
};

/* Work out horizon and level of every cell of a line.
 *
 *     tangent                          horizon[i + 1], the largest tangent so far
 *        |            ________________________________
 *        |     ______/ #                   .
 *        | ___/ #    # #     .  .     .  . .     .       #  lit: the horizon rises
 *        |_#__#_.__.__#_#_____________________________     .  dark: LM_LEVEL_SHADOW
 *          first                               cells
 *
 * - horizon[0..first] is `start`; horizon[i + 1] is what cell i leaves, for i < cells.
 * - A cell that does not raise the horizon, or lies before `first`, has LM_LEVEL_SHADOW.
 * - The level of a lit cell is its reflectivity, the gains of its place and its class, 10 log10 of
 *   the horizon's rise, and the edge of its class where the cell before it has another mark. It is
 *   held within 16 bits, and so are the two gains together.
 * - From the first cell behind water on, lit cells are brighter by what is left of the shore, to
 *   the next water or where nothing is left.
 *
 * Arrays of tops and gain are read from cell 0 on; `horizon` has room for LM_CELLS_ROOM entries and
 * is written from entry 0 on. `first` may be `cells`. Cost: 9 a cell. */
void lm_k_light(const struct lm_k_lit_line *line);

/* Add to the levels of water, whose classes are the bits of `water`, even_db_q8 and the cell's own
 * gain; both together and the level are held within 16 bits. `cell` as in a tile record; gains
 * within 2^30 of 0. Cost: 3 a cell. */
void lm_k_water_gain(uint32_t water, int32_t even_db_q8, const int32_t *cell_db_q8,
                     const uint32_t *cell, int16_t *level_db_q8, uint32_t cells);

/* Speckle from the grain: numbers of a field (lm/grain.h), and the curve that makes decibels of
 * them. */
struct lm_k_curve {
    const int32_t *base_db_q8; /* LM_K_CURVE_LINES entries; with the rise they take 16 bits */
    const int32_t *rise_db_q8; /* likewise; 0..4369, so that 15 times as much takes 16 bits */
};

enum { LM_K_CURVE_LINES = 16 };

/* Add to each level the speckle of its number; the sum is held within 16 bits. Cost: 2 a cell. */
void lm_k_grain_add(const struct lm_k_curve *curve, const int8_t *grain_q5, int16_t *level_db_q8,
                    uint32_t cells);

/* Power of each level and the floor together, as a level, and the speckle of its number added to
 * it. Levels, floor and their sum are held within 16 bits, or 128 dB of 0: what is more than 32 dB
 * below a floor changes nothing. The sum's worst error is 0.018 dB. Cost: 3 a cell. */
void lm_k_grain_floor(const struct lm_k_curve *curve, const int8_t *grain_q5, int32_t floor_db_q8,
                      const int16_t *level_db_q8, int16_t *noisy_db_q8, uint32_t cells);

enum { LM_K_GRAIN_WAY = 64, LM_K_GRAIN_BEHIND = 32 };

/* A number between two of the field, by weights in 1/128 that add up to 255 at most: sums are below
 * 2^15. */
static inline int8_t lm_k_grain_between(int8_t first, int32_t first_q7, int8_t second,
                                        int32_t second_q7)
{
    const int16_t sum_q7 = (int16_t)(first * first_q7 + second * second_q7 + 64);
    const int16_t number = (int16_t)(sum_q7 >> 7);
    const int16_t held = number < INT8_MAX ? number : INT8_MAX;
    return (int8_t)(held > INT8_MIN ? held : INT8_MIN);
}

/* Draw columns of the field wider than they are: cell i stands between the columns before and
 * behind i step_q16 / 65536, w sixty-fourths of the way, and has them with weight_q7[64 - w] and
 * weight_q7[w]. Steps are below 65536. `weight_q7` has LM_K_GRAIN_WAY + 1 entries, of which such
 * two add up to 255 at most; `column_q5` one for each cell, and room for LM_K_GRAIN_BEHIND more.
 * Cost: 4 a cell. */
void lm_k_grain_stretch(const uint8_t *weight_q7, uint32_t step_q16, const int8_t *column_q5,
                        int8_t *grain_q5, uint32_t cells);

/* Layover: the power of each cell moves to where its top is displayed. Equation: docs/EQUATIONS.md,
 * "Layover". */

enum {
    LM_K_LAYOVER_MARGIN = 32, /* entries of `laid_db_q8` before the line, and behind it */
    LM_K_LAYOVER_ROOM = LM_K_LAYOVER_MARGIN + LM_CELLS_ROOM + LM_K_LAYOVER_MARGIN,
    /* A higher level counts as 96 dB. A line's cells together are 27 dB more, in 16 bits. */
    LM_K_LAYOVER_MOST_DB_Q8 = 96 * 256
};

/* A line whose tops are displaced. */
struct lm_k_layover {
    const uint32_t *cell;           /* as in lm_k_tops: the height code counts */
    const int32_t *elevation_m_q14; /* magnitude below 2^29 */
    const int16_t *level_db_q8;     /* LM_LEVEL_SHADOW behind the last cell */
    uint32_t cells;                 /* 1..LM_CELLS_MAX */
    int32_t reference_m_q14;        /* what lies as high is not displaced; magnitude below 2^29 */
    int32_t sixteenths_q31;         /* of a cell for 2^-14 m of elevation; 0..2^31 - 1 */
    /* Sixteenths of a cell by height code, up to 32767: lower bytes, upper bytes. */
    const uint8_t (*height_sixteenths)[LM_K_CODES];
};

/* Sum up the powers of cells where they are displayed, as levels. Entry LM_K_LAYOVER_MARGIN + i of
 * `laid_db_q8` is cell i; it has LM_K_LAYOVER_ROOM entries, and what the margins then hold means
 * nothing.
 *
 * - A place is a whole number of sixteenths of a cell. Power is shared between the two cells around
 *   it: n/16 for the farther one.
 * - A level of at most half of LM_LEVEL_SHADOW has no power. Cells that get none have
 *   LM_LEVEL_SHADOW, or a little more where others were added and left out: 3 dB for one, which
 *   are 70 dB below the least power that counts.
 * - Each sum's worst error is 0.018 dB.
 *
 * Cost: up to 7 a cell where nothing moves, 9 to 10 over hills and in towns. A group is a pass for
 * each two cells that its places are apart. */
void lm_k_layover(const struct lm_k_layover *line, int16_t *laid_db_q8);

/* Noise: draws of random numbers in decibels, as lm/noise.h makes them. Draws come in
 * blocks of LM_LANES cells: those of block b are row_db_q8[entry[b]] and the LM_LANES - 1 behind
 * it. `entry` has one for each block of the line, and for whole groups. */

#endif
