/* The receiver and the weather of the reference against theory: pulses, noise, time gain, ITU-R
 * P.838-3, radar meteorology, the equation of a jammer. */
#include "check.h"
#include "reference/reference.h"

#include <math.h>

static const double rad = 0.017453292519943295;

static struct ref_receiver receiver_at(double height_m)
{
    return (struct ref_receiver){.bins = {36, 72, 256},
                                 .height_m = height_m,
                                 .noise = {-40, 18520, height_m, 400e-9},
                                 .stc_m = 13890,
                                 .pulse_s = 400e-9};
}

/* A pulse is c t / 2 long: 15 m for 0.1 us. */
TEST(pulses_are_as_long_as_in_the_list)
{
    static const double pulses_us[] = {0.1, 0.4, 1, 3.2, 6.4},
                        lengths_m[] = {15, 60, 150, 480, 960};
    for (int n = 0; n < 5; n++) {
        assert_true(fabs(ref_pulse_m(pulses_us[n] * 1e-6) / lengths_m[n] - 1) < 0.001);
    }
}

/* The share of bin i + m in bin i is what of a box of the pulse's length falls into it. */
TEST(a_pulse_is_a_box_that_keeps_the_energy)
{
    for (double bins = 0.1; bins < 12; bins += 0.173) {
        double sum = 0, place = 0;
        for (int m = -REF_PULSE_REACH; m <= REF_PULSE_REACH; m++) {
            sum += ref_pulse_share(bins, m);
            place += m * ref_pulse_share(bins, m);
            assert_true(ref_pulse_share(bins, m) >= 0);
        }
        assert_true(fabs(sum - 1) < 1e-12 && fabs(place) < 1e-12);
        /* Energy over peak is its length. */
        const double length = fmin(fmax(bins, 1), 2 * REF_PULSE_REACH + 1);
        assert_true(fabs(1 / ref_pulse_share(bins, 0) - length) < 1e-12);
    }
    assert_true(fabs(ref_pulse_share(2, 1) - 0.25) < 1e-12);
    assert_true(fabs(ref_pulse_share(3, 1) - 1 / 3.0) < 1e-12);
}

/* The received power of gamma-ground: gamma g area / r^4 with an area of r: gamma g / r^3. Steady
 * noise beside it is worth a gamma of noise r^3 / g. */
TEST(the_noise_is_steady_behind_the_antenna)
{
    for (double height_m = 100; height_m < 12000; height_m *= 1.5) {
        const struct ref_receiver r = receiver_at(height_m);
        double least = INFINITY, most = 0;
        for (double slant_m = height_m * 1.15; slant_m < 18520; slant_m += 333) {
            const double s = sqrt(slant_m * slant_m - height_m * height_m);
            const double g = height_m / s - s / (2 * REF_EFFECTIVE_EARTH_M);
            const double received = pow(10, ref_noise_db(&r, slant_m) / 10) * g / pow(slant_m, 3);
            if (g > 1.0 / 256 && g < 2) {
                least = fmin(least, received);
                most = fmax(most, received);
            }
        }
        assert_true(most / least < 1 + 1e-9);
        assert_true(fabs(ref_noise_db(&r, 18520) + 40) < 1e-12);
        /* Through the hole it goes on from the steepest look. */
        const double step_db = ref_noise_db(&r, height_m) - ref_noise_db(&r, height_m * 1.0001);
        assert_true(fabs(step_db) < 0.01);
    }
}

TEST(the_hole_ends_at_the_height_and_cells_are_found_by_pythagoras)
{
    for (double height_m = 0.5; height_m < 12000; height_m *= 3) {
        assert_true(ref_ground_of_slant(height_m, height_m) == 0);
        assert_int_equal(ref_slant_cell(height_m, height_m, 0, 72, 256), 256);
        for (double s = 0.5; s < 18432; s += 71) {
            const double r = hypot(s, height_m);
            assert_true(fabs(ref_ground_of_slant(r, height_m) - s) < 1e-4 * (1 + height_m / s));
            if (fabs(remainder(s, 72)) > 0.5) {
                assert_int_equal(ref_slant_cell(r, height_m, 0, 72, 256), (int)(s / 72));
            }
        }
    }
    assert_int_equal(ref_slant_cell(5000, 100, 6000, 72, 256), 256); /* before the window */
    assert_int_equal(ref_slant_cell(30000, 100, 6000, 72, 256), 256);
}

TEST(levels_are_the_sum_of_signal_and_noise_less_the_time_gains_end)
{
    struct ref_receiver r = receiver_at(3000);
    static double power[256], level_db[256], table_db[REF_SPECKLE_SLICES];
    ref_speckle_table(16, table_db);
    r.noise_table_db = table_db;
    double sum = 0, squares = 0;
    int n = 0;
    for (uint32_t line = 0; line < 64; line++) {
        for (int i = 0; i < 256; i++) {
            power[i] = 0;
        }
        ref_receive(&r, NULL, line, 1, power, level_db);
        for (int i = 0; i < 256; i++, n++) {
            const double slant_m = 36 + 72.0 * i;
            const double fall_db = slant_m > 13890 ? 30 * log10(slant_m / 13890) : 0;
            const double x = pow(10, (level_db[i] + fall_db - ref_noise_db(&r, slant_m)) / 10);
            sum += x;
            squares += x * x;
        }
    }
    assert_true(fabs(sum / n - 1) < 0.01);
    assert_true(fabs(1 / (squares / n - 1) / 16 - 1) < 0.1);
}

/* The regression of ITU-R P.838-3 (03/2005), equations 2 and 3 and tables 1 and 3: sums of bells
 * over log10 of the frequency in GHz. */
struct bell {
    double height, place, width;
};

static double regression(const struct bell *bells, int count, double slope, double start,
                         double ghz)
{
    double sum = slope * log10(ghz) + start;
    for (int i = 0; i < count; i++) {
        const double x = (log10(ghz) - bells[i].place) / bells[i].width;
        sum += bells[i].height * exp(-x * x);
    }
    return sum;
}

TEST(rain_weakens_as_the_recommendation_says_at_10_ghz)
{
    static const struct bell k_bells[] = {{-5.33980, -0.10008, 1.13098},
                                          {-0.35351, 1.26970, 0.45400},
                                          {-0.23789, 0.86036, 0.15354},
                                          {-0.94158, 0.64552, 0.16817}};
    static const struct bell alpha_bells[] = {{-0.14318, 1.82442, -0.55187},
                                              {0.29591, 0.77564, 0.19822},
                                              {0.32177, 0.63773, 0.13164},
                                              {-5.37610, -0.96230, 1.47828},
                                              {16.1721, -3.29980, 3.43990}};
    const double k = pow(10, regression(k_bells, 4, -0.18961, 0.71147, 10));
    const double alpha = regression(alpha_bells, 5, 0.67849, -1.95537, 10);
    print_message("# P.838-3 at 10 GHz: k %.6f, alpha %.6f\n", k, alpha);
    for (double mm_per_h = 1; mm_per_h <= 150; mm_per_h *= 1.3) {
        const double expected = k * pow(mm_per_h, alpha);
        assert_true(fabs(ref_rain_loss_db_km(mm_per_h) / expected - 1) < 0.001);
    }
}

/* 10 mm/h is 39 dBZ by Marshall and Palmer, and pi^5 0.93 10^-18 / l^4 is 2.714e-10 at 3.2 cm. */
TEST(rain_scatters_as_its_reflectivity_factor_says)
{
    const double z = ref_rain_eta(10, 0.032) / 2.714e-10;
    assert_true(fabs(10 * log10(z) - 39.01) < 0.02);
    assert_true(fabs(ref_rain_eta(10, 0.016) / ref_rain_eta(10, 0.032) - 16) < 1e-9);
    assert_true(fabs(log10(ref_rain_eta(100, 0.032) / ref_rain_eta(10, 0.032)) - 1.6) < 1e-9);
}

TEST(a_line_meets_a_circle_in_its_chord)
{
    for (double off_deg = -40; off_deg <= 40; off_deg += 1.7) {
        const struct ref_rain rain = {30000, off_deg, 9000, 10};
        double from_m, to_m;
        const bool is_met = ref_rain_chord(&rain, &from_m, &to_m);
        assert_int_equal(is_met, fabs(off_deg) < asin(0.3) / rad);
        for (int end = 0; is_met && end < 2; end++) {
            const double r = end ? to_m : from_m;
            const double x = 30000 * cos(off_deg * rad) - r, y = 30000 * sin(off_deg * rad);
            assert_true(fabs(hypot(x, y) - 9000) < 1e-6);
        }
    }
}

/* Integrated bin by bin, the rain's losses come to 2 k R^alpha times the chord. */
TEST(what_lies_behind_the_rain_loses_its_whole_chord)
{
    static struct ref_weather_line weather;
    const struct ref_bins bins = {36, 72, 256};
    const struct ref_environment e = {.rain = {{8000, 3, 1700, 25}, {9000, -2, 2500, 5}},
                                      .rain_count = 2};
    ref_weather(&e, 0.0312, 3.3, 4.6, 3000, &bins, &weather);
    double loss_db = 0;
    for (int n = 0; n < 2; n++) {
        double from_m, to_m;
        assert_true(ref_rain_chord(&e.rain[n], &from_m, &to_m));
        loss_db += 2 * ref_rain_loss_db_km(e.rain[n].mm_per_h) * (to_m - from_m) / 1000;
    }
    assert_true(weather.pass[0] == 1 && weather.rain[0] == 0);
    assert_true(fabs(10 * log10(weather.pass[255]) + loss_db) < 1e-9);
    assert_true(weather.rain[255] == 0 && weather.jam == 0);
    /* In the rain: half of a bin's own, so that two neighbours differ by a whole one. */
    const double step_db = 10 * log10(weather.pass[110] / weather.pass[109]);
    const double rate_db = ref_rain_loss_db_km(25) + ref_rain_loss_db_km(5);
    assert_true(fabs(step_db + 2 * rate_db * 0.072) < 1e-9);
}

TEST(a_jammer_has_half_its_power_half_a_beam_off)
{
    const struct ref_jammer axis = {18520, 0, 23}, beside = {18520, 1.65, 23}, far = {37040, 0, 23};
    assert_true(fabs(10 * log10(ref_jam(&axis, 3.3)) - 23) < 1e-9);
    assert_true(fabs(ref_jam(&beside, 3.3) / ref_jam(&axis, 3.3) - 0.5) < 1e-12);
    assert_true(fabs(ref_jam(&far, 3.3) / ref_jam(&axis, 3.3) - 0.25) < 1e-12);
}
