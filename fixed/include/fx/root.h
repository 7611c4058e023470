/* Square roots, exact to the last bit: the result is the root rounded down. */
#ifndef FX_ROOT_H
#define FX_ROOT_H

#include <stdint.h>

/* floor(sqrt(x)) for every x. Cost about 50 instructions, no division, no loop. */
uint32_t fx_sqrt_u64(uint64_t x);

/* floor(sqrt(x^2 + y^2)) for every x and y. The largest sum, 2 * 2^62, fits 64 bits. */
static inline uint32_t fx_hypot_u32(int32_t x, int32_t y)
{
    return fx_sqrt_u64((uint64_t)((int64_t)x * x) + (uint64_t)((int64_t)y * y));
}

#endif
