#include "tables.h"

#include <math.h>
#include <stddef.h>

static const long double PI = 3.141592653589793238462643383279502884L;

/* Entries are rounded from long double, so that the last bit does not hang on the C library. */
static int64_t rounded(long double value, int frac_bits)
{
    return llroundl(ldexpl(value, frac_bits));
}

static int64_t sine(int row, int i)
{
    (void)row;
    return rounded(sinl((long double)i / 256 * PI / 2), 31);
}

static int64_t atan_angle(int row, int i)
{
    (void)row;
    return rounded(atanl((long double)i / 256) / (2 * PI), 32 + 2);
}

static int64_t atan_slope(int row, int i)
{
    (void)row;
    const long double x = (long double)i / 256;
    return rounded(1 / (1 + x * x), 31);
}

static int64_t reciprocal(int row, int i)
{
    (void)row;
    return rounded(1 / (1 + (i + 0.5L) / 256), 16);
}

static int64_t inverse_root(int row, int i)
{
    (void)row;
    return rounded(1 / sqrtl((i + 64.5L) / 256), 15);
}

static int64_t log_2(int row, int i)
{
    (void)row;
    return rounded(log2l(1 + (long double)i / 256), 31);
}

static int64_t exp_2(int row, int i)
{
    (void)row;
    return rounded(exp2l((long double)i / 256), 31);
}

/* The middle of the decibels at both ends of the cell, plus the half (1/512 dB) that turns the
 * shift from Q14 to Q8 into rounding. */
static int64_t decibel(int row, int i)
{
    (void)row;
    const long double middle = sqrtl((1 + i / 256.0L) * (1 + (i + 1) / 256.0L));
    return rounded(10 * log10l(middle) + 1 / 512.0L, 14);
}

/* The byte, then `zeros` zero bytes, shifted through the reflected polynomial. */
static int64_t crc32c(int zeros, int byte)
{
    uint32_t c = (uint32_t)byte;
    for (int bit = 0; bit < 8 * (1 + zeros); bit++) {
        c = c >> 1 ^ ((c & 1u) != 0 ? 0x82f63b78u : 0u);
    }
    return c;
}

static const struct table fixed_tables[] = {
    {"fx_table_sin_q31", "uint32_t", "sin(i / 256 * 90 degrees)", 0, 258, sine},
    {"fx_table_atan_bam_q2", "uint32_t", "atan(i / 256), 2^34 a circle", 0, 257, atan_angle},
    {"fx_table_atan_slope_q31", "uint32_t", "1 / (1 + (i / 256)^2)", 0, 257, atan_slope},
    {"fx_table_recip_q16", "uint16_t", "1 / (1 + (i + 0.5) / 256)", 0, 256, reciprocal},
    {"fx_table_rsqrt_q15", "uint16_t", "1 / sqrt((i + 64.5) / 256)", 0, 192, inverse_root},
    {"fx_table_log2_q31", "uint32_t", "log2(1 + i / 256)", 0, 257, log_2},
    {"fx_table_exp2_q31", "uint32_t", "2^(i / 256)", 0, 256, exp_2},
    {"fx_table_db_q14", "uint16_t", "decibels of 1 + (i + 0.5) / 256, and 1/512 dB more", 0, 256,
     decibel},
    {"fx_table_crc32c", "uint32_t", "CRC-32C of byte i and the row's number of zero bytes", 4, 256,
     crc32c},
};

#define COUNT(array) ((int)(sizeof(array) / sizeof((array)[0])))

const struct table_set table_sets[] = {
    {"fixed", "fixed/src/tables.c", "fx/tables.h", fixed_tables, COUNT(fixed_tables)},
};
const int table_set_count = COUNT(table_sets);
