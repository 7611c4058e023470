/* Interpolation whose weights sum to exactly one. */
#ifndef FX_LERP_H
#define FX_LERP_H

#include <stdint.h>

/* Blend four samples; tx and ty run 0..256, where 0 is the c00 corner and 256 exactly the far one.
 * The result is the value times 65536, without any rounding.
 *
 * As a sum of weights it is c00 (256 - tx) (256 - ty) + c10 tx (256 - ty) + ..., and the weights
 * add up to 65536: a flat field comes back unchanged, the result lies between the smallest and the
 * largest corner, and the worst sum, 65535 * 65536, fits 32 bits. Written as start and difference
 * it takes three products instead of six. The differences may be negative, modulo 2^32, and so may
 * their products; as the end result fits, it is right. */
static inline uint32_t fx_bilerp_u16_q16(uint16_t c00, uint16_t c10, uint16_t c01, uint16_t c11,
                                         uint32_t tx_q8, uint32_t ty_q8)
{
    const uint32_t w00 = c00, w10 = c10, w01 = c01, w11 = c11;
    const uint32_t top = (w00 << 8) + (w10 - w00) * tx_q8;
    const uint32_t bottom = (w01 << 8) + (w11 - w01) * tx_q8;
    return (top << 8) + (bottom - top) * ty_q8;
}

#endif
