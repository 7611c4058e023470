/* Counting leading zeros: one instruction where the machine has it. */
#ifndef FX_BITS_H
#define FX_BITS_H

#include <stdint.h>

/* Zeros above the highest set bit, 0..32; 32 for x = 0. */
static inline int fx_clz32(uint32_t x)
{
    return x == 0 ? 32 : __builtin_clz(x);
}

/* The same for 64 bits, 0..64. Built from halves, so that 32-bit machines need no library call. */
static inline int fx_clz64(uint64_t x)
{
    const uint32_t high = (uint32_t)(x >> 32);
    return high != 0 ? fx_clz32(high) : 32 + fx_clz32((uint32_t)x);
}

/* Zeros below the lowest set bit, 0..64; 64 for x = 0. */
static inline int fx_ctz64(uint64_t x)
{
    return x == 0 ? 64 : 63 - fx_clz64(x & (0 - x));
}

#endif
