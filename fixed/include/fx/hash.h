/* Noise without a state: the same numbers on every machine, in whatever order they are asked for.
 */
#ifndef FX_HASH_H
#define FX_HASH_H

#include <stdint.h>

/* A permutation of the 32-bit numbers that looks random: C. Wellons' lowbias32 ("Prospecting for
 * Hash Functions", 2018; bias 0.174 by his measure). Note that 0 gives 0. Cost 5 instructions besides
 * the constants. */
static inline uint32_t fx_hash_u32(uint32_t x)
{
    x = (x ^ x >> 16) * 0x7feb352du;
    x = (x ^ x >> 15) * 0x846ca68bu;
    return x ^ x >> 16;
}

/* A random number for a place and an epoch, say cell column, row and look. Cheap enough for every
 * pixel: ten instructions on Arm, where a shifted operand is free, besides the constants, and
 * seven in a loop that changes b alone. Each input meets at least two multiplications with a
 * folding shift between them, and nothing in it is linear in all three, so that the next epoch is
 * no shifted copy of this one. */
static inline uint32_t fx_hash3(uint32_t a, uint32_t b, uint32_t c)
{
    uint32_t x = a * 0xed5ad4bbu;
    x = ((x ^ x >> 15) + b) * 0xac4c1b51u;
    x = ((x ^ x >> 15) + c) * 0x7feb352du;
    x = (x ^ x >> 15) * 0x846ca68bu;
    return x ^ x >> 16;
}

#endif
