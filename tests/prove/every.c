/* Arithmetic of fixed/ that has one argument of 32 bits: every argument is tried.
 *
 *     every [STRIDE]      each argument, or each STRIDE-th; an even stride counts as one more
 *
 * Where a solver gives up on products of long numbers, trying all is a proof, too. The sources are
 * compiled in here under the sanitizer, which ends the program at an overflow, a wide shift or an
 * index outside a table. Told: the worst error against the C library, in units of the last place.
 *
 * Square roots have 64 bits: both sides of the square of every root are tried. */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include "fixed/src/log.c"
#include "fixed/src/recip.c"
#include "fixed/src/root.c"
#include "fixed/src/trig.c"

static const double pi = 3.14159265358979323846;
static uint64_t stride = 1;

/* The arguments from 0 on; `x` is the present one. */
#define EACH(x, end) for (uint64_t x = 0; x < (end); x += stride)

static int failures;

/* As tests are told; an error of 0 is none. */
static void tell(const char *what, bool is_so, double worst, const char *unit)
{
    static int number;
    printf("%sok %d - %s, of every argument", is_so ? "" : "not ", ++number, what);
    if (worst > 0) {
        printf(": worst error %.3f of %s", worst, unit);
    }
    printf("\n");
    fflush(stdout);
    failures += !is_so;
}

/* The C library is slow: errors are those of every 16th argument tried. */
static bool is_measured(uint64_t x)
{
    return x / stride % 16 == 0;
}

static double worse(double worst, double error)
{
    return fabs(error) > worst ? fabs(error) : worst;
}

/* Each angle of the first quadrant with its three mirror images, which are all angles; `one` is the
 * sine of 90 degrees. */
static void sine(const char *what, int32_t (*sine_of)(fx_bam_t), int32_t one, double most,
                 const char *unit)
{
    bool is_so = true;
    double worst = 0;
    EACH(x, FX_BAM_90 + 1ull)
    {
        const fx_bam_t a = (fx_bam_t)x;
        const int32_t s = sine_of(a);
        is_so = is_so && s >= 0 && s <= one && sine_of(0u - a) == -s &&
                sine_of(FX_BAM_180 - a) == s && sine_of(FX_BAM_180 + a) == -s;
        if (is_measured(x)) {
            worst = worse(worst, s - sin(a * pi / 0x1p31) * one);
        }
    }
    tell(what, is_so && worst < most, worst, unit);
}

static void sine_q30(void)
{
    sine("fx_sin_q30", fx_sin_q30, 1 << 30, 0.77, "2^-30");
}

static void sine_q15(void)
{
    sine("fx_sin_q15", fx_sin_q15, 32768, 0.59, "2^-15");
}

/* It rises from -90 to 90 degrees, and is odd but at the poles. */
static void tangent(void)
{
    bool is_so = true;
    int32_t before = 0;
    EACH(x, FX_BAM_90)
    {
        const int32_t tangent_q16 = fx_tan_q16((fx_bam_t)x);
        const int32_t other_q16 = fx_tan_q16(0u - (fx_bam_t)x);
        is_so = is_so && tangent_q16 >= before &&
                (other_q16 == -tangent_q16 || tangent_q16 == INT32_MAX);
        before = tangent_q16;
    }
    tell("fx_tan_q16", is_so, 0, "");
}

/* The quotient is that of the division. */
static void reciprocal(void)
{
    bool is_so = true;
    EACH(x, 1ull << 32)
    {
        int s = 0;
        const uint32_t d = (uint32_t)x, r = fx_recip_q(d, &s);
        is_so = is_so && (d == 0 ? s == 0 && r == UINT32_MAX
                                 : s >= 31 && s <= 63 && r >> 31 != 0 && r == (1ull << s) / d);
    }
    tell("fx_recip_q", is_so, 0, "");
}

static void logarithm(void)
{
    bool is_so = true;
    double worst = 0;
    int32_t before = -65536;
    EACH(x, 1ull << 32)
    {
        const int32_t log_q16 = fx_log2_q16((uint32_t)x);
        is_so = is_so && log_q16 >= before && log_q16 <= 32 * 65536;
        before = log_q16;
        if (x != 0 && is_measured(x)) {
            worst = worse(worst, log_q16 - log2((double)x) * 65536);
        }
    }
    tell("fx_log2_q16", is_so && worst < 0.61, worst, "2^-16");
}

/* It rises from the least argument to the greatest. */
static void power(void)
{
    bool is_so = true;
    uint32_t before = 0, before_db = 0;
    EACH(x, 1ull << 32)
    {
        const int32_t argument = (int32_t)((uint32_t)x ^ 1u << 31);
        const uint32_t power_q16 = fx_exp2_q16(argument);
        const uint32_t of_db_q16 = fx_power_q16_from_db_q8(argument);
        is_so = is_so && power_q16 >= before && of_db_q16 >= before_db;
        before = power_q16, before_db = of_db_q16;
    }
    tell("fx_exp2_q16", is_so, 0, "");
}

/* Up to 45 degrees; fx_atan2 makes every other angle of it. */
static void arctangent(void)
{
    bool is_so = true;
    double worst = 0;
    EACH(x, (1ull << 31) + 1)
    {
        const uint32_t angle = atan_of_ratio((uint32_t)x);
        is_so = is_so && angle <= FX_BAM_90 / 2;
        if (is_measured(x)) {
            worst = worse(worst, angle - atan((double)x * 0x1p-31) * 0x1p31 / pi);
        }
    }
    tell("fx_atan2", is_so && worst < 2.7, worst, "2^-32 turn");
}

static void root(void)
{
    bool is_so = fx_sqrt_u64(UINT64_MAX) == UINT32_MAX;
    EACH(x, (1ull << 32) - 1)
    {
        const uint64_t r = x + 1;
        is_so = is_so && fx_sqrt_u64(r * r) == r && fx_sqrt_u64(r * r - 1) == r - 1;
    }
    tell("fx_sqrt_u64", is_so, 0, "");
}

int main(int argc, char **argv)
{
    void (*const each[])(void) = {sine_q30,  sine_q15, tangent,    reciprocal,
                                  logarithm, power,    arctangent, root};
    stride = argc > 1 ? strtoul(argv[1], NULL, 10) | 1u : 1;
    for (uint32_t i = 0; i < sizeof each / sizeof *each; i++) {
        each[i]();
    }
    return failures != 0;
}
