/* Logarithms, powers and decibels against the C library; the errors are those of fx/log.h. */
#include "check.h"
#include "fx/log.h"
#include "hs/rng.h"

#include <math.h>

TEST(zeros_at_either_end_are_counted_for_every_width)
{
    assert_int_equal(fx_clz32(0), 32);
    assert_int_equal(fx_clz64(0), 64);
    assert_int_equal(fx_ctz64(0), 64);
    for (int bit = 0; bit < 64; bit++) {
        const uint64_t smallest = 1ull << bit, largest = smallest | (smallest - 1);
        assert_int_equal(fx_clz64(smallest), 63 - bit);
        assert_int_equal(fx_clz64(largest), 63 - bit);
        assert_int_equal(fx_ctz64(smallest), bit);
        assert_int_equal(fx_ctz64(~(smallest - 1)), bit);
        if (bit < 32) {
            assert_int_equal(fx_clz32((uint32_t)smallest), 31 - bit);
            assert_int_equal(fx_clz32((uint32_t)largest), 31 - bit);
        }
    }
}

TEST(log2_is_within_0_60_lsb)
{
    double worst = 0;
    for (uint32_t x = 1; x < 1u << 22; x++) {
        worst = fmax(worst, fabs(fx_log2_q16(x) - 65536 * log2(x)));
    }
    struct hs_rng rng;
    hs_rng_seed(&rng, 1);
    for (int i = 0; i < 4000000; i++) {
        const uint64_t x = hs_rng_u64(&rng) >> hs_rng_below(&rng, 64);
        if (x != 0) {
            worst = fmax(worst, fabs(fx_log2_q16_u64(x) - 65536 * log2((double)x)));
        }
    }
    print_message("# log2 Q16: worst %.3f lsb\n", worst);
    assert_true(worst <= 0.60);
}

TEST(log2_is_exact_for_powers_of_two_and_minus_one_for_zero)
{
    for (int power = 0; power < 64; power++) {
        assert_int_equal(fx_log2_q16_u64(1ull << power), power * 65536);
        if (power < 32) {
            assert_int_equal(fx_log2_q16(1u << power), power * 65536);
        }
    }
    assert_int_equal(fx_log2_q16(0), -65536);
    assert_int_equal(fx_log2_q16_u64(0), -65536);
    assert_int_equal(fx_log2_q16(UINT32_MAX), 32 * 65536);
    assert_int_equal(fx_log2_q16_u64(UINT64_MAX), 64 * 65536);
}

TEST(log2_never_falls)
{
    for (uint32_t x = 0; x < 1u << 20; x++) {
        assert_true(fx_log2_q16(x + 1) >= fx_log2_q16(x));
    }
}

/* The error of `got`, less the half lsb that rounding may take, as a fraction of the truth. */
static double error_beyond_rounding(uint32_t got, double want)
{
    return (fabs(got - want) - 0.5) / want;
}

TEST(exp2_is_within_half_an_lsb_and_4e_9_over_its_whole_range)
{
    double worst = 0;
    for (int32_t x_q16 = -17 * 65536; x_q16 < 16 * 65536; x_q16++) {
        const double want = 65536 * exp2(x_q16 / 65536.0);
        worst = fmax(worst, error_beyond_rounding(fx_exp2_q16(x_q16), want));
    }
    print_message("# exp2 Q16: worst 0.5 lsb and %.2e\n", worst);
    assert_true(worst <= 4e-9);
}

TEST(exp2_saturates_above_and_vanishes_below)
{
    assert_int_equal(fx_exp2_q16(0), 65536);
    assert_int_equal(fx_exp2_q16(15 * 65536), 1u << 31);
    assert_int_equal(fx_exp2_q16(16 * 65536), UINT32_MAX);
    assert_int_equal(fx_exp2_q16(INT32_MAX), UINT32_MAX);
    assert_int_equal(fx_exp2_q16(-17 * 65536), 1);
    assert_int_equal(fx_exp2_q16(-17 * 65536 - 1), 0);
    assert_int_equal(fx_exp2_q16(INT32_MIN), 0);
}

TEST(exp2_of_log2_comes_back)
{
    for (uint32_t x = 1; x < 65536; x++) {
        /* 1.1 lsb of Q16 in the exponent is 1.2e-5 of the number. */
        const double back = fx_exp2_q16(fx_log2_q16(x)) / 65536.0;
        assert_true(fabs(back / x - 1) < 1.2e-5);
    }
}

TEST(decibels_are_within_0_0108_dB_for_powers_of_every_size)
{
    double worst = 0;
    for (uint32_t power = 1; power < 1u << 22; power++) {
        worst = fmax(worst, fabs(fx_db_q8(power) / 256.0 - 10 * log10(power)));
    }
    struct hs_rng rng;
    hs_rng_seed(&rng, 2);
    for (int i = 0; i < 4000000; i++) {
        const uint32_t power = (uint32_t)hs_rng_u64(&rng) | 1u << hs_rng_below(&rng, 32);
        worst = fmax(worst, fabs(fx_db_q8(power) / 256.0 - 10 * log10(power)));
    }
    print_message("# decibels Q8: worst %.5f dB\n", worst);
    assert_true(worst <= 0.0108);
}

TEST(decibels_never_fall_and_keep_to_their_range)
{
    for (uint32_t power = 0; power < 1u << 20; power++) {
        assert_true(fx_db_q8(power + 1) >= fx_db_q8(power));
    }
    assert_int_equal(fx_db_q8(0), -768);
    assert_int_equal(fx_db_q8(1), 2);
    assert_int_equal(fx_db_q8(UINT32_MAX), 24659);
}

TEST(decibels_of_64_bits_are_within_0_012_dB)
{
    double worst = 0;
    struct hs_rng rng;
    hs_rng_seed(&rng, 3);
    for (int i = 0; i < 2000000; i++) {
        const uint64_t power = hs_rng_u64(&rng) >> hs_rng_below(&rng, 63) | 1;
        worst = fmax(worst, fabs(fx_db_q8_u64(power) / 256.0 - 10 * log10((double)power)));
    }
    print_message("# decibels of 64 bits, Q8: worst %.5f dB\n", worst);
    assert_true(worst <= 0.012);
    assert_int_equal(fx_db_q8_u64(0), -768);
}

TEST(decibels_of_many_are_within_0_015_dB_and_never_fall)
{
    double worst = 0;
    for (uint32_t power = 1; power < 1u << 20; power++) {
        worst = fmax(worst, fabs(fx_db_q8_vec(power) / 256.0 - 10 * log10(power)));
        assert_true(fx_db_q8_vec(power) >= fx_db_q8_vec(power - 1));
    }
    for (uint64_t power = 1u << 20; power <= UINT32_MAX; power += 1021) {
        const uint32_t p = (uint32_t)power;
        worst = fmax(worst, fabs(fx_db_q8_vec(p) / 256.0 - 10 * log10(p)));
        assert_true(fx_db_q8_vec(p) >= fx_db_q8_vec(p - 1021));
    }
    print_message("# decibels of many, Q8: worst %.5f dB\n", worst);
    assert_true(worst <= 0.015);
    assert_int_equal(fx_db_q8_vec(0), -43029);
}

TEST(decibels_of_many_with_a_sign_are_the_same)
{
    for (int32_t power = 1; power < 1 << 20; power++) {
        assert_int_equal(fx_db_q8_vec_i32(power), fx_db_q8_vec((uint32_t)power));
    }
    for (int64_t power = 1 << 20; power <= INT32_MAX; power += 1021) {
        const int32_t p = (int32_t)power;
        assert_int_equal(fx_db_q8_vec_i32(p), fx_db_q8_vec((uint32_t)p));
    }
    assert_int_equal(fx_db_q8_vec_i32(0), -43800);
}

TEST(power_from_decibels_is_within_half_an_lsb_and_4e_9)
{
    double worst = 0;
    for (int32_t db_q8 = -13100; db_q8 < 12331; db_q8++) {
        const double want = 65536 * pow(10, db_q8 / 2560.0);
        worst = fmax(worst, error_beyond_rounding(fx_power_q16_from_db_q8(db_q8), want));
    }
    print_message("# power from decibels: worst 0.5 lsb and %.2e\n", worst);
    assert_true(worst <= 4e-9);
}

TEST(power_from_decibels_saturates_above_and_vanishes_below)
{
    assert_int_equal(fx_power_q16_from_db_q8(0), 65536);
    assert_int_equal(fx_power_q16_from_db_q8(10 * 256), 655360);
    assert_true(fx_power_q16_from_db_q8(12330) < UINT32_MAX);
    assert_int_equal(fx_power_q16_from_db_q8(12331), UINT32_MAX);
    assert_int_equal(fx_power_q16_from_db_q8(INT32_MAX), UINT32_MAX);
    assert_int_equal(fx_power_q16_from_db_q8(-13100), 1);
    assert_int_equal(fx_power_q16_from_db_q8(-13101), 0);
    assert_int_equal(fx_power_q16_from_db_q8(INT32_MIN), 0);
}

TEST(powers_of_many_are_within_0_012_dB_from_minus_45_to_24_dB_and_never_fall)
{
    double worst = 0;
    for (int32_t db_q8 = -45 * 256; db_q8 <= 24 * 256; db_q8++) {
        const double power = fx_power_q24_vec(db_q8) / 16777216.0;
        worst = fmax(worst, fabs(10 * log10(power) - db_q8 / 256.0));
        assert_true(fx_power_q24_vec(db_q8) >= fx_power_q24_vec(db_q8 - 1));
    }
    print_message("worst error %.4f dB\n", worst);
    assert_true(worst < 0.012);
    assert_int_equal(fx_power_q24_vec(-0xC000), 1);
    assert_int_equal(fx_power_q24_vec(1 - (1 << 17)), 1);
    assert_true(fx_power_q24_vec(50 * 256) > UINT32_MAX - (UINT32_MAX >> 8));
    assert_int_equal(fx_power_q24_vec((1 << 17) - 1), fx_power_q24_vec(50 * 256));
}

TEST(powers_of_64_bits_are_within_0_014_dB_up_to_where_they_saturate)
{
    for (int32_t db_q8 = -66 * 256; db_q8 < 96 * 256; db_q8 += 7) {
        const double db = 10 * log10((double)fx_power_q32_vec(db_q8) / 4294967296.0);
        assert_true(fabs(db - db_q8 / 256.0) <= 0.014);
    }
    assert_int_equal(fx_power_q32_vec(-97 * 256), 1);
    assert_int_equal(fx_power_q32_vec(1 - (1 << 16)), 1);
    const uint64_t most = fx_power_q32_vec(97 * 256);
    assert_true(most > UINT64_MAX - (UINT64_MAX >> 8));
    assert_true(fx_power_q32_vec((1 << 16) - 1) == most);
}

TEST(sums_of_many_are_within_0_018_dB_either_way_round)
{
    double worst = 0;
    for (int32_t a_q8 = -60 * 256; a_q8 <= 20 * 256; a_q8 += 7) {
        const int32_t b_q8 = -20 * 256;
        const double sum = 10 * log10(pow(10, a_q8 / 2560.0) + pow(10, b_q8 / 2560.0));
        worst = fmax(worst, fabs(fx_db_q8_sum_vec(a_q8, b_q8) / 256.0 - sum));
        assert_int_equal(fx_db_q8_sum_vec(a_q8, b_q8), fx_db_q8_sum_vec(b_q8, a_q8));
    }
    print_message("worst error %.4f dB\n", worst);
    assert_true(worst < 0.018);
}

TEST(the_farther_apart_the_less_is_added)
{
    for (int32_t apart_q8 = 0; apart_q8 < 0x4000; apart_q8++) {
        assert_true(fx_db_q8_sum_vec(0, -apart_q8) >= fx_db_q8_sum_vec(0, -apart_q8 - 1));
    }
    assert_int_equal(fx_db_q8_sum_vec(0, -0x8000), 1); /* what 32 dB still add, rounded */
}
