/* What the radar sees of a line: horizon, shadow, slope, walls, edges, in one pass from near to
 * far. Equations: docs/EQUATIONS.md, "Illumination". */
#ifndef LM_ILLUMINATION_H
#define LM_ILLUMINATION_H

#include <stdint.h>

#include "lm/db.h"
#include "lm/level.h"
#include "lm/radar.h"
#include "lm/scan_line.h"

/* Nothing nearer than this or than half the antenna's height is shown: the beam does not look down
 * more steeply than 63 degrees. */
enum { LM_RANGE_MIN_M = 256 };

/* What depends on range and height alone, worked out once for many lines. */
struct lm_range_grid {
    uint32_t cells;
    uint32_t cell_m_q8; /* length, metres * 256 */
    int32_t height_m_q10,
        reference_m_q10;      /* antenna; flat ground of the time gain; metres * 1024 */
    uint32_t first;           /* cells before this are too near to be shown */
    int32_t shore_fall_db_q8; /* a cell, see aspect.c */
    uint32_t tangent_bits;    /* the tangents of this grid are times 2^tangent_bits: 22..32 */
    int32_t flat_rise;        /* of the tangent in the first cell over flat ground, so */
    int32_t inverse_range[LM_CELLS_ROOM]; /* 1 / s in Q(17 + tangent_bits), s in metres; 0..2^31 */
    int32_t
        fall_m_q14[LM_CELLS_ROOM]; /* the Earth's drop and the antenna's height, metres * 16384 */
    int32_t gain_db_q8[LM_CELLS_ROOM]; /* K_i, reflectivity code 0, and the scale of the tangents */
};

/* Cell i is centred at first_m_q8 + i * cell_m_q8 (metres * 256); cell_m_q8 > 0, last centre below
 * 400 km; height_m_q10 within 30 km. Cost: about 120 instructions a cell. */
void lm_range_grid_set(struct lm_range_grid *g, const struct lm_illumination_config *config,
                       uint32_t first_m_q8, uint32_t cell_m_q8, uint32_t cells,
                       int32_t height_m_q10, int32_t reference_m_q10);

enum { LM_CLASS_LUT_CODES = 16 }; /* height codes of a map, and classes */

/* What a map's classes and height codes mean here, worked out once for many lines. */
struct lm_class_lut {
    uint16_t height_dm[LM_CLASS_LUT_CODES];         /* of the height code */
    uint8_t mark[LM_CLASS_LUT_CODES];               /* of the class: lm/kernels_clutter.h */
    uint8_t edge_structure_db_q3, edge_trees_db_q3; /* leading edges, dB * 8 */
    int32_t shore_db_q8;                            /* brightness of a far shore, dB * 256 */
};

void lm_class_lut_set(struct lm_class_lut *class_lut, const struct lm_illumination_config *config,
                      const struct lm_classes *classes);

/* The running horizon: tangent of the highest look so far, Q40. */
typedef int64_t lm_horizon_q40_t;

/* No terrain seen yet: the first cell that is looked at will be lit as flat ground is. */
#define LM_HORIZON_OPEN INT64_MIN

/* Entries that working out the light takes for scratch: too large for a stack. */
enum { LM_LIT_SCRATCH = 4 * (LM_LANES + LM_CELLS_ROOM) + 32 };

/* What becomes of a line's cells. */
struct lm_lit_line {
    /* horizon[0] is where the line starts, horizon[i + 1] what cell i leaves: the largest tangent
     * so far, in the grid's format. Cells that are not shown leave it alone. */
    int32_t horizon[LM_CELLS_ROOM];
    int32_t level_db_q8[LM_CELLS_ROOM]; /* LM_LEVEL_SHADOW where nothing is lit */
    int32_t scratch[LM_LIT_SCRATCH];    /* means nothing afterwards */
};

/* Fill `lit` for the cells of the grid. Returns the horizon behind the last cell. */
lm_horizon_q40_t lm_illuminate(const struct lm_range_grid *grid,
                               const struct lm_class_lut *class_lut,
                               const struct lm_scan_line *line, lm_horizon_q40_t horizon,
                               struct lm_lit_line *lit);

#endif
