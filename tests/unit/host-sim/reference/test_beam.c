/* The antenna of the reference against closed forms: two-way widths, elevation pattern, tilt. */
#include "check.h"
#include "reference/reference.h"

#include <math.h>

static const double rad = 0.017453292519943295, line_deg = 120.0 / 128;

/* Response to a point in sample 0, drawn at `azimuth_deg`. */
static double point_response(const struct ref_beam *b, double azimuth_deg)
{
    const struct ref_beam_look look = ref_beam_look(b, azimuth_deg);
    return look.first <= 0 && look.first + REF_BEAM_SAMPLES > 0 ? look.weight[-look.first] : 0;
}

static double half_power_deg(const struct ref_beam *b, double middle_deg, double towards)
{
    const double half = point_response(b, middle_deg) / 2;
    double near = 0, far = b->beam_deg;
    for (int i = 0; i < 60; i++) {
        const double off = (near + far) / 2;
        *(point_response(b, middle_deg + towards * off) > half ? &near : &far) = off;
    }
    return near;
}

TEST(a_point_is_smeared_over_the_two_way_beam)
{
    static const double beams_deg[] = {2.2, 3.3, 4.0}, ratios[] = {1, 2, 4, 8, 16, 32, 64, 128};
    double worst = 0;
    for (int n = 0; n < 24; n++) {
        const struct ref_beam b = {beams_deg[n % 3], beams_deg[n % 3] * 2 / 7, ratios[n / 3]};
        const double middle_deg = ref_beam_azimuth_deg(&b, 0);
        const double width_deg =
            half_power_deg(&b, middle_deg, 1) + half_power_deg(&b, middle_deg, -1);
        worst = fmax(worst, fabs(width_deg * sqrt(2) * b.ratio / b.beam_deg - 1));
    }
    print_message("# two-way widths: within %.2f %% of B / (sqrt 2 N)\n", 100 * worst);
    assert_true(worst < 0.02);
}

/* One way it is half power at half the width: the pattern is the square of 2^(-4 x^2). */
TEST(the_pattern_is_the_square_of_one_that_is_half_at_half_its_width)
{
    const struct ref_beam b = {3.3, line_deg, 1};
    assert_true(fabs(ref_beam_pattern(&b, 1.65) - 0.25) < 1e-12);
    assert_true(fabs(ref_beam_pattern(&b, -3.3 / 2 / sqrt(2)) - 0.5) < 1e-12);
}

TEST(samples_lie_where_a_finer_beam_needs_them)
{
    static const struct {
        double ratio, share;
    } cases[] = {{1, 1}, {2, 2}, {4, 4}, {8, 8}, {16, 16}, {32, 32}, {64, 64}};
    for (int n = 0; n < 7; n++) {
        const struct ref_beam b = {3.3, line_deg, cases[n].ratio};
        assert_true(fabs(ref_beam_spacing_deg(&b) * cases[n].share / line_deg - 1) < 1e-12);
        /* Neighbours by less than the smeared beam's width, so that nothing falls between. */
        assert_true(ref_beam_spacing_deg(&b) < 3.3 / sqrt(2) / b.ratio);
        /* What the eight leave out: what lies beyond three and a half spacings. */
        const double end_deg = 3.5 * ref_beam_spacing_deg(&b);
        assert_true(ref_beam_pattern(&b, end_deg) < 0.005);
    }
}

TEST(a_flat_field_stays_flat_and_a_wedge_a_wedge)
{
    const struct ref_beam b = {3.3, line_deg, 1};
    double flat[1] = {7}, wedge[REF_BEAM_SAMPLES][1], sum[1];
    const double *power[REF_BEAM_SAMPLES];
    for (double azimuth_deg = -30; azimuth_deg < 30; azimuth_deg += 0.37) {
        const struct ref_beam_look look = ref_beam_look(&b, azimuth_deg);
        for (int j = 0; j < REF_BEAM_SAMPLES; j++) {
            power[j] = flat;
        }
        ref_beam_sum(&look, power, sum, 1);
        assert_true(fabs(sum[0] - 7) < 1e-12);
        for (int j = 0; j < REF_BEAM_SAMPLES; j++) {
            wedge[j][0] = ref_beam_azimuth_deg(&b, look.first + j);
            power[j] = wedge[j];
        }
        ref_beam_sum(&look, power, sum, 1);
        assert_true(fabs(sum[0] - azimuth_deg) < 0.01);
    }
}

TEST(below_the_fan_and_above_the_axis_the_pattern_is_gaussian)
{
    const struct ref_antenna a = {4.6, 30, 2.2};
    const double b = 4.6 * rad;
    for (double tilt_deg = -20; tilt_deg <= 10; tilt_deg += 2.5) {
        const double high = tan(tilt_deg * rad), low = tan((tilt_deg - 30) * rad);
        for (double t = low; t <= high; t += (high - low) / 9.01) {
            assert_true(ref_elevation_db(&a, tilt_deg, t) == 0);
        }
        for (double e = 0.001; e < 0.12; e += 0.0017) {
            /* Both ways together: -6.02 dB half a beam off. Steps of 1/2048 are part of it. */
            const double exact_db = -80 * log10(2) * pow(e / b, 2);
            const double step_db = 80 * log10(2) * 2 * (e + 1.0 / 4096) / (b * b) / 4096;
            assert_true(fabs(ref_elevation_db(&a, tilt_deg, high + e) - exact_db) <= step_db);
            assert_true(fabs(ref_elevation_db(&a, tilt_deg, low - e) - exact_db) <= step_db);
        }
        assert_true(ref_elevation_db(&a, tilt_deg, high + 0.126) ==
                    ref_elevation_db(&a, tilt_deg, high + 3));
    }
    assert_true(fabs(-80 * log10(2) / 4 + 20 * log10(2)) < 1e-12);
}

/* Seen from the middle of an Earth of 4/3 its radius: the angle of the ground at range R below the
 * horizontal, without the parabola. */
TEST(auto_tilt_points_the_axis_at_the_far_end)
{
    for (double height_m = 150; height_m < 14000; height_m *= 1.6) {
        for (double range_m = 18520; range_m < 150000; range_m *= 2) {
            const double a = REF_EFFECTIVE_EARTH_M, turn = range_m / a;
            const double exact_deg = atan2(a * cos(turn) - a - height_m, a * sin(turn)) / rad;
            assert_true(fabs(ref_auto_tilt_deg(height_m, range_m) - exact_deg) < 0.03);
        }
    }
}

TEST(bars_lie_evenly_about_the_tilt)
{
    const struct ref_antenna a = {4.6, 30, 2.2};
    assert_true(ref_bar_tilt_deg(&a, -3, 0, 1) == -3);
    double sum = 0;
    for (int bar = 0; bar < 4; bar++) {
        sum += ref_bar_tilt_deg(&a, -3, bar, 4);
        assert_true(bar == 0 || fabs(ref_bar_tilt_deg(&a, -3, bar, 4) -
                                     ref_bar_tilt_deg(&a, -3, bar - 1, 4) - 2.2) < 1e-12);
    }
    assert_true(fabs(sum / 4 + 3) < 1e-12);
}

/* Flat ground of one level, seen from 3,000 m through every stage: the hole, then the level. */
TEST(a_line_over_flat_ground_has_its_hole_and_its_level)
{
    enum { CELLS = 256 };
    static struct ref_bin cells[CELLS];
    const struct ref_bin *samples[REF_BEAM_SAMPLES];
    static double level_db[CELLS];
    static const double steady[REF_SPECKLE_SLICES];
    const double ds = 18520.0 / CELLS, height_m = 3000;
    for (int i = 0; i < CELLS; i++) {
        const double s = (i + 0.5) * ds;
        cells[i].is_lit = s > 1500;
        cells[i].echo_db = -12;
        cells[i].tangent = ref_tangent(height_m, s, 0);
    }
    for (int j = 0; j < REF_BEAM_SAMPLES; j++) {
        samples[j] = cells;
    }
    const struct ref_beam beam = {3.3, line_deg, 1};
    struct ref_sector_line line = {.look = ref_beam_look(&beam, 3),
                                   .antenna = {4.6, 60, 2.2},
                                   .tilt_deg = ref_auto_tilt_deg(height_m, 18520),
                                   .cell_m = ds,
                                   .receiver = {.bins = {ds / 2, ds, CELLS},
                                                .height_m = height_m,
                                                .noise = {-60, 18520, height_m, 400e-9},
                                                .noise_table_db = steady,
                                                .stc_m = 13890,
                                                .pulse_s = 400e-9}};
    ref_sector_line(&line, samples, CELLS, NULL, level_db);
    for (int i = 0; i < CELLS; i++) {
        const double r = (i + 0.5) * ds, s = sqrt(fmax(r * r - height_m * height_m, 0));
        if (r <= height_m) {
            assert_true(level_db[i] < -50);
        } else if (s > 1500 + ds) {
            const double expected_db = -12 - fmax(0, 30 * log10(r / 13890));
            assert_true(fabs(level_db[i] - expected_db) < 0.01);
        }
    }
}
