/* Interpolation and saturation: properties over every weight and every edge. */
#include "check.h"
#include "fx/lerp.h"
#include "fx/sat.h"
#include "hs/rng.h"

#include <math.h>

TEST(a_flat_field_comes_back_unchanged_for_every_pair_of_weights)
{
    static const uint16_t fields[] = {0, 1, 255, 1000, 32767, 32768, 65534, 65535};
    for (size_t i = 0; i < sizeof fields / sizeof fields[0]; i++) {
        const uint16_t c = fields[i];
        for (uint32_t tx = 0; tx <= 256; tx++) {
            for (uint32_t ty = 0; ty <= 256; ty++) {
                assert_true(fx_bilerp_u16_q16(c, c, c, c, tx, ty) == (uint32_t)c << 16);
            }
        }
    }
}

/* Exact: the truth is a sum of integers times 2^-16, which a double holds without rounding. */
TEST(a_blend_is_exact_and_inside_its_corners_for_every_pair_of_weights)
{
    struct hs_rng rng;
    hs_rng_seed(&rng, 1);
    for (uint32_t tx = 0; tx <= 256; tx++) {
        for (uint32_t ty = 0; ty <= 256; ty++) {
            uint16_t c[4];
            for (int i = 0; i < 4; i++) {
                c[i] = (uint16_t)hs_rng_u64(&rng);
            }
            const double x = tx / 256.0, y = ty / 256.0;
            const double want =
                (c[0] * (1 - x) + c[1] * x) * (1 - y) + (c[2] * (1 - x) + c[3] * x) * y;
            const uint32_t fine = fx_bilerp_u16_q16(c[0], c[1], c[2], c[3], tx, ty);
            assert_true(fine == want * 65536);
            assert_true(fine / 65536.0 >= fmin(fmin(c[0], c[1]), fmin(c[2], c[3])));
            assert_true(fine / 65536.0 <= fmax(fmax(c[0], c[1]), fmax(c[2], c[3])));
        }
    }
}

TEST(a_blend_meets_each_corner_exactly)
{
    assert_int_equal(fx_bilerp_u16_q16(1, 20, 300, 65535, 0, 0), 1u << 16);
    assert_int_equal(fx_bilerp_u16_q16(1, 20, 300, 65535, 256, 0), 20u << 16);
    assert_int_equal(fx_bilerp_u16_q16(1, 20, 300, 65535, 0, 256), 300u << 16);
    assert_int_equal(fx_bilerp_u16_q16(1, 20, 300, 65535, 256, 256), 65535u << 16);
}

TEST(sixty_four_bits_saturate_to_thirty_two)
{
    assert_int_equal(fx_sat_i32(INT32_MAX), INT32_MAX);
    assert_int_equal(fx_sat_i32(INT32_MIN), INT32_MIN);
    assert_int_equal(fx_sat_i32(-1), -1);
    assert_int_equal(fx_sat_i32((int64_t)INT32_MAX + 1), INT32_MAX);
    assert_int_equal(fx_sat_i32((int64_t)INT32_MIN - 1), INT32_MIN);
    assert_int_equal(fx_sat_i32(INT64_MAX), INT32_MAX);
    assert_int_equal(fx_sat_i32(INT64_MIN), INT32_MIN);
}

TEST(clamp_minimum_maximum_and_magnitude_hold_at_the_edges)
{
    assert_int_equal(fx_clamp_i32(5, -3, 4), 4);
    assert_int_equal(fx_clamp_i32(-5, -3, 4), -3);
    assert_int_equal(fx_clamp_i32(0, -3, 4), 0);
    assert_int_equal(fx_clamp_i64(INT64_MAX, -3, INT64_MAX - 1), INT64_MAX - 1);
    assert_int_equal(fx_clamp_i64(INT64_MIN, INT64_MIN + 1, 4), INT64_MIN + 1);
    assert_int_equal(fx_clamp_i64((int64_t)1 << 32, -3, 4), 4);
    assert_int_equal(fx_clamp_i64(INT64_MIN, INT64_MIN, INT64_MAX), INT64_MIN);
    assert_int_equal(fx_clamp_i64(-3, -3, -3), -3);
    assert_true(fx_is_within_i32(-3, -3, 4) && fx_is_within_i32(4, -3, 4));
    assert_false(fx_is_within_i32(-4, -3, 4) || fx_is_within_i32(5, -3, 4));
    assert_true(fx_is_within_i32(INT32_MIN, INT32_MIN, INT32_MAX));
    assert_int_equal(fx_min_i32(INT32_MIN, INT32_MAX), INT32_MIN);
    assert_int_equal(fx_max_i32(INT32_MIN, INT32_MAX), INT32_MAX);
    assert_int_equal(fx_min_u32(0, UINT32_MAX), 0);
    assert_int_equal(fx_max_u32(0, UINT32_MAX), UINT32_MAX);
    assert_int_equal(fx_abs_u32(INT32_MIN), 2147483648u);
    assert_int_equal(fx_abs_u32(INT32_MAX), 2147483647u);
    assert_int_equal(fx_abs_u32(-1), 1);
}
