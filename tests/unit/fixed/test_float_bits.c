/* The decoder of IEEE 754 patterns against the machine's own floating point. */
#include "check.h"
#include "fx/float_bits.h"
#include "hs/rng.h"

#include <math.h>
#include <string.h>

static const int64_t UNTOUCHED = 0x5a5a5a5a5a5a5a5a;

/* Scaling by a power of two is exact in long double, and roundl takes halves away from zero. */
static bool reference(long double value, int frac_bits, int64_t *out)
{
    const long double scaled = roundl(ldexpl(value, frac_bits));
    if (!isfinite(value) || scaled >= 0x1p63L || scaled < -0x1p63L) {
        return false;
    }
    *out = (int64_t)scaled;
    return true;
}

static void check_f32(uint32_t bits, int frac_bits)
{
    float value;
    memcpy(&value, &bits, sizeof value);
    int64_t want = UNTOUCHED, got = UNTOUCHED;
    const bool fits = reference((long double)value, frac_bits, &want);
    assert_true(fx_f32_bits_to_q(bits, frac_bits, &got) == fits);
    assert_true(got == want);
}

static void check_f64(uint64_t bits, int frac_bits)
{
    double value;
    memcpy(&value, &bits, sizeof value);
    int64_t want = UNTOUCHED, got = UNTOUCHED;
    const bool fits = reference((long double)value, frac_bits, &want);
    assert_true(fx_f64_bits_to_q(bits, frac_bits, &got) == fits);
    assert_true(got == want);
}

static uint64_t bits_of(double value)
{
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

/* Every sign and exponent with a spread of fractions: 2^20 of the 2^32 patterns, each at random
 * within its 4096. */
TEST(single_precision_agrees_with_the_machine_for_every_exponent)
{
    struct hs_rng rng;
    hs_rng_seed(&rng, 1);
    for (uint32_t cell = 0; cell < 1u << 20; cell++) {
        const uint32_t bits = cell << 12 | hs_rng_below(&rng, 4096);
        check_f32(bits, 0);
        check_f32(bits, 16);
        check_f32(bits, (int)hs_rng_below(&rng, 401) - 200);
    }
}

TEST(double_precision_agrees_with_the_machine_for_every_exponent)
{
    struct hs_rng rng;
    hs_rng_seed(&rng, 2);
    for (uint64_t cell = 0; cell < 1u << 19; cell++) {
        const uint64_t bits = cell << 45 | hs_rng_u64(&rng) >> 19;
        check_f64(bits, 0);
        check_f64(bits, 30);
        check_f64(bits, (int)hs_rng_below(&rng, 2401) - 1200);
    }
}

TEST(numbers_about_the_ends_of_the_range_are_kept_or_refused_rightly)
{
    static const double edges[] = {0.0,
                                   -0.0,
                                   0.25,
                                   0.49999999999999994,
                                   0.5,
                                   1.5,
                                   2.5,
                                   0x1p52,
                                   0x1.fffffffffffffp62,
                                   0x1p62,
                                   0x1p63,
                                   0x1.0000000000001p63,
                                   0x1p64,
                                   0x1p-1074,
                                   0x1p1023};
    for (size_t i = 0; i < sizeof edges / sizeof edges[0]; i++) {
        for (int frac_bits = -70; frac_bits <= 70; frac_bits++) {
            check_f64(bits_of(edges[i]), frac_bits);
            check_f64(bits_of(-edges[i]), frac_bits);
        }
    }
    int64_t out = 0;
    assert_true(fx_f64_bits_to_q(bits_of(-0x1p63), 0, &out) && out == INT64_MIN);
}

TEST(infinities_and_nan_are_refused_and_leave_the_result_alone)
{
    static const uint32_t bad_f32[] = {0x7f800000, 0xff800000, 0x7fc00000, 0x7f800001, 0xffffffff};
    for (size_t i = 0; i < sizeof bad_f32 / sizeof bad_f32[0]; i++) {
        int64_t out = UNTOUCHED;
        assert_false(fx_f32_bits_to_q(bad_f32[i], 16, &out));
        assert_false(fx_f64_bits_to_q(
            (uint64_t)bad_f32[i] << 32 | (i & 1) | (uint64_t)0x7ff00000 << 32, 16, &out));
        assert_true(out == UNTOUCHED);
    }
}

TEST(any_number_of_fraction_bits_is_answered_sensibly)
{
    int64_t out = UNTOUCHED;
    assert_true(fx_f32_bits_to_q(0x3f800000, INT32_MIN, &out));
    assert_true(out == 0);
    out = UNTOUCHED;
    assert_false(fx_f32_bits_to_q(0x3f800000, INT32_MAX, &out));
    assert_true(out == UNTOUCHED);
    assert_true(fx_f64_bits_to_q(0, INT32_MAX, &out));
    assert_true(out == 0);
}
