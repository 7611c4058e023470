/* Noise without a state: the same numbers on every machine, in whatever order they are asked for.
 */
#ifndef FX_HASH_H
#define FX_HASH_H

#include <stdint.h>

/* A random number for a place and an epoch, say row a and column b at look c: a sum, linear in all
 * three, and what two rounds of multiplying make of it, by the
 * factors of C. Wellons' lowbias32 ("Prospecting for Hash Functions", 2018).
 *
 * Two places share a number only where their sums are the same modulo 2^32. The nearest such pair
 * of one look is 25157 rows and 44599 columns apart; of looks less than 256 apart, 48 rows and 3570
 * columns.
 *
 * The upper 20 bits look random (tests/unit/fixed/test_hash.c); those below are not stirred to the
 * end. Cost: nine instructions besides the constants. */
static inline uint32_t fx_hash3(uint32_t a, uint32_t b, uint32_t c)
{
    const uint32_t sum = (a + c * 0x9e3779b9u) * 0xed5ad4bbu + b * 0xac4c1b51u;
    const uint32_t x = (sum ^ sum >> 16) * 0x7feb352du;
    return (x ^ x >> 15) * 0x846ca68bu;
}

#endif
