/* The cells of a track, four at a time, by the vectors of 64-bit Arm. */
#ifndef NEON_TRACK_H
#define NEON_TRACK_H

#include <arm_neon.h>

#include "lm/quadratic.h"

/* Four cells, how far it is to the next four, and by how much that grows. */
struct neon_track {
    uint32x4_t at, step, bend;
};

/* From cell `first` on. */
static inline struct neon_track neon_track_from(const struct lm_quadratic *t, uint32_t first)
{
    const uint32x4_t k = {0, 1, 2, 3}, eight_k_16 = {16, 24, 32, 40};
    const uint32_t step = t->step + 2 * first * t->half_bend;
    const uint32x4_t slope = vmlaq_n_u32(vdupq_n_u32(step), k, t->half_bend);
    return (struct neon_track){
        vmlaq_u32(vdupq_n_u32(lm_quadratic_at(t, first)), k, slope),
        vmlaq_n_u32(vdupq_n_u32(4 * step), eight_k_16, t->half_bend),
        vdupq_n_u32(32 * t->half_bend),
    };
}

/* The four cells, and on to the next. */
static inline uint32x4_t neon_next(struct neon_track *t)
{
    const uint32x4_t at = t->at;
    t->at = vaddq_u32(t->at, t->step);
    t->step = vaddq_u32(t->step, t->bend);
    return at;
}

#endif
