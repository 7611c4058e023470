/* Zero bits: number of zeros at the top or the bottom of a word, defined for 0 as well.
 *
 * Inline, without loop or table. Cost: one instruction where the machine has one for it. */
#ifndef FX_BITS_H
#define FX_BITS_H

#include <stdint.h>

/* Leading zeros of 32 bits: zeros above the highest set bit, 0..32. 32 for x = 0. */
static inline int fx_clz32(uint32_t x)
{
    return x == 0 ? 32 : __builtin_clz(x);
}

/* Leading zeros of 64 bits, 0..64. 64 for x = 0. Built from halves, because the compiler's own
 * would be a library call on a 32-bit machine. */
static inline int fx_clz64(uint64_t x)
{
    const uint32_t high = (uint32_t)(x >> 32);
    return high != 0 ? fx_clz32(high) : 32 + fx_clz32((uint32_t)x);
}

/* Trailing zeros of 64 bits: zeros below the lowest set bit, 0..64. 64 for x = 0. */
static inline int fx_ctz64(uint64_t x)
{
    return x == 0 ? 64 : 63 - fx_clz64(x & (0 - x));
}

#endif
