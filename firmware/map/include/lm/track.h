/* One coordinate of the cells along a line, whose way bends a little. */
#ifndef LM_TRACK_H
#define LM_TRACK_H

#include <stdint.h>

/* Cell k is at `at + k (step + k half_bend)`, modulo 2^32. The unit is the user's. */
struct lm_track {
    uint32_t at, step, half_bend;
};

static inline uint32_t lm_track_at(const struct lm_track *t, uint32_t k)
{
    return t->at + k * (t->step + k * t->half_bend);
}

#endif
