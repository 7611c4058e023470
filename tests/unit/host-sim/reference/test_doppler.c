/* Doppler beam sharpening of the reference against the notch by hand, sin o = l N w / (2 V B^2),
 * and movers against geometry. */
#include "check.h"
#include "reference/reference.h"

#include <math.h>

/* 31.3 mm, 250 m/s, a beam of 3.3 degrees. */
static struct ref_dbs dbs_at(double rate_deg_s, double speed_m_s)
{
    return (struct ref_dbs){speed_m_s, 3.3, 0.0313, rate_deg_s};
}

TEST(the_notch_opens_as_in_the_table)
{
    static const double rates_deg_s[] = {120, 60, 15, 3};
    static const struct {
        double ratio, notch_deg[4]; /* NAN: none is to be had */
    } rows[] = {
        {8, {18.4, 9.1, 2.3, 0.5}}, {16, {39, 18.4, 4.5, 0.9}}, {64, {NAN, NAN, 18.4, 3.6}}};
    for (int n = 0; n < 3; n++) {
        for (int k = 0; k < 4; k++) {
            const struct ref_dbs d = dbs_at(rates_deg_s[k], 250);
            const double notch_deg = ref_dbs_notch_deg(&d, rows[n].ratio);
            print_message("# %2.0f:1 at %3.0f deg/s: %.2f degrees\n", rows[n].ratio, rates_deg_s[k],
                          notch_deg);
            assert_int_equal(isnan(notch_deg) != 0, isnan(rows[n].notch_deg[k]) != 0);
            assert_false(fabs(notch_deg - rows[n].notch_deg[k]) > 0.5);
        }
    }
}

TEST(the_notch_is_where_the_ratio_runs_out)
{
    for (double speed_m_s = 100; speed_m_s < 700; speed_m_s *= 1.5) {
        const struct ref_dbs d = dbs_at(15, speed_m_s);
        const double notch_deg = ref_dbs_notch_deg(&d, 8);
        assert_true(fabs(ref_dbs_ratio(&d, notch_deg) - 8) < 1e-9);
        assert_true(fabs(ref_dbs_ratio(&d, -notch_deg) - 8) < 1e-9);
        assert_true(ref_dbs_ratio(&d, notch_deg + 0.1) > 8);
        assert_true(ref_dbs_ratio(&d, 0) == 0);
        /* Half the speed needs twice the sine. */
        const struct ref_dbs slow = dbs_at(15, speed_m_s / 2);
        const double twice =
            sin(ref_dbs_notch_deg(&slow, 8) * acos(-1.0) / 180) / sin(notch_deg * acos(-1.0) / 180);
        assert_true(fabs(twice - 2) < 1e-9);
    }
}

/* The Doppler frequencies of two directions apart by a sharpened beam, over the dwell: one turn. */
TEST(a_dwell_tells_two_neighbouring_cells_apart_by_one_turn)
{
    const double rad = acos(-1.0) / 180, wavelength_m = 0.0313;
    for (double off_deg = 10; off_deg < 60; off_deg += 7) {
        const struct ref_dbs d = dbs_at(15, 250);
        const double ratio = ref_dbs_ratio(&d, off_deg), dwell_s = 3.3 / 15;
        const double cell_deg = 3.3 / ratio;
        const double near_hz = 2 * 250 * cos((off_deg - cell_deg / 2) * rad) / wavelength_m;
        const double far_hz = 2 * 250 * cos((off_deg + cell_deg / 2) * rad) / wavelength_m;
        assert_true(fabs((near_hz - far_hz) * dwell_s - 1) < 1e-4);
    }
}

TEST(what_is_used_is_what_is_had_up_to_what_is_wanted_and_real_beam_in_the_notch)
{
    const struct ref_dbs d = dbs_at(15, 100); /* 8:1 from 5.7 degrees */
    assert_true(ref_dbs_used(&d, 45, 0.1, 8) == 8);
    assert_true(ref_dbs_used(&d, 5.6, 0.1, 8) < 8 && ref_dbs_used(&d, 5.8, 0.1, 8) == 8);
    assert_true(fabs(ref_dbs_used(&d, 3, 0.1, 8) - ref_dbs_ratio(&d, 3)) < 1e-12);
    assert_true(ref_dbs_used(&d, 0, 0.1, 8) == 1);
    assert_true(fabs(ref_dbs_used(&d, 177, 0.1, 8) - ref_dbs_used(&d, -3, 0.1, 8)) < 1e-9);
}

/* Half-way between positions 2/5 of a beam apart the pattern of both ways is 0.96 dB down. */
TEST(between_two_beam_positions_a_sharpened_line_is_weaker_by_the_pattern)
{
    assert_true(ref_dbs_scallop(3.3, 1.32, 64, 13.2) == 1);
    assert_true(fabs(10 * log10(ref_dbs_scallop(3.3, 1.32, 64, 13.86)) + 0.963) < 0.001);
    assert_true(ref_dbs_scallop(3.3, 1.32, 1, 13.86) == 1);
    assert_true(ref_dbs_scallop(3.3, 0, 64, 13.86) == 1);
}

/* By hand: 180 m/s, 3.3 degrees, 60 off: 180 * 0.0576 * 0.866 / 2 = 4.49 m/s, 8.7 knots. */
TEST(the_gate_is_half_the_spread_of_the_clutter_where_that_is_more)
{
    assert_true(fabs(ref_gmt_least_m_s(1.543, 180, 3.3, 60) - 4.489) < 0.001);
    assert_true(fabs(ref_gmt_least_m_s(1.543, 180, 3.3, -90) - 5.184) < 0.001);
    assert_true(ref_gmt_least_m_s(1.543, 180, 3.3, 10) == 1.543);
    assert_true(ref_gmt_least_m_s(1.543, 0, 3.3, 60) == 1.543);
}

/* A target at o that closes with v has the Doppler frequency of ground at o - d. */
TEST(a_mover_lies_where_still_ground_has_its_frequency)
{
    const double rad = acos(-1.0) / 180, speed_m_s = 250;
    for (double off_deg = 20; off_deg < 80; off_deg += 11) {
        for (double closing_m_s = -8; closing_m_s < 9; closing_m_s += 4) {
            const double shift_deg = ref_mover_shift_deg(closing_m_s, speed_m_s, off_deg);
            const double mover = speed_m_s * cos(off_deg * rad) + closing_m_s;
            const double ground = speed_m_s * cos((off_deg - shift_deg) * rad);
            assert_true(fabs(mover - ground) < 1e-9);
            /* A patch takes the first term of the series: the next is cot o shift / 2 of it. */
            const double across_m = ref_mover_shift_m(closing_m_s, speed_m_s, off_deg, 30000);
            assert_true(fabs(across_m / 30000 - shift_deg * rad) <
                        0.2 * fabs(shift_deg * rad) + 1e-12);
        }
    }
    assert_true(isnan(ref_mover_shift_deg(100, 250, 10)));
    assert_true(ref_mover_shift_deg(5, 250, -30) == ref_mover_shift_deg(5, 250, 30));
}
