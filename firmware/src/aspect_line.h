/* What the two ways of working out a line's light share: one for every machine, in aspect.c, and
 * one for the vectors of 64-bit Arm, in aspect_neon.h, with the same results. */
#ifndef ASPECT_LINE_H
#define ASPECT_LINE_H

#include "lm/aspect.h"

enum {
    CODES = 16,      /* height codes, classes */
    CODE_MIDDLE = 8, /* where code 0 stands in the tables of a legend */
    MARK_WATER = 1,
    MARK_STRUCTURE = 2,
    MARK_TREES = 4,
    MARK_BITS = 3
};

/* What classes and height codes mean, by a number of four bits taken as signed, -8..7, behind the
 * eighth: a lookup becomes a vector gather where its index has a sign. */
struct legend {
    int32_t height_q14[CODES]; /* of the height code */
    int32_t kind[CODES];       /* of the class: brightness of its leading edge * 8, and a mark */
};

static inline int32_t signed_code(uint32_t cell)
{
    return (int32_t)(cell << 28) >> 28;
}

/* Tangent of the top of cell i. */
static inline int32_t tangent_of(const struct lm_range_grid *grid, const struct lm_scan_line *line,
                                 const struct legend *legend, uint32_t i)
{
    const int32_t height_q14 = legend->height_q14[CODE_MIDDLE + signed_code(line->cell[i])];
    /* Elevation below 2^29, height below 2^27, fall below 2^30: below 2^31, times 2^30. */
    const int32_t apparent_q14 = line->elevation_q14[i] + height_q14 - grid->fall_q14[i];
    /* Without a sign, which the 32 bits kept do not see: vectors have no other shift. */
    return (int32_t)((uint64_t)((int64_t)apparent_q14 * grid->inverse_range[i]) >> 30);
}

static inline int32_t kind_of(const struct legend *legend, uint32_t cell)
{
    return legend->kind[CODE_MIDDLE + signed_code(cell >> 4)];
}

/* The far shore's brightness from its first cell `i` on, where there is light. */
static inline void add_shore(const struct lm_range_grid *grid, int32_t shore_q8,
                             const struct lm_scan_line *line, const struct legend *legend,
                             uint32_t i, struct lm_sight *sight)
{
    for (; i < grid->cells && shore_q8 > 0; i++, shore_q8 -= grid->shore_fall_q8) {
        if (kind_of(legend, line->cell[i]) & MARK_WATER) {
            return;
        }
        sight->level_q8[i] += sight->horizon[i + 1] != sight->horizon[i] ? shore_q8 : 0;
    }
}

#endif
