/* Slant range: what a radar measures, against the ground range at which a line is sampled.
 * docs/EQUATIONS.md, "Slant range". */
#ifndef LM_SLANT_H
#define LM_SLANT_H

#include <stdint.h>

#include "lm/illumination.h"

/* The bins of a display line, equally spaced in slant range, and where each finds its ground. */
struct lm_slant {
    uint32_t first_m_q8, cell_m_q8; /* of bin 0's centre, and between centres; metres * 256 */
    uint32_t cells;
    /* The ground cell at the bin's centre; the grid's number of cells: no ground there. */
    int32_t cell_of[LM_CELLS_ROOM];
    /* Near the hole a bin covers two or three: those that cover more than the cell at the centre,
     * and the last one before that of the next bin's. */
    struct lm_slant_pair {
        uint16_t bin, last;
    } pair[LM_CELLS_ROOM];
    uint32_t pairs;
};

/* Bins over the cells of `grid`, whose cell 0 is centred at `ground_first_m_q8`. cells up to
 * LM_CELLS_MAX; the last bin below 400 km. Cost: about 200 instructions a bin. */
void lm_slant_set(struct lm_slant *s, uint32_t first_m_q8, uint32_t cell_m_q8, uint32_t cells,
                  const struct lm_range_grid *grid, uint32_t ground_first_m_q8);

/* Power (1.0 in Q24 is 0 dB of gamma) of each bin: that of the stronger of its two cells, from the
 * ground cells' levels. A bin without
 * ground has none. `level_db_q8` has room for one more than the grid's cells, which is written. */
void lm_slant_run(const struct lm_slant *s, const struct lm_range_grid *grid, int32_t *level_db_q8,
                  uint32_t *power_q24);

#endif
