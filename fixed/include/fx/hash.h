/* Hash of three integers: random numbers without a state.
 *
 * Every machine gets the same numbers, in whatever order it asks for them. */
#ifndef FX_HASH_H
#define FX_HASH_H

#include <stdint.h>

/* A random number for row a and column b in epoch c. All 32-bit arguments are allowed.
 *
 * The three are combined to one sum modulo 2^32, linear in each of them. Two rounds of shift, xor
 * and multiplication follow, with factors of C. Wellons' lowbias32 ("Prospecting for Hash
 * Functions", 2018).
 *
 * - Two pairs (a, b) share a number only where their sums are equal. The nearest such pairs of one
 *   epoch are 25157 rows and 44599 columns apart. Of epochs less than 256 apart they are 48 rows
 *   and 3570 columns apart.
 * - Only the upper 20 bits pass as random (tests/unit/fixed/test_hash.c). Those below are not fully
 *   mixed: shift them out.
 *
 * Cost: nine instructions besides the constants. */
static inline uint32_t fx_hash3(uint32_t a, uint32_t b, uint32_t c)
{
    const uint32_t sum = (a + c * 0x9e3779b9u) * 0xed5ad4bbu + b * 0xac4c1b51u;
    const uint32_t x = (sum ^ sum >> 16) * 0x7feb352du;
    return (x ^ x >> 15) * 0x846ca68bu;
}

#endif
