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

/* How the cells of a patch's lines are seen. */
struct lm_layover_view {
    int32_t reference_m_q10; /* tops at this elevation are not displaced */
    uint32_t lean_q16;       /* displacement over height, tan psi; below 2^17 */
    uint32_t cell_m_q8;      /* length of a cell; above 0 */
    uint32_t first, cells;   /* cells first..cells - 1 of the line take part */
};

/* Layover of the lines of a patch. Set up by lm_layover_set; the caller owns it, and all fields are
 * read-only to others. */
struct lm_layover {
    uint32_t first, cells;
    int32_t reference_m_q14;
    int32_t sixteenths_q31;                           /* of a cell for 2^-14 m of elevation */
    uint8_t height_sixteenths[2][LM_CLASS_LUT_CODES]; /* by height code: lower and upper bytes */
};

/* Entries of a line that is laid over: beside the line there is room for what leaves it. */
enum { LM_LAYOVER_ROOM = LM_CELLS_ROOM + 64 };

/* Prepare the layover of a patch. Cost: some 300 instructions. */
void lm_layover_set(struct lm_layover *l, const struct lm_classes *classes,
                    const struct lm_layover_view *view);

/* Move the power of each cell to where its top is displayed.
 *
 * - Places are rounded to sixteenths of a cell. Power is shared between the two cells that the
 *   displaced point lies between.
 * - Powers that meet in one cell add.
 * - Power that leaves the line is lost, and nothing enters at its ends.
 * - Cells that get no power have less than half of LM_LEVEL_SHADOW.
 *
 * `ground` has cells and elevations of the line, `level_db_q8` its levels; what it holds in the
 * last group of 16 cells, behind the last cell, is lost. Returns the line as it is laid over, in
 * `laid_db_q8`, which has LM_LAYOVER_ROOM entries. Pointers are borrowed for the call. Cost: that
 * of lm_k_layover. */
int16_t *lm_layover_run(const struct lm_layover *l, const struct lm_scan_line *ground,
                        int16_t *level_db_q8, int16_t *laid_db_q8);

#endif
