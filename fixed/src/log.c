#include "fx/log.h"

/* log2 of n = 2^31..2^32 - 1, taken as 1..2, by chords between entries of the table.
 *
 * A chord lies below the curve by at most (1/256)^2 / 8 / ln 2 = 2.8e-6. Half of that is added with
 * the rounding: 0.59 lsb in total. A power of two is entry 0, which is zero, and 0.59 lsb is
 * less than one. Hence powers of two are exact. */
static int32_t log2_of_mantissa(uint32_t n)
{
    const uint32_t half_and_bias_q31 = 16384 + 2956;
    const uint32_t i = n >> 23 & 255u;
    const uint64_t part_q23 = n & 0x7fffffu;
    const uint32_t low_q31 = fx_table_log2_q31[i];
    const uint64_t rise_q31 = fx_table_log2_q31[i + 1] - low_q31; /* < 2^24 */
    const uint32_t chord_q31 = low_q31 + (uint32_t)(rise_q31 * part_q23 >> 23);
    return (int32_t)((chord_q31 + half_and_bias_q31) >> 15);
}

int32_t fx_log2_q16(uint32_t x)
{
    return fx_log2_q16_u64(x);
}

int32_t fx_log2_q16_u64(uint64_t x)
{
    if (x == 0) {
        return -65536;
    }
    const int zeros = fx_clz64(x);
    return (63 - zeros) * 65536 + log2_of_mantissa((uint32_t)(x << zeros >> 32));
}

/* 2^(whole + part) in Q16, rounded to nearest.
 *
 * The table gives 2^(i/256). The rest of the part, y = 0..ln 2 / 256, gives the factor
 * e^y = 1 + y + y^2/2, which is low by at most y^3/6 = 3.3e-9. */
static uint32_t exp2_q16(int64_t whole, uint32_t part_q32)
{
    if (whole >= 16) {
        return UINT32_MAX;
    }
    if (whole < -17) {
        return 0;
    }
    const uint64_t y_q32 = (part_q32 & 0xffffffu) * 2977044472ull >> 32; /* ln 2; < 2^23.5 */
    const uint64_t expm1_q32 = y_q32 + (y_q32 * y_q32 >> 33);
    const uint64_t entry_q31 = fx_table_exp2_q31[part_q32 >> 24]; /* < 2^32 */
    const uint64_t power_q31 = entry_q31 + (entry_q31 * expm1_q32 >> 32);
    const int drop = 15 - (int)whole; /* 0..32 */
    return (uint32_t)((power_q31 + (1ull << drop >> 1)) >> drop);
}

uint32_t fx_exp2_q16(int32_t x_q16)
{
    return exp2_q16(x_q16 >> 16, (uint32_t)x_q16 << 16);
}

uint32_t fx_power_q16_from_db_q8(int32_t db_q8)
{
    /* The factor is log2(10) / 10 / 256 in Q40. The product stays below 2^31 * 2^30.5. */
    const int64_t log2_q32 = db_q8 * 1426757253ll >> 8;
    return exp2_q16(log2_q32 >> 32, (uint32_t)log2_q32);
}
