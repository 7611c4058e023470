/* Layover: high ground and tops of structures are displayed nearer, because a radar measures slant
 * range. Law: docs/EQUATIONS.md, "Layover".
 *
 *     antenna               displayed   true
 *        o---.                  |<-------^ top, y above the reference
 *             `---.             | y tan psi
 *                  `---.________|________|_____ reference */
#ifndef LM_LAYOVER_H
#define LM_LAYOVER_H

#include "lm/illumination.h"

/* Layover of the lines of a patch. */
struct lm_layover {
    int32_t reference_m_q10; /* tops at this elevation are not displaced */
    int32_t lean_q16;        /* displacement over height, tan psi; below 2^17 */
    uint32_t cell_m_q8;      /* length of a cell; above 0 */
    uint32_t first, cells;   /* cells first..cells - 1 of the line take part */
};

/* Move the power of each cell to where its top is displayed, in place.
 *
 * - Power is shared between the two cells that the displaced point lies between.
 * - Powers that meet in one cell add.
 * - Power that leaves the line is lost, and nothing enters at the far end.
 * - Levels above 90 dB saturate. Cells that get no power have LM_LEVEL_SHADOW.
 *
 * `ground` has cells and elevations of the line, `level_db_q8` its levels. `power_q32` is work
 * space. Pointers are borrowed for the call. Cost: about 100 instructions a cell. */
void lm_layover_run(const struct lm_layover *l, const struct lm_classes *classes,
                    const struct lm_scan_line *ground, int32_t *level_db_q8,
                    uint64_t power_q32[LM_CELLS_ROOM]);

#endif
