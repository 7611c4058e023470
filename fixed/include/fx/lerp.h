/* Bilinear interpolation with weights that sum to exactly one. */
#ifndef FX_LERP_H
#define FX_LERP_H

#include <stdint.h>

/* Interpolate between four corners. The result is the value times 65536, without any rounding.
 *
 *     c01 ------- c11     tx_q8, ty_q8: 0..256
 *      |     x     |      0 is the side of c00, 256 exactly the far side
 *      |           |
 *     c00 ------- c10
 *
 * The law is c00 (256 - tx) (256 - ty) + c10 tx (256 - ty) + c01 (256 - tx) ty + c11 tx ty. The
 * weights add up to 65536. Hence four equal corners come back unchanged, and the result lies
 * between the smallest and the largest corner. The largest result, 65535 * 65536, fits 32 bits.
 *
 * Written as start and difference it takes three products instead of six. Differences and products
 * may be negative, and wrap modulo 2^32. The result is right nevertheless, because it fits. */
static inline uint32_t fx_bilerp_u16_q16(uint16_t c00, uint16_t c10, uint16_t c01, uint16_t c11,
                                         uint32_t tx_q8, uint32_t ty_q8)
{
    const uint32_t w00 = c00, w10 = c10, w01 = c01, w11 = c11;
    const uint32_t top = (w00 << 8) + (w10 - w00) * tx_q8;
    const uint32_t bottom = (w01 << 8) + (w11 - w01) * tx_q8;
    return (top << 8) + (bottom - top) * ty_q8;
}

#endif
