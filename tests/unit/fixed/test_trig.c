/* Sine, cosine, tangent and atan2 against the C library's double precision; the errors asserted
 * here are the ones that fx/trig.h states. */
#include "check.h"
#include "fx/sat.h"
#include "fx/trig.h"
#include "hs/rng.h"

#include <math.h>

static const double RADIANS_PER_COUNT = 2 * 3.14159265358979323846 / 4294967296.0;

static double radians(fx_bam_t angle)
{
    return (int32_t)angle * RADIANS_PER_COUNT;
}

/* The worst error in lsb over one random angle in each of 2^24 equal cells. */
static double worst_over_the_circle(int32_t (*f)(fx_bam_t), double (*truth)(double), double one)
{
    struct hs_rng rng;
    hs_rng_seed(&rng, 1);
    double worst = 0;
    for (uint32_t cell = 0; cell < 1u << 24; cell++) {
        const fx_bam_t angle = cell << 8 | (uint32_t)(hs_rng_u64(&rng) >> 56);
        worst = fmax(worst, fabs(f(angle) - one * truth(radians(angle))));
    }
    return worst;
}

TEST(degrees_become_the_nearest_count_and_wrap)
{
    for (int degrees = -3600; degrees <= 3600; degrees++) {
        const double turns = degrees / 360.0;
        const double want = round((turns - floor(turns)) * 4294967296.0);
        assert_int_equal(FX_BAM_DEG(degrees), (uint32_t)(uint64_t)want);
        assert_int_equal(FX_BAM_DEG(-degrees), 0u - FX_BAM_DEG(degrees));
    }
    assert_int_equal(FX_BAM_DEG(90), FX_BAM_90);
    assert_int_equal(FX_BAM_DEG(-180), FX_BAM_180);
}

TEST(sine_q30_is_within_0_76_lsb_all_round)
{
    const double worst = worst_over_the_circle(fx_sin_q30, sin, 1073741824.0);
    print_message("# sine Q30: worst %.3f lsb\n", worst);
    assert_true(worst <= 0.76);
}

TEST(cosine_q30_is_within_0_76_lsb_all_round)
{
    assert_true(worst_over_the_circle(fx_cos_q30, cos, 1073741824.0) <= 0.76);
}

TEST(sine_q15_is_within_0_58_lsb_all_round)
{
    const double worst = worst_over_the_circle(fx_sin_q15, sin, 32768.0);
    print_message("# sine Q15: worst %.3f lsb\n", worst);
    assert_true(worst <= 0.58);
}

TEST(sine_and_cosine_q15_are_within_0_58_lsb_on_all_65536_sixteen_bit_angles)
{
    double worst = 0;
    for (uint32_t i = 0; i < 65536; i++) {
        const double angle = radians(i << 16);
        worst = fmax(worst, fabs(fx_sin_q15(i << 16) - 32768 * sin(angle)));
        worst = fmax(worst, fabs(fx_cos_q15(i << 16) - 32768 * cos(angle)));
    }
    assert_true(worst <= 0.58);
}

TEST(sine_and_cosine_are_exact_on_the_axes)
{
    static const int quarter_sine[4] = {0, 1, 0, -1};
    for (uint32_t quarter = 0; quarter < 4; quarter++) {
        const fx_bam_t angle = quarter * FX_BAM_90;
        const int cosine = quarter_sine[(quarter + 1) % 4];
        assert_int_equal(fx_sin_q30(angle), quarter_sine[quarter] * (1 << 30));
        assert_int_equal(fx_cos_q30(angle), cosine * (1 << 30));
        assert_int_equal(fx_sin_q15(angle), quarter_sine[quarter] * 32768);
        assert_int_equal(fx_cos_q15(angle), cosine * 32768);
    }
}

TEST(sine_is_odd_cosine_is_even_and_quadrants_mirror_exactly)
{
    for (uint32_t i = 0; i < 1u << 20; i++) {
        const fx_bam_t angle = i * 4099u; /* odd, hence all over the circle */
        assert_true(fx_sin_q30(0u - angle) == -fx_sin_q30(angle));
        assert_true(fx_cos_q30(0u - angle) == fx_cos_q30(angle));
        assert_true(fx_sin_q30(FX_BAM_180 - angle) == fx_sin_q30(angle));
        assert_true(fx_sin_q15(0u - angle) == -fx_sin_q15(angle));
        assert_true(fx_cos_q15(0u - angle) == fx_cos_q15(angle));
        assert_true(fx_sin_q15(FX_BAM_180 - angle) == fx_sin_q15(angle));
    }
}

/* Every 64th count, and every single one about the seams between two nodes of the table. */
TEST(sine_never_falls_between_0_and_90_degrees)
{
    int32_t last_q30 = 0, last_q15 = 0;
    for (uint32_t angle = 0; angle <= FX_BAM_90; angle += 64) {
        assert_true(fx_sin_q30(angle) >= last_q30);
        assert_true(fx_sin_q15(angle) >= last_q15);
        last_q30 = fx_sin_q30(angle);
        last_q15 = fx_sin_q15(angle);
    }
    for (uint32_t node = 0; node < 256; node++) {
        const uint32_t seam = (node << 22) + (1u << 21);
        for (uint32_t angle = seam - 1000; angle < seam + 1000; angle++) {
            assert_true(fx_sin_q30(angle + 1) >= fx_sin_q30(angle));
        }
    }
}

static double worst_tangent(int degrees)
{
    struct hs_rng rng;
    hs_rng_seed(&rng, 2);
    double worst = 0;
    for (int i = 0; i < 2000000; i++) {
        const fx_bam_t angle = hs_rng_below(&rng, 2 * FX_BAM_DEG(degrees)) - FX_BAM_DEG(degrees);
        worst = fmax(worst, fabs(fx_tan_q16(angle) - 65536 * tan(radians(angle))));
    }
    return worst;
}

TEST(tangent_is_within_0_51_lsb_to_60_degrees_and_0_7_to_89)
{
    print_message("# tangent Q16: worst %.3f lsb to 89 degrees\n", worst_tangent(89));
    assert_true(worst_tangent(60) <= 0.51);
    assert_true(worst_tangent(89) <= 0.7);
}

TEST(tangent_repeats_each_half_turn_and_saturates_at_the_poles)
{
    assert_int_equal(fx_tan_q16(0), 0);
    assert_int_equal(fx_tan_q16(FX_BAM_DEG(45)), 65536);
    assert_int_equal(fx_tan_q16(FX_BAM_DEG(135)), -65536);
    assert_int_equal(fx_tan_q16(FX_BAM_DEG(225)), 65536);
    assert_int_equal(fx_tan_q16(FX_BAM_90), INT32_MAX);
    assert_int_equal(fx_tan_q16(0u - FX_BAM_90), INT32_MAX);
    for (uint32_t past = 1; past < 10000; past++) {
        assert_int_equal(fx_tan_q16(FX_BAM_90 - past), INT32_MAX);
        assert_int_equal(fx_tan_q16(FX_BAM_90 + past), INT32_MIN);
    }
}

/* The error of fx_atan2 in counts, the short way round. */
static double atan2_error(int32_t y, int32_t x)
{
    const double want = atan2(y, x) / RADIANS_PER_COUNT;
    return fabs(remainder(fx_atan2(y, x) - want, 4294967296.0));
}

TEST(atan2_is_within_2_6_counts_for_vectors_of_every_size)
{
    struct hs_rng rng;
    hs_rng_seed(&rng, 3);
    double worst = 0;
    for (int i = 0; i < 5000000; i++) {
        const int32_t y = (int32_t)hs_rng_u64(&rng) >> hs_rng_below(&rng, 32);
        const int32_t x = (int32_t)hs_rng_u64(&rng) >> hs_rng_below(&rng, 32);
        if (x != 0 || y != 0) {
            worst = fmax(worst, atan2_error(y, x));
        }
    }
    for (int32_t y = -200; y <= 200; y++) {
        for (int32_t x = -200; x <= 200; x++) {
            if (x != 0 || y != 0) {
                worst = fmax(worst, atan2_error(y, x));
            }
        }
    }
    print_message("# atan2: worst %.3f counts = %.2e degree\n", worst, worst * 360 / 4294967296.0);
    assert_true(worst <= 2.6);
}

TEST(atan2_is_exact_on_axes_and_diagonals_even_at_the_largest_numbers)
{
    static const int32_t sizes[] = {1, 2, 3, 5, 1000, 65537, 0x3fffffff, INT32_MAX - 1, INT32_MAX};
    for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; i++) {
        const int32_t r = sizes[i];
        assert_int_equal(fx_atan2(0, r), 0);
        assert_int_equal(fx_atan2(r, 0), FX_BAM_90);
        assert_int_equal(fx_atan2(0, -r), FX_BAM_180);
        assert_int_equal(fx_atan2(-r, 0), 0u - FX_BAM_90);
        assert_int_equal(fx_atan2(r, r), FX_BAM_DEG(45));
        assert_int_equal(fx_atan2(r, -r), FX_BAM_DEG(135));
        assert_int_equal(fx_atan2(-r, -r), FX_BAM_DEG(-135));
        assert_int_equal(fx_atan2(-r, r), FX_BAM_DEG(-45));
    }
    assert_int_equal(fx_atan2(0, 0), 0);
    assert_int_equal(fx_atan2(INT32_MIN, INT32_MIN), FX_BAM_DEG(-135));
    assert_int_equal(fx_atan2(INT32_MIN, 0), FX_BAM_DEG(-90));
    assert_int_equal(fx_atan2(0, INT32_MIN), FX_BAM_180);
}

TEST(atan2_meets_its_error_where_numbers_are_extreme)
{
    static const int32_t edges[] = {INT32_MIN, INT32_MIN + 1, -65536,   -2, -1, 0, 1, 2, 65535,
                                    3,         INT32_MAX - 1, INT32_MAX};
    const size_t n = sizeof edges / sizeof edges[0];
    for (size_t i = 0; i < n * n; i++) {
        const int32_t y = edges[i / n], x = edges[i % n];
        assert_true((x == 0 && y == 0) || atan2_error(y, x) <= 2.6);
    }
}

TEST(atan2_finds_the_angle_back_from_its_sine_and_cosine)
{
    for (uint32_t i = 0; i < 1u << 20; i++) {
        const fx_bam_t angle = i * 4099u;
        const int32_t off = (int32_t)(fx_atan2(fx_sin_q30(angle), fx_cos_q30(angle)) - angle);
        assert_true(fx_abs_u32(off) <= 4);
    }
}
