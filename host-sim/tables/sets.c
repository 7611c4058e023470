#include "fx/hash.h"
#include "lm/grain.h"
#include "lm/grown.h"
#include "lm/noise.h"
#include "tables/tables.h"

#include <math.h>
#include <stddef.h>
#include <stdlib.h>

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

/* The straight line that comes nearest to `count` entries from `first` on, as machines want it that
 * look up 16 bytes or 64 at once: entry i is base + i slope. It rises or falls by whole numbers, as
 * from its first entry to its last, and is as far above as below them. Rows: the two bytes of the
 * base modulo 2^16, the slope. */
static int64_t line_through(int row, int first, const long double *want, int count)
{
    long double most = -1e9L, least = 1e9L;
    const int64_t slope = llroundl((want[count - 1] - want[0]) / (count - 1));
    for (int k = 0; k < count; k++) {
        const long double base = want[k] - (long double)(slope * (first + k));
        most = base > most ? base : most;
        least = base < least ? base : least;
    }
    const int64_t base = llroundl((most + least) / 2);
    return row == 0 ? base & 255 : row == 1 ? base >> 8 & 255 : slope;
}

/* Lines through the decibels of 1 + (m + 0.5) / 256, and the half of Q8 for rounding, in Q13: line
 * n of m = 16 n .. 16 n + 15. */
static int64_t decibel_line(int row, int n)
{
    long double want_q13[16];
    for (int k = 0; k < 16; k++) {
        const long double m = 16 * n + k;
        const long double middle = sqrtl((1 + m / 256) * (1 + (m + 1) / 256));
        want_q13[k] = (10 * log10l(middle) + 1 / 512.0L) * 8192;
    }
    return line_through(row, 16 * n, want_q13, 16);
}

/* Decibels of i .. i + 1 by these lines. No power at all is far below one. */
static int64_t decibel_steps(int row, int i)
{
    (void)row;
    int octave = 0;
    while (i >> octave > 1) {
        octave++;
    }
    const int mantissa = ((i << 12 >> octave) & 4095) >> 4, n = mantissa / 16;
    const int64_t base = decibel_line(0, n) + decibel_line(1, n) * 256;
    return i == 0 ? -144 * 8192 : octave * 24660 + base + mantissa * decibel_line(2, n);
}

/* Lines through 2^(m / 256) in Q15, and the whole octave by them; a little higher, for the first
 * entry to be 1. */
static int64_t power_line(int row, int n)
{
    long double want_q15[16];
    for (int k = 0; k < 16; k++) {
        want_q15[k] = ldexpl(exp2l((16 * n + k) / 256.0L), 15) + 5;
    }
    return line_through(row, 16 * n, want_q15, 16);
}

static int64_t power(int row, int i)
{
    (void)row;
    const int n = i / 16;
    return (power_line(0, n) + power_line(1, n) * 256 + i * power_line(2, n)) * 65536;
}

/* Lines through what a power adds to another one that is (i + 0.5) / 16 dB above it, and the half
 * of Q8 for rounding, in Q13: line n of i = 8 n .. 8 n + 7, to be told by the lower byte of i. All
 * fall, and say by how much. */
static int64_t decibel_sum_line(int row, int n)
{
    long double want_q13[8];
    for (int k = 0; k < 8; k++) {
        const long double below_db = (8 * n + k + 0.5L) / 16;
        want_q13[k] = (10 * log10l(1 + powl(10, -below_db / 10)) + 1 / 512.0L) * 8192;
    }
    const int64_t entry = line_through(row, 8 * n % 256, want_q13, 8);
    return row == 2 ? -entry : entry;
}

static int64_t decibel_sum(int row, int i)
{
    (void)row;
    const int n = i / 8;
    const int64_t base = decibel_sum_line(0, n) + decibel_sum_line(1, n) * 256;
    return ((base - i % 256 * decibel_sum_line(2, n)) & 65535) >> 5;
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
    {"fx_table_db_lines", "uint8_t",
     "lines through the decibels of 1 + (m + 0.5) / 256: base, base, slope", 3, 16, decibel_line},
    {"fx_table_db_steps_q13", "int32_t", "decibels of i + 0.5 by these lines", 0, 4096,
     decibel_steps},
    {"fx_table_power_lines", "uint8_t", "lines through 2^(m / 256): base, base, slope", 3, 16,
     power_line},
    {"fx_table_power_q31", "uint32_t", "2^(i / 256) by these lines", 0, 256, power},
    {"fx_table_db_sum_lines", "uint8_t",
     "lines through what a power i / 16 dB below another adds to it: base, base, fall", 3, 64,
     decibel_sum_line},
    {"fx_table_db_sum_q8", "int32_t", "decibels of i + 0.5 by these lines", 0, 512, decibel_sum},
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
static int64_t slice_mean(int looks_log2, int n)
{
    const int looks = 1 << looks_log2;
    const long double slices = 1024;
    const long double from = n == 0 ? 0 : gamma_below(looks + 1, gamma_quantile(looks, n / slices));
    const long double to =
        n == 1023 ? 1 : gamma_below(looks + 1, gamma_quantile(looks, (n + 1) / slices));
    return rounded(10 * log10l(slices * (to - from)), 8);
}

/* Shuffled, and the first ones once more. */
static int64_t noise(int looks_log2, int entry)
{
    return slice_mean(looks_log2, (int)lm_noise_slice((uint32_t)entry));
}

static const struct table noise_tables[] = {
    {"lm_noise_db_q8", "int16_t",
     "dB of the mean of slice lm_noise_slice(i) of 1024 of a Gamma(2^row) variable",
     LM_NOISE_LOOKS_LOG2_MAX + 1, LM_NOISE_SLICES + LM_NOISE_BLOCK, noise},
};

/* ---- grain ---- */

enum { GRAIN = LM_GRAIN_ROWS * LM_GRAIN_COLUMNS };

/* A white number that is nearly Gaussian: eight uniform ones of 16 bits, their mean taken off. Row
 * and column may be any; the field begins again as lm/grain.h says. */
static int64_t white(int row, int column)
{
    const int turns = row >= 0 ? row / LM_GRAIN_ROWS : -1;
    const uint32_t r = (uint32_t)(row - turns * LM_GRAIN_ROWS);
    const uint32_t c = (uint32_t)(column + turns * LM_GRAIN_TWIST) % LM_GRAIN_COLUMNS;
    int64_t sum = -4 * 65535;
    for (uint32_t k = 0; k < 4; k++) {
        const uint32_t hash = fx_hash3(r, c, k);
        sum += (hash & 0xffff) + (hash >> 16);
    }
    return sum;
}

/* White numbers averaged over their neighbours both ways. The weights are those of the root of a
 * spectrum whose correlation is 0.31 one cell away and 0.003 two away, of numbers that become
 * 0.30 of powers. Whole numbers, so that every machine ranks the sums alike. */
static int64_t smoothed(int row, int column)
{
    static const int64_t weight[4] = {974, 161, -12, 2};
    int64_t sum = 0;
    for (int down = -3; down <= 3; down++) {
        for (int along = -3; along <= 3; along++) {
            sum += weight[abs(down)] * weight[abs(along)] * white(row + down, column + along);
        }
    }
    return sum;
}

struct ranked {
    int64_t value;
    int place;
};

static int compare_ranked(const void *a, const void *b)
{
    const struct ranked *x = a, *y = b;
    return x->value != y->value ? (x->value > y->value) - (x->value < y->value)
                                : x->place - y->place;
}

static long double gaussian_below(long double z)
{
    return erfcl(-z / sqrtl(2)) / 2;
}

/* The field by ranks: of the lowest number comes the value that as many of a Gaussian distribution
 * are below. */
static int64_t grain(int row, int column)
{
    static struct ranked ranked[GRAIN];
    static int8_t field[GRAIN];
    static int is_made;
    if (!is_made) {
        for (int i = 0; i < GRAIN; i++) {
            ranked[i] = (struct ranked){smoothed(i / LM_GRAIN_COLUMNS, i % LM_GRAIN_COLUMNS), i};
        }
        qsort(ranked, GRAIN, sizeof *ranked, compare_ranked);
        int code = -128;
        for (int i = 0; i < GRAIN; i++) {
            const long double share = (i + 0.5L) / GRAIN;
            while (code < 127 && gaussian_below((code + 0.5L) / 32) < share) {
                code++;
            }
            field[ranked[i].place] = (int8_t)code;
        }
        is_made = 1;
    }
    return field[row * LM_GRAIN_COLUMNS + column];
}

/* The regularised lower incomplete gamma function P(a, x) by its series, all of whose terms are
 * positive (DLMF 8.11.4). */
static long double gamma_share(long double a, long double x)
{
    long double term = expl(a * logl(x) - x - lgammal(a + 1)), sum = term;
    for (int n = 1; n < 2000 && term > sum * 1e-22L; n++) {
        term *= x / (a + n);
        sum += term;
    }
    return sum;
}

static int64_t grain_knot(int row, int knot)
{
    const long double looks = exp2l(row / 8.0L), share = gaussian_below(knot / 2.0L - 4);
    long double low = 0, high = 400;
    for (int i = 0; i < 200; i++) {
        const long double middle = (low + high) / 2;
        *(gamma_share(looks, middle) < share ? &low : &high) = middle;
    }
    return rounded(10 * log10l(low / looks), 8);
}

/* Neighbours correlate by 0.31, so that the variance of a sum of weights p and q is
 * p2 + q2 + 0.62 p q. */
static int64_t grain_weight(int row, int way)
{
    (void)row;
    const long double q = (long double)way / LM_GRAIN_WAY, p = 1 - q;
    return rounded(q / sqrtl(p * p + q * q + 0.62L * p * q), 7);
}

static const struct table grain_tables[] = {
    {"lm_grain_weight_q7", "uint8_t",
     "weight of the second of two numbers, i / 64 of the way to it", 0, LM_GRAIN_WAY + 1,
     grain_weight},
    {"lm_grain_q5", "int8_t", "correlated Gaussian numbers, 1/32 of a standard deviation",
     LM_GRAIN_ROWS, LM_GRAIN_COLUMNS, grain},
    {"lm_grain_knot_db_q8", "int16_t",
     "dB of a Gamma(2^(row / 8)) variable as probable as a Gaussian one of i / 2 - 4",
     LM_GRAIN_LOOKS_ROWS, LM_GRAIN_LINES + 1, grain_knot},
};

/* The Taylor weighting of 35 dB and nbar = 4 over an aperture, w(p) = 1 + 2 sum of F_m cos(2 pi m
 * p), whose response to a point is sinc(x) + sum of F_m (sinc(x - m) + sinc(x + m)) in cells x. (T.
 * T. Taylor, "Design of line-source antennas for narrow beamwidth and low side lobes", IRE Trans.
 * AP-3, 1955; F_m as in Carrara, Goodman, Majewski, "Spotlight Synthetic Aperture Radar", app. D.)
 */
enum { NBAR = 4, RESPONSE_STEPS = 16, RESPONSE_CELLS = 8 };

static long double taylor_coefficient(int m)
{
    const long double a = acoshl(powl(10, 35 / 20.0L)) / PI;
    const long double scale2 = NBAR * NBAR / (a * a + (NBAR - 0.5L) * (NBAR - 0.5L));
    long double product = m % 2 == 0 ? -0.5L : 0.5L;
    for (int n = 1; n < NBAR; n++) {
        product *= 1 - m * m / (scale2 * (a * a + (n - 0.5L) * (n - 0.5L)));
        product /= n == m ? 1 : 1 - (long double)(m * m) / (n * n);
    }
    return product;
}

static long double sinc(long double x)
{
    return x == 0 ? 1 : sinl(PI * x) / (PI * x);
}

/* The response, its power adding up to one over all cells. */
static long double response_at(long double x)
{
    long double sum = sinc(x), energy = 1;
    for (int m = 1; m < NBAR; m++) {
        const long double f = taylor_coefficient(m);
        sum += f * (sinc(x - m) + sinc(x + m));
        energy += 2 * f * f;
    }
    return sum / sqrtl(energy);
}

static int64_t response(int row, int i)
{
    (void)row;
    return rounded(response_at((long double)i / RESPONSE_STEPS), 15);
}

/* The largest response from `cell` on, in decibels, rounded up. */
static int64_t response_envelope(int row, int cell)
{
    const int finer = 1000;
    long double most = fabsl(response_at(cell));
    (void)row;
    for (int i = cell * finer + 1; i <= 20 * finer; i++) {
        most = fmaxl(most, fabsl(response_at((long double)i / finer)));
    }
    return (int64_t)ceill(20 * log10l(most) * 256);
}

static const struct table response_tables[] = {
    {"lm_response_q15", "int16_t", "amplitude of the response to a point, i / 16 cells away", 0,
     RESPONSE_CELLS *RESPONSE_STEPS + 2, response},
    {"lm_response_envelope_db_q8", "int16_t", "dB of its largest power from i cells away on", 0,
     RESPONSE_CELLS + 1, response_envelope},
};

/* What has grown: a pattern that repeats itself, in steps of 0.6 m, of which a texel has two.
 * Numbers that look drawn are hashes, so that every machine makes the same. */
enum { GROWN = 128, WAVES_ACROSS = 16, TREES_ACROSS = 11, TREES_ALONG = 10 };

/* 0..1, by three numbers. */
static long double drawn(int a, int b, int c)
{
    return fx_hash3((uint32_t)a, (uint32_t)b, (uint32_t)c) / 4294967296.0L;
}

/* Bends of borders: waves of all directions, 76 m / k long, k = 3..16, the longer the stronger, so
 * that a border has bays and in them smaller ones. */
struct wave {
    long double strength, phase;
    int p, q;
};

static int set_waves(struct wave *waves)
{
    int count = 0;
    for (int p = 0; p <= WAVES_ACROSS; p++) {
        for (int q = -WAVES_ACROSS; q <= WAVES_ACROSS; q++) {
            const long double k = hypotl(p, q);
            if (k >= 3 && k <= WAVES_ACROSS && (p > 0 || q > 0)) {
                waves[count++] = (struct wave){powl(k, -1.2L), drawn(p, q, 1), p, q};
            }
        }
    }
    return count;
}

static long double bend_at(int row, int column)
{
    static struct wave waves[(WAVES_ACROSS + 1) * (2 * WAVES_ACROSS + 1)];
    static int count;
    long double sum = 0;
    count = count > 0 ? count : set_waves(waves);
    for (int i = 0; i < count; i++) {
        const struct wave *w = &waves[i];
        const long double turn = (long double)(w->p * row + w->q * column) / GROWN + w->phase;
        sum += cosl(2 * PI * turn) * w->strength;
    }
    return sum;
}

/* Distance on a ring of GROWN steps. */
static long double around(long double x)
{
    return x - GROWN * floorl(x / GROWN + 0.5L);
}

/* Height of the crown of tree (i, j) at (row, column), as a share of the canopy's, or 0: a
 * dome 5 to 8 m wide. One tree in twelve is missing. A step is 3/4 as wide as high: the cosine of
 * a middle latitude. */
static long double crown_at(int i, int j, int row, int column)
{
    const int n = (j % TREES_ALONG + TREES_ALONG) % TREES_ALONG;
    const int m = (i % TREES_ACROSS + TREES_ACROSS) % TREES_ACROSS;
    const long double pitch_row = (long double)GROWN / TREES_ACROSS,
                      pitch_column = (long double)GROWN / TREES_ALONG;
    const long double north = (m + 0.5L + 0.7L * (drawn(m, n, 2) - 0.5L)) * pitch_row;
    const long double east = (n + (m % 2) * 0.5L + 0.7L * (drawn(m, n, 3) - 0.5L)) * pitch_column;
    const long double radius = 4.6L + 2.6L * drawn(m, n, 4), top = 0.96L + 0.16L * drawn(m, n, 5);
    const long double away = hypotl(around(row - north), 0.75L * around(column - east)) / radius;
    return away >= 1 || drawn(m, n, 6) < 1 / 12.0L ? 0 : top * (1 - 0.16L * away * away);
}

enum { CROWN_MEAN_PERMILLE = 923 }; /* of all places, before they are made 1 */

static long double canopy_at(int row, int column)
{
    const int i = row * TREES_ACROSS / GROWN, j = column * TREES_ALONG / GROWN;
    long double top = 0.8L; /* what grows in the gaps */
    for (int di = -2; di <= 2; di++) {
        for (int dj = -2; dj <= 2; dj++) {
            top = fmaxl(top, crown_at(i + di, j + dj, row, column));
        }
    }
    return top * 1000 / CROWN_MEAN_PERMILLE;
}

/* The first row and column are repeated behind the last: four texels are read at a time. */
static int64_t grown(int row, int i)
{
    (void)row;
    const int r = 2 * (i / LM_K_GROWN_STRIDE) % GROWN, c = 2 * (i % LM_K_GROWN_STRIDE) % GROWN;
    const int64_t bend = llroundl(fminl(fmaxl(60 * bend_at(r, c), -127), 127));
    const int64_t crown = 128 + llroundl(256 * (canopy_at(r, c) - 1));
    return (bend & 255) | crown << 8;
}

static const struct table grown_tables[] = {
    {"lm_grown", "uint16_t", "bend of borders, and crowns of trees times 256", 0, LM_K_GROWN_WORDS,
     grown},
};

#define COUNT(array) ((int)(sizeof(array) / sizeof((array)[0])))

const struct table_set table_sets[] = {
    {"fixed", "fixed/src/tables.c", "fx/tables.h", fixed_tables, COUNT(fixed_tables)},
    {"grain", "firmware/clutter/grain_table.c", "lm/grain.h", grain_tables, COUNT(grain_tables)},
    {"noise", "firmware/clutter/noise_table.c", "lm/noise.h", noise_tables, COUNT(noise_tables)},
    {"response", "firmware/clutter/response_table.c", "lm/response.h", response_tables,
     COUNT(response_tables)},
    {"grown", "firmware/map/grown_table.c", "lm/grown.h", grown_tables, COUNT(grown_tables)},
};
const int table_set_count = COUNT(table_sets);
