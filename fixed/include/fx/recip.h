/* One over a number, to be multiplied with instead of dividing. */
#ifndef FX_RECIP_H
#define FX_RECIP_H

#include <stdint.h>

/* Returns r in 2^31..2^32-1 and stores s, 31..63, such that 1/d = r * 2^-s from above by less than
 * one part in 2^31: r is floor(2^s / d) exactly, and no error at all when d is a power of two.
 * x / d is then ((uint64_t)x * r) >> s for x below 2^32, which is the true floor or one less.
 * d = 0 gives the largest, r = 2^32 - 1 with s = 0.
 * Cost 35 instructions, no division. */
uint32_t fx_recip_q(uint32_t d, int *s);

#endif
