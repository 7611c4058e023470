/* Random numbers for host tools: xoshiro256** seeded by splitmix64 (Blackman and Vigna, 2018). The
 * same seed gives the same sequence on every machine. The firmware uses fx_hash instead, which
 * needs no order. */
#ifndef HS_RNG_H
#define HS_RNG_H

#include <stdint.h>

struct hs_rng {
    uint64_t s[4];
};

void hs_rng_seed(struct hs_rng *r, uint64_t seed);
uint64_t hs_rng_u64(struct hs_rng *r);
double hs_rng_uniform(struct hs_rng *r);                 /* [0, 1) */
double hs_rng_normal(struct hs_rng *r);                  /* mean 0, variance 1 */
uint32_t hs_rng_below(struct hs_rng *r, uint32_t bound); /* 0..bound-1, unbiased; bound > 0 */

#endif
