/* Reciprocal: 1/d as a factor and a shift, so that a product replaces a division. */
#ifndef FX_RECIP_H
#define FX_RECIP_H

#include <stdint.h>

/* Reciprocal of d: returns r = floor(2^s / d), 2^31..2^32 - 1, and stores the shift s, 31..63.
 *
 *     int s;
 *     const uint32_t r = fx_recip_q(d, &s);
 *     quotient = (uint32_t)((uint64_t)x * r >> s);     x / d rounded down, or one less
 *
 * - r 2^-s is below 1/d by less than one part in 2^31, and exact for powers of two.
 * - d = 0 gives the largest factor: r = 2^32 - 1 with s = 0.
 *
 * `s` is borrowed for the call. Cost: 35 instructions, no division. */
uint32_t fx_recip_q(uint32_t d, int *s);

#endif
