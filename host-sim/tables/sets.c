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

/* The same over i * 2^21 .. (i + 1) * 2^21. No power at all is far below one: the three shifts that
 * it goes through, by 28 bits, make -150 dB of it. */
static int64_t decibel_steps(int row, int i)
{
    (void)row;
    const long double middle = sqrtl((long double)i * (i + 1)) * 2097152;
    return i == 0 ? -66 * 16384 : rounded(10 * log10l(middle) + 1 / 512.0L, 14);
}

static int64_t decibel_sum(int row, int i)
{
    (void)row;
    return rounded(10 * log10l(1 + powl(10, -(i + 0.5L) / 160)), 8);
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
    {"fx_table_db_steps_q14", "int32_t", "decibels of (i + 0.5) * 2^21, and 1/512 dB more", 0, 2048,
     decibel_steps},
    {"fx_table_db_sum_q8", "int32_t",
     "decibels that a power (i + 0.5) / 16 dB below another adds to it", 0, 512, decibel_sum},
    {"fx_table_crc32c", "uint32_t", "CRC-32C of byte i and the row's number of zero bytes", 4, 256,
     crc32c},
};

/* The regularised lower incomplete gamma function P(k, x) of a whole k: 1 - e^-x (1 + x + .. +
 * x^(k-1) / (k-1)!). */
static long double gamma_below(int k, long double x)
{
    long double term = expl(-x), sum = term;
    for (int j = 1; j < k; j++) {
        term *= x / j;
        sum += term;
    }
    return 1 - sum;
}

/* Where P(k, x) reaches p, by halving an interval that surely holds it. */
static long double gamma_quantile(int k, long double p)
{
    long double low = 0, high = 200;
    for (int i = 0; i < 200; i++) {
        const long double middle = (low + high) / 2;
        *(gamma_below(k, middle) < p ? &low : &high) = middle;
    }
    return low;
}

/* Mean of the n-th of 1024 equally likely slices of a Gamma(L) variable of mean 1: x times the
 * density of Gamma(L) is the density of Gamma(L + 1), so that the mean is a difference of its
 * distribution function. */
static int64_t speckle(int looks_log2, int n)
{
    const int looks = 1 << looks_log2;
    const long double slices = 1024;
    const long double from = n == 0 ? 0 : gamma_below(looks + 1, gamma_quantile(looks, n / slices));
    const long double to =
        n == 1023 ? 1 : gamma_below(looks + 1, gamma_quantile(looks, (n + 1) / slices));
    return rounded(10 * log10l(slices * (to - from)), 8);
}

static const struct table speckle_tables[] = {
    {"lm_speckle_q8", "int32_t", "dB of the mean of slice i of 1024 of Gamma(2^row) speckle", 5,
     1024, speckle},
};

#define COUNT(array) ((int)(sizeof(array) / sizeof((array)[0])))

const struct table_set table_sets[] = {
    {"fixed", "fixed/src/tables.c", "fx/tables.h", fixed_tables, COUNT(fixed_tables)},
    {"speckle", "firmware/src/speckle_table.c", "lm/speckle.h", speckle_tables,
     COUNT(speckle_tables)},
};
const int table_set_count = COUNT(table_sets);
