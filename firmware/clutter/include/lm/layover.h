/* What stands high is displayed nearer, as a radar that measures slant ranges sees it.
 * docs/EQUATIONS.md, "Layover". */
#ifndef LM_LAYOVER_H
#define LM_LAYOVER_H

#include "lm/illumination.h"

struct lm_layover {
    int32_t reference_m_q10; /* what stands at this elevation keeps its place, metres * 1024 */
    int32_t lean_q16;        /* metres nearer for each metre above it */
    uint32_t cell_m_q8;      /* metres * 256 */
    uint32_t first, cells;   /* of the line: first..cells - 1 take part */
};

/* Move the power of each cell to where its top appears, half-way between two cells to both; powers
 * in one cell add, and what leaves the line is lost. Levels above 90 dB saturate. `power_q32` is
 * scratch. Cost: about 100 instructions a cell. */
void lm_layover_run(const struct lm_layover *l, const struct lm_classes *classes,
                    const struct lm_scan_line *ground, int32_t *level_db_q8,
                    uint64_t power_q32[LM_CELLS_ROOM]);

#endif
