/* Noise without a state: the same numbers on every machine, in whatever order they are asked for.
 */
#ifndef FX_HASH_H
#define FX_HASH_H

#include <stdint.h>

/* A permutation of the 32-bit numbers that looks random: C. Wellons' lowbias32 ("Prospecting for
 * Hash Functions", 2018; bias 0.174 by his measure). Note that 0 gives 0. Cost 5 instructions
 * besides the constants. */
static inline uint32_t fx_hash_u32(uint32_t x)
{
    x = (x ^ x >> 16) * 0x7feb352du;
    x = (x ^ x >> 15) * 0x846ca68bu;
    return x ^ x >> 16;
}

/* A random number for a place and an epoch, say column b and row a at look c. Cheap enough for
 * every pixel: twelve instructions on Arm, where a shifted operand is free, besides the constants,
 * and seven in a loop that changes b alone: lowbias32 of b, begun and disturbed half-way by a hash
 * of a and c. The second use of that hash keeps two lines from being shifted copies of each other.
 *
 * Lines repeat only where a * 0xed5ad4bb + c * 0xac4c1b51 does, modulo 2^32: the nearest such
 * pair is 25157 rows and 44599 looks apart. */
static inline uint32_t fx_hash3(uint32_t a, uint32_t b, uint32_t c)
{
    uint32_t line = a * 0xed5ad4bbu + c * 0xac4c1b51u;
    line = (line ^ line >> 16) * 0x31848babu;
    uint32_t x = (line ^ line >> 15) + b;
    x = (x ^ x >> 16) * 0x7feb352du;
    x = ((x ^ x >> 15) + line) * 0x846ca68bu;
    return x ^ x >> 16;
}

#endif
