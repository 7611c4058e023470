/* Illumination: which cells of a line the radar sees, and how bright they are. Horizon, shadow,
 * slopes, walls and edges come from one pass, from near to far. Law: docs/EQUATIONS.md,
 * "Illumination".
 *
 *     tangent of elevation
 *        |                    ____________________   running horizon
 *        |        ___________/#                          #  lit: the top rises above the horizon
 *        |  _____/#    .      #   .     .      .         .  shadow: LM_LEVEL_SHADOW
 *        |_/#_____#____._._.__#___._.___._._.__.__
 *         first                              cells
 *
 * Example: light the line that lm_scan_line_run has read.
 *
 *     static struct lm_range_grid grid;
 *     static struct lm_class_lut lut;
 *     static struct lm_lit_line lit;
 *     lm_range_grid_set(&grid, &radar->illumination, cell_m_q8 / 2, cell_m_q8, cells, height_m_q10,
 *                       reference_m_q10);                        once a sector or patch
 *     lm_class_lut_set(&lut, &radar->illumination, &db->classes);
 *     lm_illuminate(&grid, &lut, NULL, &line, LM_HORIZON_OPEN, &lit);  once a line
 *
 * No function fails. Pointers are borrowed for the call. */
#ifndef LM_ILLUMINATION_H
#define LM_ILLUMINATION_H

#include <stdint.h>

#include "lm/class_gain.h"
#include "lm/db.h"
#include "lm/level.h"
#include "lm/radar.h"
#include "lm/scan_line.h"

/* Cells nearer than this, or nearer than half the antenna's height, are not displayed: the beam
 * does not look down more steeply than 63 degrees. */
enum { LM_RANGE_MIN_M = 256 };

/* Range grid: the numbers of a line's cells that depend on range and height alone. Prepared once
 * for many lines.
 *
 * Tangents of a grid have 2^tangent_bits steps, as many as fit 32 bits at its nearest cell. */
struct lm_range_grid {
    uint32_t cells;           /* 1..LM_CELLS_MAX */
    uint32_t cell_m_q8;       /* length of a cell */
    int32_t height_m_q10;     /* antenna above mean sea level */
    int32_t reference_m_q10;  /* flat ground for which the receiver's gain is set: z0 */
    uint32_t first;           /* cells before this are too near to be displayed; 0..cells */
    int32_t shore_fall_db_q8; /* what a far shore loses from cell to cell */
    uint32_t tangent_bits;    /* 22..32 */
    int32_t flat_rise;        /* rise of the tangent in cell `first` over flat ground */
    int32_t inverse_range[LM_CELLS_ROOM]; /* 1 / s in Q(17 + tangent_bits), s in metres; 0..2^31 */
    int32_t fall_m_q14[LM_CELLS_ROOM];    /* the antenna's height plus the Earth's drop */
    /* K_i, gamma of reflectivity code 0, scale of the tangents: -52..38 dB over LM_LEVEL_SHADOW. */
    int16_t gain_db_q8[LM_CELLS_ROOM];
};

/* Prepare a grid whose cell i is centred at ground range first_m_q8 + i * cell_m_q8.
 *
 * - cell_m_q8 > 0; the last centre is below 400 km.
 * - height_m_q10 is within 30 km.
 * - Arrays are set for cells 0..cells - 1, to 0 before `first`.
 *
 * Cost: about 120 instructions a cell. */
void lm_range_grid_set(struct lm_range_grid *g, const struct lm_illumination_config *config,
                       uint32_t first_m_q8, uint32_t cell_m_q8, uint32_t cells,
                       int32_t height_m_q10, int32_t reference_m_q10);

/* Entries by height code, and entries by class. */
enum { LM_CLASS_LUT_CODES = 16 };

/* Class look-up table: heights and edges of an image's classes. Prepared once for many lines. */
struct lm_class_lut {
    uint16_t height_dm[LM_CLASS_LUT_CODES]; /* by height code */
    uint8_t mark[LM_CLASS_LUT_CODES];       /* by class: LM_K_WATER ... of kernels_clutter.h */
    uint8_t edge_structure_db_q3, edge_trees_db_q3; /* leading edges, 0..31.875 dB */
    int32_t shore_db_q8;                            /* brightness of a far shore at the water */
};

/* Fill the table for an image's classes. Edges of `config` beyond LM_EDGE_MAX_DB_Q8 count as that,
 * and are rounded down to eighths of a decibel. */
void lm_class_lut_set(struct lm_class_lut *class_lut, const struct lm_illumination_config *config,
                      const struct lm_classes *classes);

/* Running horizon between grids: the largest tangent of elevation so far. */
typedef int64_t lm_horizon_q40_t;

/* Horizon of a line without foreground: the first displayed cell is lit like flat ground. */
#define LM_HORIZON_OPEN INT64_MIN

/* Entries of the work space of lm_illuminate, which is too large for a stack. */
enum { LM_LIT_SCRATCH = 4 * (LM_LANES + LM_CELLS_ROOM) + 32 + LM_CELLS_ROOM };

/* Illuminated line: the result of lm_illuminate. */
struct lm_lit_line {
    /* Running horizon: the largest tangent so far, in the grid's format. horizon[0] is that at the
     * start of the line, horizon[i + 1] that behind cell i. Cells before `first` leave it as it
     * is. */
    int32_t horizon[LM_CELLS_ROOM];
    int16_t level_db_q8[LM_CELLS_ROOM]; /* LM_LEVEL_SHADOW in shadow and before `first` */
    int32_t scratch[LM_LIT_SCRATCH];    /* work space; means nothing afterwards */
};

/* Illuminate the cells of a line, from the horizon at its start, and add to what is lit the gain of
 * its class (`class_gain`; NULL: none). Returns the horizon behind the last cell, or `horizon` if
 * no cell of the grid is displayed. The memory of `lit` may hold anything before. Cost: that of
 * lm_k_light, about 9 instructions a cell with vectors. */
lm_horizon_q40_t lm_illuminate(const struct lm_range_grid *grid,
                               const struct lm_class_lut *class_lut,
                               const struct lm_class_gain *class_gain,
                               const struct lm_scan_line *line, lm_horizon_q40_t horizon,
                               struct lm_lit_line *lit);

#endif
