/* Conversions of units and fixed-point formats, named lm_TO_of_FROM: lm_m_q10_of_m_q6 makes metres
 * * 1024 of metres * 64. A conversion that loses nothing is called exact; "cut" rounds towards
 * zero, "down" towards minus infinity, "nearest" takes halves up. Ranges are those of the argument,
 * and nothing checks them. Cost: one to five instructions each. */
#ifndef LM_UNITS_H
#define LM_UNITS_H

#include <stdint.h>

#include "fx/types.h"

/* ---- constants: whole metres and decibels in Q8 ---- */

/* For enumerators and literals; variables take lm_m_q8_of_m and lm_db_q8_of_db. */
#define LM_M_Q8(metres)    ((metres)*256)
#define LM_DB_Q8(decibels) ((decibels)*256)

/* ---- metres in one format and another ---- */

/* Exact. |height| < 2^27 (2^21 m). */
static inline int32_t lm_m_q10_of_m_q6(int32_t height_m_q6)
{
    return height_m_q6 * 16;
}

/* Exact, for any height. */
static inline int64_t lm_m_q8_of_m_q6(int32_t height_m_q6)
{
    return (int64_t)height_m_q6 * 4;
}

/* Cut; any height. */
static inline int32_t lm_m_q6_of_m_q10(int32_t height_m_q10)
{
    return height_m_q10 / 16;
}

/* Cut; any height. */
static inline int32_t lm_m_q8_of_m_q10(int32_t height_m_q10)
{
    return height_m_q10 / 4;
}

/* Exact. |length| < 2^29 (2^21 m). */
static inline int32_t lm_m_q10_of_m_q8(int32_t length_m_q8)
{
    return length_m_q8 * 4;
}

/* Exact, for any height. */
static inline int64_t lm_m_q14_of_m_q10(int32_t height_m_q10)
{
    return (int64_t)height_m_q10 * 16;
}

/* Exact. |length| < 2^59. */
static inline int64_t lm_m_q12_of_m_q8(int64_t length_m_q8)
{
    return length_m_q8 * 16;
}

/* Down. |length| < 2^35. */
static inline int32_t lm_m_q8_of_m_q12(int64_t length_m_q12)
{
    return (int32_t)(length_m_q12 >> 4);
}

/* ---- whole metres ---- */

/* Exact. Below 2^24 m. */
static inline uint32_t lm_m_q8_of_m(uint32_t length_m)
{
    return length_m * 256u;
}

/* Cut; any length. */
static inline uint32_t lm_m_of_m_q8(uint32_t length_m_q8)
{
    return length_m_q8 / 256u;
}

/* Exact. |height| < 2^25 m. */
static inline int32_t lm_m_q6_of_m(int32_t height_m)
{
    return height_m * 64;
}

/* Cut; any height. */
static inline int32_t lm_m_of_m_q6(int32_t height_m_q6)
{
    return height_m_q6 / 64;
}

/* Cut; any height. */
static inline int32_t lm_m_of_m_q10(int32_t height_m_q10)
{
    return height_m_q10 / 1024;
}

/* ---- decimetres, millimetres and less ---- */

/* Cut. |height| < 2^18 dm. */
static inline int32_t lm_m_q14_of_dm(int32_t height_dm)
{
    return height_dm * 8192 / 5;
}

/* Cut; any length. */
static inline int32_t lm_m_q8_of_mm(int32_t length_mm)
{
    return (int32_t)((int64_t)length_mm * 32 / 125);
}

/* Cut; any length, beyond 2^31 mm as well. */
static inline uint32_t lm_m_q8_of_mm_u32(uint32_t length_mm)
{
    return (uint32_t)((uint64_t)length_mm * 32 / 125);
}

/* Nearest; any length. */
static inline uint32_t lm_m_q8_of_mm_nearest(uint32_t length_mm)
{
    return (uint32_t)(((uint64_t)length_mm * 256 + 500) / 1000);
}

/* Cut. |height| < 2^24 mm (16 km). */
static inline int32_t lm_m_q10_of_mm(int32_t height_mm)
{
    return height_mm * 128 / 125;
}

/* Cut; any length. */
static inline int64_t lm_m_q24_of_mm(uint32_t length_mm)
{
    return (int64_t)length_mm * (1 << 24) / 1000;
}

/* Exact. Below 2^22 m. */
static inline uint32_t lm_mm_of_m(uint32_t length_m)
{
    return length_m * 1000u;
}

/* Cut. Below 2^30 (4,194 km). */
static inline uint32_t lm_mm_of_m_q8(uint32_t length_m_q8)
{
    return (uint32_t)((uint64_t)length_m_q8 * 1000 / 256);
}

/* Cut. Below 2^32 (4,194 km). */
static inline uint32_t lm_mm_of_m_q10(uint64_t length_m_q10)
{
    return (uint32_t)(length_m_q10 * 1000 >> 10);
}

/* Exact, for any length. */
static inline int64_t lm_mm_q8_of_mm(uint32_t length_mm)
{
    return (int64_t)length_mm * 256;
}

/* Exact, for any length. */
static inline uint64_t lm_mm_q8_of_m_q8(uint32_t length_m_q8)
{
    return (uint64_t)length_m_q8 * 1000;
}

/* Exact, for any length. */
static inline uint64_t lm_um_of_mm(uint32_t length_mm)
{
    return (uint64_t)length_mm * 1000;
}

/* Cut; 2^-8 m is 15,625 / 4 um. |length| < 2^49. */
static inline int64_t lm_um_of_m_q8(int64_t length_m_q8)
{
    return length_m_q8 * 15625 / 4;
}

/* Cut, and too large by 6.4e-5 of it: a metre / 256 is taken as 3906 um instead of 3906.25. Any
 * length: what is left of mm/s * ms. */
static inline int64_t lm_m_q8_of_um(int64_t length_um)
{
    return length_um / 3906;
}

/* Cut; any length: what is left of mm/s * us. */
static inline int64_t lm_um_of_nm(int64_t length_nm)
{
    return length_nm / 1000;
}

/* Cut. |length| < 2^54. */
static inline int32_t lm_m_q6_of_nm(int64_t length_nm)
{
    return (int32_t)(length_nm / 15625000);
}

/* ---- cells and pixels ---- */

/* Exact. |cells| < 2^23. */
static inline int32_t lm_cells_q8_of_cells(int32_t cells)
{
    return cells * 256;
}

/* Cut. |length| < 2^55, cell_m_q8 > 0. */
static inline int64_t lm_cells_q8_of_m_q8(int64_t length_m_q8, uint32_t cell_m_q8)
{
    return length_m_q8 * 256 / (int64_t)cell_m_q8;
}

/* Nearest. Below 2^31 - 128. */
static inline int32_t lm_cells_of_cells_q8(int32_t place_cells_q8)
{
    return (place_cells_q8 + 128) >> 8;
}

/* Exact. |length| < 2^23. */
static inline int32_t lm_px_q8_of_px(int32_t length_px)
{
    return length_px * 256;
}

/* Nearest. Below 2^31 - 128. */
static inline int32_t lm_px_of_px_q8(int32_t length_px_q8)
{
    return (length_px_q8 + 128) >> 8;
}

/* ---- decibels, angles, times ---- */

/* Exact. |gain| < 2^23. */
static inline int32_t lm_db_q8_of_db(int32_t gain_db)
{
    return gain_db * 256;
}

/* Nearest; any angle: 0..360, both ends of the circle. */
static inline uint32_t lm_deg_of_bam(fx_bam_t angle)
{
    return (uint32_t)(((uint64_t)angle * 360 + (1u << 31)) >> 32);
}

/* Nearest; any angle: -1800..1800 tenths of a degree. */
static inline int32_t lm_deg_tenths_of_bam(int32_t angle)
{
    return (int32_t)(((int64_t)angle * 3600 + (1LL << 31)) >> 32);
}

/* 1e-7 degree in a signed angle, as a word of two's complement; nearest. 2^31 * 3.6e9 is below
 * 2^63. */
static inline uint32_t lm_ten_millionths_of_bam(fx_bam_t angle)
{
    const int64_t product = (int64_t)(int32_t)angle * 3600000000LL;
    return (uint32_t)(int32_t)((product + (1LL << 31)) >> 32);
}

/* The other way; nearest, any word. 3.6e9 is 2^10 * 3515625, and 2^31 * 2^22 is 2^53. */
static inline fx_bam_t lm_bam_of_ten_millionths(uint32_t word)
{
    const int64_t product = (int64_t)(int32_t)word * (1LL << 22);
    return (fx_bam_t)((product + (product < 0 ? -1757812 : 1757812)) / 3515625);
}

/* Exact, for any time. */
static inline uint64_t lm_us_of_ms(uint32_t time_ms)
{
    return (uint64_t)time_ms * 1000;
}

/* Cut; any time. */
static inline uint64_t lm_ms_of_us(uint64_t time_us)
{
    return time_us / 1000;
}

#endif
