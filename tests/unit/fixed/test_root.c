/* Roots and reciprocals are exact, so the proof is their definition rather than a tolerance. */
#include "check.h"
#include "fx/recip.h"
#include "fx/root.h"
#include "hs/rng.h"

#include <stdbool.h>

/* Whether r^2 <= x < (r + 1)^2, written without overflow. */
static bool is_floor_of_root(uint64_t r, uint64_t x)
{
    return r <= UINT32_MAX && r * r <= x && x - r * r <= 2 * r;
}

TEST(the_root_of_every_24_bit_number_is_its_floor)
{
    for (uint32_t x = 0; x < 1u << 24; x++) {
        assert_true(is_floor_of_root(fx_sqrt_u64(x), x));
    }
}

TEST(the_root_of_numbers_of_every_size_is_its_floor)
{
    struct hs_rng rng;
    hs_rng_seed(&rng, 1);
    for (int i = 0; i < 5000000; i++) {
        const uint64_t x = hs_rng_u64(&rng) >> hs_rng_below(&rng, 64);
        assert_true(is_floor_of_root(fx_sqrt_u64(x), x));
    }
    for (uint64_t below = 0; below < 1000000; below++) {
        assert_true(
            is_floor_of_root(fx_sqrt_u64(UINT64_MAX - below * 4099), UINT64_MAX - below * 4099));
    }
    assert_int_equal(fx_sqrt_u64(UINT64_MAX), UINT32_MAX);
}

TEST(the_root_steps_exactly_at_each_square)
{
    for (uint64_t r = 1; r <= UINT32_MAX; r += 1021) {
        assert_true(fx_sqrt_u64(r * r) == r);
        assert_true(fx_sqrt_u64(r * r - 1) == r - 1);
    }
    const uint64_t last = UINT32_MAX;
    assert_int_equal(fx_sqrt_u64(last * last), last);
    assert_int_equal(fx_sqrt_u64(last * last - 1), last - 1);
}

TEST(hypot_is_the_floor_for_all_signs_and_the_largest_numbers)
{
    assert_int_equal(fx_hypot_u32(3, -4), 5);
    assert_int_equal(fx_hypot_u32(0, 0), 0);
    assert_int_equal(fx_hypot_u32(INT32_MIN, 0), 2147483648u);
    assert_int_equal(fx_hypot_u32(INT32_MIN, INT32_MIN), 3037000499u); /* 2^31 * sqrt 2 */
    assert_int_equal(fx_hypot_u32(INT32_MAX, INT32_MIN), 3037000499u);
    struct hs_rng rng;
    hs_rng_seed(&rng, 2);
    for (int i = 0; i < 1000000; i++) {
        const int64_t x = (int32_t)hs_rng_u64(&rng), y = (int32_t)hs_rng_u64(&rng);
        const uint64_t r = fx_hypot_u32((int32_t)x, (int32_t)y);
        assert_true(is_floor_of_root(r, (uint64_t)(x * x) + (uint64_t)(y * y)));
    }
}

/* What fx/recip.h promises: 2^s / d - 1 < r <= 2^s / d and 2^31 <= r < 2^32. */
static bool is_reciprocal(uint32_t d)
{
    int s = -1;
    const uint64_t r = fx_recip_q(d, &s);
    return s >= 31 && s <= 63 && r == (1ull << s) / d && r >> 31 == 1;
}

TEST(the_reciprocal_is_floor_of_a_power_of_two_by_division)
{
    for (uint32_t d = 1; d < 1u << 20; d++) {
        assert_true(is_reciprocal(d));
    }
    struct hs_rng rng;
    hs_rng_seed(&rng, 3);
    for (int i = 0; i < 5000000; i++) {
        const uint32_t d = (uint32_t)hs_rng_u64(&rng) >> hs_rng_below(&rng, 32);
        assert_true(d == 0 || is_reciprocal(d));
    }
    for (uint32_t distance = 0; distance < 1000; distance++) {
        assert_true(is_reciprocal(UINT32_MAX - distance));
        assert_true(is_reciprocal((1u << 31) + distance));
        assert_true(is_reciprocal((1u << 31) - 1 - distance));
    }
}

TEST(the_reciprocal_of_zero_is_the_largest)
{
    int s = -1;
    assert_int_equal(fx_recip_q(0, &s), UINT32_MAX);
    assert_int_equal(s, 0);
}

TEST(multiplying_by_the_reciprocal_divides_or_falls_one_short)
{
    struct hs_rng rng;
    hs_rng_seed(&rng, 4);
    for (int i = 0; i < 2000000; i++) {
        const uint32_t d = 1 + ((uint32_t)hs_rng_u64(&rng) >> (1 + hs_rng_below(&rng, 31)));
        /* Multiples of d are where a reciprocal rounded down falls short. */
        const uint32_t x = i % 2 ? (uint32_t)hs_rng_u64(&rng) : d * (UINT32_MAX / d);
        int s;
        const uint64_t r = fx_recip_q(d, &s);
        const uint64_t quotient = x * r >> s;
        assert_true(quotient == x / d || quotient + 1 == x / d);
    }
}
