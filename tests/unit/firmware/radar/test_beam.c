/* The beam across and along the line, its tilt and its Doppler sharpening, against the reference in
 * double precision and the notch by hand: docs/EQUATIONS.md, "Real beam" and "Doppler beam
 * sharpening".
 */
#include "check.h"
#include "hs/rng.h"
#include "lm/antenna.h"
#include "lm/beam.h"
#include "lm/dbs.h"
#include "reference/reference.h"

#include <math.h>
#include <string.h>

enum { CELLS = 40 };

static const double degrees_per_bam = 360 / 4294967296.0;
static const struct lm_radar *const radar = &lm_radar_default;
static struct lm_beam beam;

static int32_t bam(double degrees)
{
    return (int32_t)lround(degrees / degrees_per_bam);
}

static struct ref_beam ref_of(uint32_t ratio_q8)
{
    return (struct ref_beam){radar->antenna.azimuth_beam * degrees_per_bam,
                             radar->sample * degrees_per_bam, ratio_q8 / 256.0};
}

TEST(weights_are_those_of_the_pattern)
{
    struct hs_rng rng;
    hs_rng_seed(&rng, 31);
    double worst = 0;
    for (int n = 0; n < 4000; n++) {
        const uint32_t ratio_q8 =
            n % 3 ? 256 + hs_rng_below(&rng, 256u << hs_rng_below(&rng, 8)) : 256;
        const int32_t azimuth = bam(120 * hs_rng_uniform(&rng) - 60);
        struct ref_beam ref = ref_of(ratio_q8);
        struct lm_beam_taps taps;
        lm_beam_set_taps(&beam, radar, azimuth, ratio_q8, &taps);
        /* A spacing is a whole number of BAM. */
        ref.line_deg = (double)(lm_beam_spacing(&beam, radar) << beam.fineness) * degrees_per_bam;
        const struct ref_beam_look wanted = ref_beam_look(&ref, azimuth * degrees_per_bam);
        const double place = azimuth * degrees_per_bam / ref_beam_spacing_deg(&ref) + 0.5;
        if (fabs(place - round(place)) < 1e-4) {
            continue; /* on the border between two */
        }
        uint32_t sum = 0;
        assert_int_equal(taps.first, wanted.first);
        for (int j = 0; j < LM_BEAM_TAPS; j++) {
            sum += taps.weight_q16[j];
            worst = fmax(worst, fabs(taps.weight_q16[j] / 65536.0 - wanted.weight[j]));
            const double off_deg = lm_beam_azimuth(&beam, radar, taps.first + j) * degrees_per_bam -
                                   ref_beam_azimuth_deg(&ref, taps.first + j);
            assert_true(fabs(off_deg) < 0.001);
        }
        assert_int_equal(sum, 65536);
    }
    print_message("# weights: within %.1e of a whole\n", worst);
    assert_true(worst < 5e-4);
}

TEST(a_line_is_the_weighted_sum_of_its_samples)
{
    struct hs_rng rng;
    hs_rng_seed(&rng, 32);
    static double power[LM_BEAM_TAPS][CELLS], wanted[CELLS];
    static uint32_t sum[LM_CELLS_ROOM];
    const double *lines[LM_BEAM_TAPS];
    for (int n = 0; n < 50; n++) {
        struct lm_beam_taps taps;
        struct ref_beam_look ref;
        lm_beam_clear(&beam);
        lm_beam_set_taps(&beam, radar, bam(120 * hs_rng_uniform(&rng) - 60), 256u << n % 7, &taps);
        for (int32_t j = 0; j < LM_BEAM_TAPS; j++) {
            assert_false(lm_beam_has(&beam, taps.first + j));
            uint32_t *room = lm_beam_slot(&beam, taps.first + j);
            assert_true(lm_beam_has(&beam, taps.first + j));
            for (int i = 0; i < CELLS; i++) {
                room[i] = n % 5 ? (uint32_t)hs_rng_u64(&rng) >> hs_rng_below(&rng, 32) : UINT32_MAX;
                power[j][i] = room[i];
            }
            lines[j] = power[j];
            ref.weight[j] = taps.weight_q16[j] / 65536.0;
        }
        lm_beam_sum(&beam, &taps, sum, CELLS);
        ref_beam_sum(&ref, lines, wanted, CELLS);
        for (int i = 0; i < CELLS; i++) {
            assert_true(wanted[i] - sum[i] >= -1e-6 * wanted[i] && wanted[i] - sum[i] < 1.001);
        }
    }
}

/* A point in one sample, drawn at every azimuth around it. */
static double response(uint32_t ratio_q8, int32_t azimuth)
{
    struct lm_beam_taps taps;
    lm_beam_set_taps(&beam, radar, azimuth, ratio_q8, &taps);
    return taps.first <= 0 && taps.first + LM_BEAM_TAPS > 0 ? taps.weight_q16[-taps.first] : 0;
}

TEST(a_point_is_as_wide_as_the_beam_over_root_two_and_the_ratio)
{
    for (uint32_t ratio_q8 = 256; ratio_q8 <= 64 * 256; ratio_q8 += 61) {
        response(ratio_q8, 0);
        const int32_t middle = lm_beam_azimuth(&beam, radar, 0);
        const double half = response(ratio_q8, middle) / 2;
        int32_t side[2];
        for (int right = 0; right < 2; right++) {
            int32_t near = 0, far = (int32_t)radar->antenna.azimuth_beam;
            while (far - near > 1) {
                const int32_t off = near + (far - near) / 2;
                *(response(ratio_q8, right ? middle + off : middle - off) > half ? &near : &far) =
                    off;
            }
            side[right] = near;
        }
        const double width = (double)side[0] + side[1];
        const double wanted = radar->antenna.azimuth_beam / sqrt(2) / (ratio_q8 / 256.0);
        assert_true(fabs(width / wanted - 1) < 0.02);
    }
}

/* Sweeps to the right and to the left, from one look to the next by steps of any length. */
TEST(a_look_takes_what_it_lacks_and_no_more)
{
    struct hs_rng rng;
    struct lm_beam_taps taps = {.first = -1000};
    hs_rng_seed(&rng, 33);
    lm_beam_clear(&beam);
    for (int n = 0; n < 5000; n++) {
        const int32_t step = (int32_t)hs_rng_below(&rng, n % 7 == 0 ? 20 : 4);
        taps.first += n / 500 % 2 ? -step : step;
        int32_t missing = 0, sample;
        for (int32_t j = 0; j < LM_BEAM_TAPS; j++) {
            missing += !lm_beam_has(&beam, taps.first + j);
        }
        while (lm_beam_next_missing(&beam, &taps, &sample)) {
            assert_in_range(sample - taps.first, 0, LM_BEAM_TAPS - 1);
            assert_false(lm_beam_has(&beam, sample));
            lm_beam_slot(&beam, sample)[0] = (uint32_t)sample;
            missing--;
        }
        assert_int_equal(missing, 0);
        for (int32_t j = 0; j < LM_BEAM_TAPS; j++) {
            const uint32_t slot = (uint32_t)(taps.first + j) % LM_BEAM_TAPS;
            assert_true(lm_beam_has(&beam, taps.first + j));
            assert_int_equal(beam.power_q24[slot][0], (uint32_t)(taps.first + j));
        }
    }
}

TEST(a_sample_of_another_fineness_is_dropped)
{
    struct lm_beam_taps taps;
    lm_beam_clear(&beam);
    lm_beam_set_taps(&beam, radar, 0, 256, &taps);
    lm_beam_slot(&beam, taps.first + 3);
    lm_beam_set_taps(&beam, radar, 0, 362, &taps); /* below the root of 2 */
    assert_true(lm_beam_has(&beam, taps.first + 3));
    assert_false(lm_beam_has(&beam, taps.first + 3 + LM_BEAM_TAPS)); /* the same slot */
    lm_beam_set_taps(&beam, radar, 0, 363, &taps);
    for (int32_t n = -100; n < 100; n++) {
        assert_false(lm_beam_has(&beam, n));
    }
}

/* The spacing that the ratio's own logarithm is nearest to: 1.7 to 3.6 samples across the beam. */
TEST(samples_are_as_close_as_the_beam_needs)
{
    struct lm_beam_taps taps;
    for (uint32_t ratio_q8 = 256; ratio_q8 <= LM_RADAR_SHARPENING_MAX * 256; ratio_q8 += 23) {
        lm_beam_set_taps(&beam, radar, 0, ratio_q8, &taps);
        const double beam_bam = radar->antenna.azimuth_beam / sqrt(2) / (ratio_q8 / 256.0);
        const double in_beam = beam_bam / lm_beam_spacing(&beam, radar);
        assert_true(in_beam > 1.7 && in_beam < 3.6);
        assert_true(beam.fineness == lround(log2(ratio_q8 / 256.0)) ||
                    fabs(remainder(log2(ratio_q8 / 256.0), 1)) > 0.499);
    }
}

TEST(a_weakened_line_keeps_its_shape)
{
    struct lm_beam_taps taps, weak;
    lm_beam_set_taps(&beam, radar, bam(11), 700, &taps);
    weak = taps;
    lm_beam_weaken(&weak, 65536);
    assert_memory_equal(&weak, &taps, sizeof taps);
    lm_beam_weaken(&weak, 52000);
    for (int j = 0; j < LM_BEAM_TAPS; j++) {
        assert_true(fabs(weak.weight_q16[j] - taps.weight_q16[j] * (52000 / 65536.)) < 1);
    }
}

static struct ref_dbs dbs_of(uint32_t rate_deg_s, uint32_t speed_mm_s)
{
    return (struct ref_dbs){speed_mm_s / 1000.0, radar->antenna.azimuth_beam * degrees_per_bam,
                            radar->wavelength_um * 1e-6, rate_deg_s};
}

TEST(the_ratio_to_be_had_is_that_of_the_formula)
{
    for (uint32_t rate_deg_s = 3; rate_deg_s <= 120; rate_deg_s += 13) {
        for (uint32_t speed_mm_s = 50000; speed_mm_s < 800000; speed_mm_s += 71000) {
            const struct ref_dbs ref = dbs_of(rate_deg_s, speed_mm_s);
            const struct lm_dbs_scan scan = {FX_BAM_DEG(rate_deg_s), speed_mm_s, radar->line};
            for (int off_deg = -180; off_deg < 180; off_deg += 3) {
                const uint32_t ratio_q8 = lm_dbs_ratio_q8(radar, &scan, (fx_bam_t)bam(off_deg));
                const double wanted = fmin(ref_dbs_ratio(&ref, off_deg) * 256, LM_DBS_RATIO_MAX_Q8);
                assert_true(fabs(ratio_q8 - wanted) < 1.5 + 0.001 * wanted);
            }
        }
    }
}

/* Speeds from a light aircraft's to a fast one's, lines from the widest to the narrowest window's,
 * and all angles off the velocity. */
TEST(the_ratio_used_is_that_of_the_equations_and_no_two_lines_differ_by_a_tenth)
{
    static const struct {
        uint32_t wanted, rate_deg_s;
    } fields[] = {{8, 15}, {64, 3}, {13, 60}, {256, 3}};
    static const double lines_deg[] = {0.0258, 0.06, 0.1172};
    double worst_error = 0, worst_step = 0;
    for (int n = 0; n < 12; n++) {
        const uint32_t wanted = fields[n / 3].wanted, rate_deg_s = fields[n / 3].rate_deg_s;
        for (uint32_t speed_mm_s = 30000; speed_mm_s < 900000; speed_mm_s = speed_mm_s * 4 / 3) {
            const struct ref_dbs ref = dbs_of(rate_deg_s, speed_mm_s);
            const double line_deg = lines_deg[n % 3];
            const struct lm_dbs_scan scan = {FX_BAM_DEG(rate_deg_s), speed_mm_s,
                                             (fx_bam_t)bam(line_deg)};
            double before = NAN;
            for (double off_deg = -180; off_deg < 180; off_deg += line_deg) {
                const double used =
                    lm_dbs_sharpening_q8(radar, &scan, wanted, (fx_bam_t)bam(off_deg)) / 256.0;
                const double expected = ref_dbs_used(&ref, off_deg, line_deg, wanted);
                assert_true(used >= 1 && used <= wanted);
                worst_error = fmax(worst_error, fabs(used / expected - 1));
                worst_step = isnan(before) ? 0 : fmax(worst_step, fabs(log(used / before)));
                before = used;
            }
        }
    }
    print_message("# within %.4f of the equations; step between lines at most %.3f\n", worst_error,
                  exp(worst_step) - 1);
    assert_true(worst_error < 0.01);
    assert_true(exp(worst_step) - 1 < 0.1);
}

/* Where the fields' sharpening runs out: within half a degree of the formula, at three speeds. */
TEST(the_notch_opens_where_the_formula_says)
{
    static const uint32_t speeds_mm_s[] = {150000, 250000, 400000};
    static const struct {
        enum lm_fov field;
        uint32_t rate_deg_s;
    } cases[] = {{LM_FOV_DBS1, 15}, {LM_FOV_DBS1, 60}, {LM_FOV_DBS2, 3}, {LM_FOV_DBS2, 15}};
    for (int n = 0; n < 12; n++) {
        const struct lm_fov_row *fov = &radar->fov[cases[n / 3].field];
        const uint32_t rate_deg_s = cases[n / 3].rate_deg_s, speed_mm_s = speeds_mm_s[n % 3];
        const struct ref_dbs ref = dbs_of(rate_deg_s, speed_mm_s);
        const struct lm_dbs_scan scan = {
            FX_BAM_DEG(rate_deg_s), speed_mm_s,
            (fx_bam_t)bam(cases[n / 3].field == LM_FOV_DBS1 ? 0.117 : 0.026)};
        double full_deg = NAN;
        for (double off_deg = 0; off_deg < 90; off_deg += 0.01) {
            const uint32_t used_q8 =
                lm_dbs_sharpening_q8(radar, &scan, fov->sharpening, (fx_bam_t)bam(off_deg));
            if (isnan(full_deg) && used_q8 == fov->sharpening * 256u) {
                full_deg = off_deg;
            }
        }
        const double wanted_deg = ref_dbs_notch_deg(&ref, fov->sharpening);
        const uint32_t ahead_q8 = lm_dbs_sharpening_q8(radar, &scan, fov->sharpening, 0);
        print_message(
            "# %2u:1 at %2u deg/s and %3u m/s: from %.2f degrees, wanted %.2f; %.2f:1 "
            "ahead\n",
            fov->sharpening, rate_deg_s, speed_mm_s / 1000, full_deg, wanted_deg, ahead_q8 / 256.0);
        assert_int_equal(isnan(full_deg) != 0, isnan(wanted_deg) != 0);
        assert_false(fabs(full_deg - wanted_deg) > 0.5);
        assert_true(ahead_q8 < 3 * 256);
    }
}

TEST(lines_between_two_beam_positions_are_as_weak_as_the_pattern)
{
    struct hs_rng rng;
    double worst = 0;
    hs_rng_seed(&rng, 34);
    for (int n = 0; n < 20000; n++) {
        struct lm_fov_row fov = radar->fov[LM_FOV_DBS2];
        fov.beam_step = n % 9 ? (fx_bam_t)bam(0.01 + 3.29 * hs_rng_uniform(&rng)) : 0;
        const int32_t azimuth = bam(120 * hs_rng_uniform(&rng) - 60);
        const uint32_t ratio_q8 = 256 + hs_rng_below(&rng, 255 * 256 + 1);
        const double wanted = ref_dbs_scallop(radar->antenna.azimuth_beam * degrees_per_bam,
                                              fov.beam_step * degrees_per_bam, ratio_q8 / 256.0,
                                              azimuth * degrees_per_bam);
        const double got = lm_dbs_scallop_q16(radar, &fov, ratio_q8, azimuth) / 65536.0;
        worst = fmax(worst, fabs(got - wanted));
    }
    print_message("# scalloping: within %.1e\n", worst);
    assert_true(worst < 1e-3);
}

TEST(each_look_is_weighed_at_its_own_tangent)
{
    static struct lm_range_grid grid;
    static struct lm_lit_line lit;
    struct lm_antenna_pattern pattern;
    const struct ref_antenna ref = {radar->antenna.elevation_beam * degrees_per_bam,
                                    radar->antenna.fan * degrees_per_bam,
                                    radar->antenna.bar_spacing * degrees_per_bam};
    lm_antenna_pattern_set(&pattern, &radar->antenna);
    double worst_db = 0;
    for (double height_m = 300; height_m < 12000; height_m *= 2) {
        lm_range_grid_set(&grid, &radar->illumination, 256 * 36, 256 * 72, 256,
                          (int32_t)lround(height_m * 1024), 0);
        for (double tilt_deg = -35; tilt_deg <= 25; tilt_deg += 2.3) {
            const struct lm_antenna_fan fan = lm_antenna_fan_at(bam(tilt_deg), radar->antenna.fan);
            for (uint32_t i = 0; i < 256; i++) {
                const double tangent = ref_tangent(height_m, 36 + 72.0 * i, 0);
                lit.level_db_q8[i] = 0;
                lit.horizon[i + 1] =
                    (int32_t)fmax(ldexp(tangent, (int)grid.tangent_bits), INT32_MIN);
            }
            lm_antenna_pattern_apply(&pattern, &fan, &grid, &lit);
            for (uint32_t i = grid.first; i < 256; i++) {
                const double tangent = ref_tangent(height_m, 36 + 72.0 * i, 0);
                /* On a step's edge either is right. */
                const double a = ref_elevation_db(&ref, tilt_deg, tangent - 1.2e-5);
                const double b = ref_elevation_db(&ref, tilt_deg, tangent + 1.2e-5);
                const double least_db = fmax(fmin(a, b), -96), most_db = fmax(fmax(a, b), -96);
                const double shown_db = lit.level_db_q8[i] / 256.0;
                worst_db = fmax(worst_db, fmax(shown_db - most_db, least_db - shown_db));
            }
        }
    }
    print_message("# elevation pattern: worst error %.3f dB\n", worst_db);
    assert_true(worst_db < 0.1);
}

TEST(auto_tilt_is_that_of_the_reference)
{
    for (int32_t height_m = -200; height_m < 15000; height_m += 379) {
        for (uint32_t range_m = 2000; range_m < 200000; range_m = range_m * 4 / 3) {
            const double tilt_deg = lm_antenna_auto_tilt(height_m, range_m) * degrees_per_bam;
            assert_true(fabs(tilt_deg - ref_auto_tilt_deg(height_m, range_m)) < 0.03);
        }
    }
}

/* What no sharpening makes of a beam: a ratio below one, and one that leaves nothing beyond the
 * nearest sample. */
TEST(weights_of_any_ratio_add_up_to_one)
{
    for (uint32_t ratio_q8 = 1; ratio_q8 <= 1u << 16; ratio_q8 += 1 + ratio_q8 / 8) {
        struct lm_beam b;
        struct lm_beam_taps taps;
        uint32_t sum = 0;
        lm_beam_clear(&b);
        lm_beam_set_taps(&b, &lm_radar_default, 12345678, ratio_q8, &taps);
        for (int j = 0; j < LM_BEAM_TAPS; j++) {
            sum += taps.weight_q16[j];
        }
        assert_int_equal(sum, 65536);
        if (ratio_q8 < 181) { /* the root of 1/2 */
            assert_int_equal(b.fineness, 0);
        }
    }
}

TEST(an_antenna_without_a_beam_has_no_gain)
{
    struct lm_antenna_pattern pattern;
    const struct lm_antenna_table table = {.elevation_beam = 1};
    lm_antenna_pattern_set(&pattern, &table);
    for (int n = 0; n < LM_ANTENNA_PATTERN_STEPS; n++) {
        assert_int_equal(pattern.gain_db_q8[n], -96 * 256);
    }
}

/* The narrowest beam that counts, 1/180 degree, with samples nearly a degree apart. */
TEST(a_line_between_two_samples_of_a_needle_s_beam_is_the_nearest_one)
{
    struct lm_radar needle = lm_radar_default;
    struct lm_beam b;
    struct lm_beam_taps taps;
    needle.antenna.azimuth_beam = 1;
    lm_beam_clear(&b);
    lm_beam_set_taps(&b, &needle, 12345678, 256, &taps);
    for (int j = 0; j < LM_BEAM_TAPS; j++) {
        assert_int_equal(taps.weight_q16[j], j == LM_BEAM_TAPS / 2 ? 65536 : 0);
    }
}
