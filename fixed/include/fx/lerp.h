/* Interpolation whose weights sum to exactly one. */
#ifndef FX_LERP_H
#define FX_LERP_H

#include <stdint.h>

/* From a (t = 0) to b (t = 65536), rounded to nearest with halves up, exact at both ends and never
 * outside them. t_q16 0..65536. The difference takes 33 bits and the product 50. */
static inline int32_t fx_lerp_i32(int32_t a, int32_t b, uint32_t t_q16)
{
    return (int32_t)(a + ((((int64_t)b - a) * (int64_t)t_q16 + 32768) >> 16));
}

/* Blend four samples; tx and ty run 0..256, where 0 is the c00 corner and 256 exactly the far one.
 * The result is the value times 65536, without any rounding.
 *
 * The weights sum to 65536, so that a flat field comes back unchanged and the result lies between
 * the smallest and the largest corner. The worst sum is 65535 * 65536, which fits 32 bits. */
static inline uint32_t fx_bilerp_u16_q16(uint16_t c00, uint16_t c10, uint16_t c01, uint16_t c11,
                                         uint32_t tx_q8, uint32_t ty_q8)
{
    const uint32_t top = c00 * (256u - tx_q8) + c10 * tx_q8;
    const uint32_t bottom = c01 * (256u - tx_q8) + c11 * tx_q8;
    return top * (256u - ty_q8) + bottom * ty_q8;
}

/* The same to the nearest whole number, halves up; 65535 * 65536 + 32768 still fits. */
static inline uint16_t fx_bilerp_u16(uint16_t c00, uint16_t c10, uint16_t c01, uint16_t c11,
                                     uint32_t tx_q8, uint32_t ty_q8)
{
    return (uint16_t)((fx_bilerp_u16_q16(c00, c10, c01, c11, tx_q8, ty_q8) + 32768u) >> 16);
}

#endif
