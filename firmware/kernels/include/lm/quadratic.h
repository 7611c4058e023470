/* Track: one coordinate of the cells along a line that bends a little, as a quadratic in the cell's
 * number. Everything is modulo 2^32, so that no overflow is an error; the unit is the user's. */
#ifndef LM_QUADRATIC_H
#define LM_QUADRATIC_H

#include <stdint.h>

/* Cell k lies at `at + k (step + k half_bend)`. */
struct lm_quadratic {
    uint32_t at, step, half_bend;
};

static inline uint32_t lm_quadratic_at(const struct lm_quadratic *t, uint32_t k)
{
    return t->at + k * (t->step + k * t->half_bend);
}

#endif
