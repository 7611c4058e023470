/* Speckle of the grain's numbers by a curve: lm/kernels_clutter.h. */
#ifndef CURVE_H
#define CURVE_H

#include "lm/kernels_clutter.h"

/* Indices are signed, because then a loop of this becomes vector gathers. */
static inline int32_t curve_db_q8(const int32_t *base_db_q8, const int32_t *rise_db_q8,
                                  int8_t grain_q5)
{
    const int32_t c = grain_q5 + 128;
    return base_db_q8[c >> 4] + (rise_db_q8[c >> 4] * (c & 15) >> 4);
}

#endif
