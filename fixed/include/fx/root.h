/* Square root, exact to the last bit: the result is the root rounded down. */
#ifndef FX_ROOT_H
#define FX_ROOT_H

#include <stdint.h>

/* floor(sqrt(x)) for every x. The root of a Q(2n) number is in Q(n). Cost: about 50 instructions,
 * no division, no loop. */
uint32_t fx_sqrt_u64(uint64_t x);

/* Length of the vector (x, y), floor(sqrt(x^2 + y^2)), for every x and y. The result has the format
 * of the arguments. The largest sum, 2 * 2^62, fits 64 bits. Cost: that of fx_sqrt_u64. */
static inline uint32_t fx_hypot_u32(int32_t x, int32_t y)
{
    return fx_sqrt_u64((uint64_t)((int64_t)x * x) + (uint64_t)((int64_t)y * y));
}

#endif
