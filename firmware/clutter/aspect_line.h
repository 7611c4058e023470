/* What the two ways of working out a line's light share: one for every machine, in aspect.c, and
 * one for the vectors of 64-bit Arm, in aspect_neon.h, with the same results. */
#ifndef ASPECT_LINE_H
#define ASPECT_LINE_H

#include "lm/aspect.h"

enum {
    CODES = 16,        /* height codes, classes */
    Q19_OF_DM = 52429, /* 2^19 / 10, and 0.4 mm more for 100 m; times 65535 it takes 32 bits */
    MARK_WATER = 1,
    MARK_STRUCTURE = 2,
    MARK_TREES = 4,
    MARK_BITS = 3
};

/* Tangent of the top of cell i. */
static inline int32_t tangent_of(const struct lm_range_grid *grid, const struct lm_legend *legend,
                                 const struct lm_scan_line *line, uint32_t i)
{
    /* Elevation below 2^29, height below 2^27, fall below 2^30: below 2^31, times 2^31. Sums
     * without a sign, for what stands behind the last cell may be anything. */
    const uint32_t top_q14 = (uint32_t)line->elevation_q14[i] +
                             (uint32_t)legend->height_q14[(int32_t)(line->cell[i] % CODES)];
    const int32_t apparent_q14 = (int32_t)(top_q14 - (uint32_t)grid->fall_q14[i]);
    /* Without a sign, which the 32 bits kept do not see: vectors have no other shift. */
    return (int32_t)((uint64_t)((int64_t)apparent_q14 * grid->inverse_range[i]) >> 31);
}

static inline int32_t kind_of(const struct lm_legend *legend, uint32_t cell)
{
    return legend->kind[(int32_t)((cell >> 4) % CODES)];
}

#endif
