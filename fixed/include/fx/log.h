/* Logarithms and powers: base 2 in Q16, decibels in Q8.
 *
 *     power -> dB                    fx_db_q8, fx_db_q8_u64; fx_db_q8_vec, fx_db_q8_vec_i32
 *     dB -> power                    fx_power_q16_from_db_q8; fx_power_q24_vec, fx_power_q32_vec
 *     sum of two powers, all in dB   fx_db_q8_sum_vec
 *     base 2                         fx_log2_q16, fx_log2_q16_u64, fx_exp2_q16
 *     base 2 -> dB                   fx_db_q8_of_log2_q16
 *
 * Functions that end in _vec are for loops over many numbers. They neither branch nor count zeros,
 * so that a compiler can make vectors of the loop. They are a little less exact than the others.
 *
 * Decibels of a power in Q(n) are those of the integer, less those of 2^n: fx_db_q8(1 << n). */
#ifndef FX_LOG_H
#define FX_LOG_H

#include "fx/bits.h"
#include "fx/const.h"
#include "fx/tables.h"

#include <stdint.h>

/* log2(x), 0..32 * 65536. 0 counts as one half: -65536, below every other result. Exact for powers
 * of two. Worst error: 0.60 lsb. Cost: 24 instructions. */
int32_t fx_log2_q16(uint32_t x);

/* log2(x) of 64 bits, 0..64 * 65536. Zero, error and cost are those of fx_log2_q16. */
int32_t fx_log2_q16_u64(uint64_t x);

/* 2^x. UINT32_MAX from x = 16.0 up. 0 below -17.0, where the result rounds to 0.
 * Worst error: 0.5 lsb plus 4e-9 of the result. Cost: 30 instructions. */
uint32_t fx_exp2_q16(int32_t x_q16);

/* Decibels of a power: 10 * log10(power), 2..24659. Power 0 counts as one half: -768.
 * Worst error: 0.0108 dB, most of it from a mantissa of 8 bits.
 * Cost: 7 instructions in a loop, one of them a load, and 5 before the loop. */
static inline int32_t fx_db_q8(uint32_t power)
{
    /* The law is dB = octaves * 10 log10(2) + dB of the mantissa. The table holds dB in Q14 with
     * the half for rounding added. The largest sum, 31 * 49321 + 49321 + 32, fits 21 bits. If power
     * is 0, the shift is by 0 (32 modulo 32) and the mantissa is 0. */
    const int zeros = fx_clz32(power);
    const uint32_t mantissa = power << ((uint32_t)zeros & 31u);
    return ((31 - zeros) * FX_DB_PER_OCTAVE_Q14 + fx_table_db_q14[mantissa >> 23 & 255u]) >> 6;
}

/* Decibels of a power of 64 bits: 2..49319. Power 0 counts as one half: -768.
 * Worst error: 0.012 dB. */
static inline int32_t fx_db_q8_u64(uint64_t power)
{
    const int zeros = fx_clz64(power);
    const uint64_t mantissa = power << ((uint32_t)zeros & 63u);
    return ((63 - zeros) * FX_DB_PER_OCTAVE_Q14 + fx_table_db_q14[mantissa >> 55 & 255u]) >> 6;
}

/* Leading zeros rounded down to a multiple of four: 0..28. 28 for x = 0. Part of fx_db_q8_vec. */
static inline uint32_t fx_leading_nibbles_vec(uint32_t x)
{
    const uint32_t by_16 = x >> 16 == 0 ? 16 : 0, x_16 = x << by_16;
    const uint32_t by_8 = x_16 >> 24 == 0 ? 8 : 0, x_8 = x_16 << by_8;
    return by_16 + by_8 + (x_8 >> 28 == 0 ? 4 : 0);
}

/* Decibels of a power, for loops. -43029 for power 0. Worst error: 0.015 dB.
 * Most vector machines cannot count zeros. This needs shifts and one look-up alone. */
static inline int32_t fx_db_q8_vec(uint32_t power)
{
    /* The power is shifted up to 2^28..2^32. Its top 12 bits then hold a mantissa of at least 8. */
    const uint32_t octaves = fx_leading_nibbles_vec(power);
    const int32_t mantissa = (int32_t)(power << octaves >> 20);
    return (fx_table_db_steps_q13[mantissa] + (20 - (int32_t)octaves) * FX_DB_PER_OCTAVE_Q13) >> 5;
}

/* Decibels of a power below 2^31, for loops. -43800 for power 0. Worst error: that of fx_db_q8_vec.
 * Cost: three quarters of fx_db_q8_vec, because vectors compare signed numbers in one instruction.
 */
static inline int32_t fx_db_q8_vec_i32(int32_t power)
{
    /* The power is shifted up to 2^15..2^31, then to 2^23..2^31, then down to 2^8..2^12. */
    const int32_t by_16 = power < 1 << 15 ? 16 : 0, p_16 = power << by_16;
    const int32_t by_8 = p_16 < 1 << 23 ? 8 : 0, p_8 = p_16 << by_8;
    const int32_t down = p_8 < 1 << 27 ? 15 : 19;
    return (fx_table_db_steps_q13[p_8 >> down] + (down - by_16 - by_8) * FX_DB_PER_OCTAVE_Q13) >> 5;
}

/* Power of decibels in Q24, 10^(dB / 10), for loops; |db_q8| < 2^17. Up to -72.25 dB it is 1, the
 * smallest result. From 24.08 dB up it saturates just below 2^32.
 * Worst error: 0.012 dB where the result has more than 9 bits. */
static inline uint32_t fx_power_q24_vec(int32_t db_q8)
{
    /* The law is 2^(dB log2(10) / 10). Octaves count from 2^-24, in Q8. The product stays below
     * 2^31. */
    const int32_t octaves_q8 = ((db_q8 * FX_OCTAVES_PER_DB_Q15 + 16384) >> 15) + (24 << 8);
    const int32_t low_q8 = octaves_q8 < 0 ? 0 : octaves_q8;
    const int32_t t_q8 = low_q8 > (32 << 8) - 1 ? (32 << 8) - 1 : low_q8;
    return fx_table_power_q31[t_q8 & 255] >> (31 - (t_q8 >> 8));
}

/* Power of decibels in Q32 of 64 bits, 10^(dB / 10), for loops; |db_q8| < 2^16. Up to -96.3 dB it
 * is 1. From 93.3 dB up it is 2^63 or more, and from 96.3 dB up it saturates just below 2^64.
 * Worst error: 0.014 dB where the result has more than 9 bits. */
static inline uint64_t fx_power_q32_vec(int32_t db_q8)
{
    /* Octaves count from 2^-32, in Q16. The product stays below 2^31. */
    const int32_t octaves_q16 = (db_q8 * FX_OCTAVES_PER_DB_Q16 >> 8) + (32 << 16) + 128;
    const int32_t low_q16 = octaves_q16 < 0 ? 0 : octaves_q16;
    const uint32_t t_q16 = (uint32_t)(low_q16 > (64 << 16) - 1 ? (64 << 16) - 1 : low_q16);
    return (uint64_t)fx_table_exp2_q31[t_q16 >> 8 & 255u] << 32 >> (63 - (t_q16 >> 16));
}

/* Decibels of the sum of two powers that are given in decibels, for loops; |a - b| < 2^31. From
 * 32 dB apart on, the result is the larger one plus 1/256 dB. Worst error: 0.018 dB. */
static inline int32_t fx_db_q8_sum_vec(int32_t a_q8, int32_t b_q8)
{
    const int32_t high_q8 = a_q8 > b_q8 ? a_q8 : b_q8, low_q8 = a_q8 > b_q8 ? b_q8 : a_q8;
    const int32_t step = (high_q8 - low_q8) >> 4;
    return high_q8 + fx_table_db_sum_q8[step < 511 ? step : 511];
}

/* Power of decibels in Q16, 10^(dB / 10). UINT32_MAX from 12331 (48.168 dB) up. 0 below -13100
 * (-51.17 dB). Worst error: 0.5 lsb plus 4e-9 of the result. Cost: 35 instructions. */
uint32_t fx_power_q16_from_db_q8(int32_t db_q8);

/* Decibels of a power whose binary logarithm is given; |log2_q16| < 2^25. */
static inline int32_t fx_db_q8_of_log2_q16(int32_t log2_q16)
{
    /* From Q16 and Q24 to Q8. The product stays below 2^51. */
    return (int32_t)(((int64_t)log2_q16 * FX_DB_PER_OCTAVE_Q24 + ((int64_t)1 << 31)) >> 32);
}

#endif
