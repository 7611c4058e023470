/* Slant range: bins of a display line, equally spaced in what the radar measures, and the cells of
 * ground, equally spaced in ground range, that they show.
 *
 *     antenna o .
 *             |   ' .            r: slant range of the bin's centre
 *           h |       ' .
 *             |           ' .
 *         ----+---|---|---|---|---   cells of the grid
 *             |<--- s --->|      s = sqrt(r^2 - h^2)
 *
 *     bin         0   1   2   3   4   5   6   7      for h = 3.4 cells, cells as long as bins
 *     cell_of     -   -   -   0   2   4   5   6      -: r <= h, the altitude hole
 *     pair.last               1   3
 *
 * Near the hole a bin covers two or three cells. It shows the stronger of the cell at its centre
 * and the last cell before that of the next bin.
 *
 * Source: docs/EQUATIONS.md, "Slant range". */
#ifndef LM_SLANT_H
#define LM_SLANT_H

#include <stdint.h>

#include "lm/illumination.h"

/* Bins of a display line, and the ground cells of each. The caller owns it. */
struct lm_slant {
    uint32_t first_m_q8, cell_m_q8; /* slant range of bin 0's centre, and between centres */
    uint32_t cells;                 /* number of bins */
    uint32_t hole;                  /* of them in the altitude hole, before the nearest ground */
    /* Ground cell at the bin's centre. It is the grid's number of cells where there is no ground.
     */
    int32_t cell_of[LM_CELLS_ROOM];
    /* Bins that cover more than the cell at their centre, with the last cell before that of the
     * next bin. Only bins near the altitude hole do. */
    struct lm_slant_pair {
        uint16_t bin, last;
    } pair[LM_CELLS_ROOM];
    uint32_t pairs;
};

/* Lay bins over the cells of `grid`, whose cell 0 is centred at ground range `ground_first_m_q8`.
 * `cells` is at most LM_CELLS_MAX; the last bin lies below 400 km. `grid` is borrowed for the call.
 * Cost: about 200 instructions a bin. */
void lm_slant_set(struct lm_slant *s, uint32_t first_m_q8, uint32_t cell_m_q8, uint32_t cells,
                  const struct lm_range_grid *grid, uint32_t ground_first_m_q8);

/* Compute the power of each bin from the levels of the grid's cells; 1.0 in Q24 is 0 dB of gamma. A
 * bin takes the stronger of its two cells; a bin without ground has none. `grid` is that of
 * lm_slant_set. `level_db_q8` has grid->cells + 1 entries; the last one is written. */
void lm_slant_run(const struct lm_slant *s, const struct lm_range_grid *grid, int16_t *level_db_q8,
                  uint32_t *power_q24);

#endif
