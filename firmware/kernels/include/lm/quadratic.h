/* Quadratic: one coordinate of the cells along a line that bends a little, as a polynomial of the
 * cell's number. All sums are modulo 2^32, and overflow is no error. The caller chooses the unit.
 */
#ifndef LM_QUADRATIC_H
#define LM_QUADRATIC_H

#include <stdint.h>

/* Cell k lies at `at + k (step + k half_bend)`. */
struct lm_quadratic {
    uint32_t at, step, half_bend;
};

static inline uint32_t lm_quadratic_at(const struct lm_quadratic *q, uint32_t k)
{
    return q->at + k * (q->step + k * q->half_bend);
}

#endif
