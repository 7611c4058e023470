/* Noise without a state: the same numbers on every machine, in whatever order they are asked for.
 */
#ifndef FX_HASH_H
#define FX_HASH_H

#include <stdint.h>

/* The factors of C. Wellons' lowbias32 ("Prospecting for Hash Functions", 2018). */
#define FX_HASH_FIRST  0x7feb352du
#define FX_HASH_SECOND 0x846ca68bu

/* A random number for a place and an epoch, say row a and column b at look c, in two steps: a sum
 * and what is made of it. Sums are linear, so that a loop over neighbouring places may add to that
 * of the first one: fx_hash3_sum(a + i, b + k, c) is fx_hash3_sum(a, b, c) + fx_hash3_sum(i, k, 0).
 *
 * Two places share a number only where their sums are the same modulo 2^32. The nearest such pair
 * of one look is 25157 rows and 44599 columns apart; of looks less than 256 apart, 48 rows and 3570
 * columns.
 *
 * The upper 20 bits look random (tests/unit/fixed/test_hash.c); those below are not stirred to the
 * end. Cost: nine instructions besides the constants, seven where the sum is there. */
static inline uint32_t fx_hash3_sum(uint32_t a, uint32_t b, uint32_t c)
{
    return (a + c * 0x9e3779b9u) * 0xed5ad4bbu + b * 0xac4c1b51u;
}

static inline uint32_t fx_hash3_of_sum(uint32_t sum)
{
    const uint32_t x = (sum ^ sum >> 16) * FX_HASH_FIRST;
    return (x ^ x >> 15) * FX_HASH_SECOND;
}

static inline uint32_t fx_hash3(uint32_t a, uint32_t b, uint32_t c)
{
    return fx_hash3_of_sum(fx_hash3_sum(a, b, c));
}

#endif
