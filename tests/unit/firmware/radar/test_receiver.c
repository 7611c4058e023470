/* Slant range and the receiver of a real-beam line, against the double-precision reference and
 * theory: docs/EQUATIONS.md, "Real beam". */
#include "check.h"
#include "hs/rng.h"
#include "lm/receiver.h"
#include "reference_support.h"
#include "scales.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { CELLS = 256 };

struct world {
    struct lm_radar radar;
    struct lm_range_grid grid;
    struct lm_slant slant;
    struct lm_receiver receiver;
    uint32_t power[LM_CELLS_ROOM];
    int16_t level[LM_CELLS_ROOM];
    struct ref_receiver ref;
    double noise_table_db[REF_SPECKLE_SLICES]; /* of the default table's looks */
};

/* Bins of cell_m from near_m on, over flat ground height_m below, on scale `range` in NORM with a
 * pulse of its own. */
static void set_world(struct world *w, uint8_t range, double near_m, double cell_m, uint32_t cells,
                      double height_m, uint32_t pulse_ns)
{
    const uint32_t cell_q8 = (uint32_t)lround(cell_m * 256);
    const uint32_t first_q8 = (uint32_t)lround(near_m * 256) + cell_q8 / 2;
    const int32_t height_q10 = (int32_t)lround(height_m * 1024);
    lm_range_grid_set(&w->grid, &w->radar.illumination, first_q8, cell_q8, cells, height_q10, 0);
    lm_slant_set(&w->slant, first_q8, cell_q8, cells, &w->grid, first_q8);
    const struct ref_bins bins = {first_q8 / 256.0, cell_q8 / 256.0, cells};
    w->radar.range[range].pulse_ns[LM_FOV_NORM] = pulse_ns;
    lm_receiver_set(&w->receiver, &w->radar, &w->slant, height_q10, range, LM_FOV_NORM);
    w->ref = ref_receiver_of(&w->radar, range, LM_FOV_NORM, bins, height_m, w->noise_table_db);
}

/* The whole line of a scale. */
static void set_scale(struct world *w, uint8_t range, double height_m, uint32_t pulse_ns)
{
    const double range_m = lm_radar_default.range[range].range_m;
    w->radar = lm_radar_default;
    set_world(w, range, 0, range_m / CELLS, CELLS, height_m, pulse_ns);
}

static double bin_m(const struct world *w, uint32_t i)
{
    return w->ref.bins.first_m + i * w->ref.bins.step_m;
}

static struct world *make_world(void)
{
    struct world *w = calloc(1, sizeof *w);
    assert_non_null(w);
    ref_speckle_table(1u << lm_radar_default.receiver.noise_looks_log2, w->noise_table_db);
    return w;
}

TEST(a_bin_nearer_than_the_height_has_no_ground_and_the_next_one_has)
{
    struct world *w = make_world();
    for (double height_m = 50; height_m < 15000; height_m *= 1.37) {
        set_scale(w, 0, height_m, 400);
        for (uint32_t i = 0; i < CELLS; i++) {
            w->level[i] = 0;
        }
        lm_slant_run(&w->slant, &w->grid, w->level, w->power);
        for (uint32_t i = 0; i < CELLS; i++) {
            if (bin_m(w, i) <= height_m) {
                assert_int_equal(w->slant.cell_of[i], CELLS);
                assert_in_range(w->power[i], 0, 1); /* the smallest power there is */
            } else {
                assert_int_equal(w->power[i], 1 << 24);
            }
        }
    }
    free(w);
}

TEST(a_bin_takes_the_cell_that_its_slant_range_lies_over)
{
    struct world *w = make_world();
    struct hs_rng rng;
    hs_rng_seed(&rng, 12);
    for (int n = 0; n < 200; n++) {
        const double cell_m = 10 + 600 * hs_rng_uniform(&rng);
        const double near_m = n % 2 ? 60000 * hs_rng_uniform(&rng) : 0;
        const double height_m = 15000 * hs_rng_uniform(&rng);
        w->radar = lm_radar_default;
        set_world(w, scale_of(80), near_m, cell_m, CELLS, height_m, 400);
        const double edge_m = (w->slant.first_m_q8 - w->grid.cell_m_q8 / 2) / 256.0;
        for (uint32_t i = 0; i < CELLS; i++) {
            /* Heights and ranges are rounded to 1/256 m. */
            const double least_m = ref_ground_of_slant(bin_m(w, i), height_m + 0.005) - 0.005;
            const double most_m = ref_ground_of_slant(bin_m(w, i), height_m - 0.005) + 0.005;
            const double least = floor((least_m - edge_m) / w->ref.bins.step_m);
            const double most = floor((most_m - edge_m) / w->ref.bins.step_m);
            if (least == most && least_m > 0 && least >= 0 && least < CELLS) {
                assert_int_equal(w->slant.cell_of[i], least);
                assert_int_equal(w->slant.cell_of[i], ref_slant_cell(bin_m(w, i), height_m, edge_m,
                                                                     w->ref.bins.step_m, CELLS));
            }
            assert_in_range(w->slant.cell_of[i], 0, CELLS);
        }
    }
    free(w);
}

TEST(slant_and_ground_range_are_each_others_inverse)
{
    for (double height_m = -400; height_m < 20000; height_m += 777) {
        for (double ground_m = 300; ground_m < 300000; ground_m *= 1.1) {
            const int32_t height_q10 = (int32_t)lround(height_m * 1024);
            const uint32_t slant_q8 =
                lm_slant_of_ground_m_q8((uint32_t)lround(ground_m * 256), height_q10);
            assert_true(fabs(slant_q8 / 256.0 - hypot(ground_m, height_m)) < 0.02);
            const uint32_t ground_q8 = lm_ground_of_slant_m_q8(slant_q8, height_q10);
            /* A slant range cut by 1/256 m is worth r / s times as much on the ground. */
            assert_true(fabs(ground_q8 / 256.0 - ground_m) <
                        0.02 * hypot(ground_m, height_m) / ground_m);
        }
    }
}

/* Mean noise of a bin as the display shows it before the STC's end, and that of the reference. */
static double noise_db(const struct world *w, uint32_t i)
{
    const double air_db = w->ref.air_loss_db_km * bin_m(w, i) / 1000;
    return w->receiver.noise_db_q8[i] / 256.0 - air_db;
}

TEST(the_mean_noise_is_that_of_the_cube_of_range_over_flat_grounds_grazing)
{
    struct world *w = make_world();
    double worst_db = 0;
    for (uint8_t range = 0; range < lm_radar_default.ranges; range++) {
        for (double height_m = -100; height_m < 15000; height_m += 833) {
            set_scale(w, range, height_m, 100 + (uint32_t)(height_m + 100) / 2 * range);
            for (uint32_t i = 0; i < CELLS; i++) {
                const double expected_db = ref_noise_db(&w->ref, bin_m(w, i));
                worst_db = fmax(worst_db, fabs(noise_db(w, i) - expected_db));
            }
        }
        /* From a metre up g is 1/256 all the way, and what is left is 30 dB a decade. */
        set_scale(w, range, 1, 400);
        const double decade_db = noise_db(w, 254) - noise_db(w, 25);
        assert_true(fabs(decade_db - 30 * log10(254.5 / 25.5)) < 0.03);
    }
    print_message("# mean noise: worst error %.4f dB\n", worst_db);
    assert_true(worst_db < 0.015);
    free(w);
}

/* The radar equation by hand, from 3,000 m: r^3, the grazing of flat ground on an Earth of 4/3
 * its radius, and the square of a simple pulse's length. */
TEST(one_anchor_gives_the_noise_at_the_end_of_every_scale)
{
    static const struct {
        int32_t range_nm;
        double noise_db, farmland_db; /* farmland of -15 dB over it, behind the air */
    } ends[] = {{10, -40, 24.5}, {20, -35.8, 19.9}, {40, -33.5, 16.7}, {80, -25.5, 6.9}};
    struct world *w = make_world();
    for (size_t n = 0; n < sizeof ends / sizeof *ends; n++) {
        const uint8_t range = scale_of(ends[n].range_nm);
        set_scale(w, range, 3000, lm_radar_default.range[range].pulse_ns[LM_FOV_NORM]);
        const double end_db = noise_db(w, CELLS - 1);
        const double farmland_db = -15 - w->receiver.noise_db_q8[CELLS - 1] / 256.0;
        print_message("# %d nm: noise %.1f dB, farmland %.1f dB over it\n", ends[n].range_nm,
                      end_db, farmland_db);
        assert_true(fabs(end_db - ends[n].noise_db) < 0.15); /* half a bin nearer */
        assert_true(fabs(farmland_db - ends[n].farmland_db) < 0.15);
    }
    free(w);
}

/* Signal of 0 dB over little noise, at the end of the longest scale: 148 km of air. */
TEST(clear_air_weakens_what_returns_and_not_the_noise)
{
    struct world *w = make_world();
    const uint8_t range = scale_of(80);
    int32_t with_air_q8[CELLS];
    for (int has_air = 1; has_air >= 0; has_air--) {
        w->radar = lm_radar_default;
        w->radar.range[range].stc_end_m = 400000;
        w->radar.receiver.air_loss_db_per_km_q16 = has_air ? 1592 : 0;
        for (int has_signal = 0; has_signal < 2; has_signal++) {
            set_world(w, range, 0, 148160.0 / CELLS, CELLS, 3000, 6400);
            for (uint32_t i = 0; i < CELLS; i++) {
                w->power[i] = has_signal ? 1u << 31 : 0;
            }
            lm_receiver_pulse(&w->receiver, w->power);
            lm_receiver_run(&w->receiver, NULL, 0, 0, w->power, w->level);
            const double loss_db = has_signal ? 3.6 / 148160 * bin_m(w, 200) : 0;
            const int32_t level_q8 = w->level[200];
            with_air_q8[has_signal] = has_air ? level_q8 : with_air_q8[has_signal];
            if (!has_air) {
                const double fall_db = (level_q8 - with_air_q8[has_signal]) / 256.0;
                assert_true(fabs(fall_db - loss_db) < 0.06);
            }
        }
    }
    free(w);
}

/* First bin whose noise is far above the lowest level, which a deep fade would end at. */
static uint32_t first_with_noise(const struct lm_receiver *r)
{
    uint32_t i = 0;
    while (r->noise_db_q8[i] < -90 * 256) {
        i++;
    }
    return i;
}

/* Noise alone, of many lines: each bin's power in units of its own mean. */
TEST(the_noise_has_its_mean_and_its_number_of_looks)
{
    struct world *w = make_world();
    enum { LINES = 256 };
    for (uint8_t looks_log2 = 0; looks_log2 <= LM_NOISE_LOOKS_LOG2_MAX; looks_log2++) {
        w->radar = lm_radar_default;
        w->radar.receiver.noise_looks_log2 = looks_log2;
        w->radar.receiver.air_loss_db_per_km_q16 = 0;
        w->radar.range[scale_of(10)].stc_end_m = 100000;
        set_world(w, scale_of(10), 0, 72, CELLS, 3000, 400);
        const uint32_t begin = first_with_noise(&w->receiver), bins = CELLS - begin;
        double sum = 0, squares = 0, pairs = 0, columns = 0, before[CELLS] = {0};
        for (uint32_t line = 0; line < LINES; line++) {
            double last = 0;
            memset(w->power, 0, sizeof w->power);
            lm_receiver_pulse(&w->receiver, w->power);
            lm_receiver_run(&w->receiver, NULL, line, 17, w->power, w->level);
            for (uint32_t i = begin; i < CELLS; i++) {
                const double x = pow(10, (w->level[i] - w->receiver.noise_db_q8[i]) / 2560.0);
                sum += x;
                squares += x * x;
                pairs += x * last;
                columns += x * before[i];
                last = before[i] = x;
            }
        }
        const double n = (double)LINES * bins, mean = sum / n, variance = squares / n - mean * mean;
        print_message("# noise of %2d looks: mean %.4f, ENL %.2f\n", 1 << looks_log2, mean,
                      mean * mean / variance);
        assert_true(fabs(mean - 1) < 0.02);
        assert_true(fabs(mean * mean / variance / (1 << looks_log2) - 1) < 0.1);
        /* Along and across the line it is independent: five deviations of the correlation. */
        assert_true(fabs((pairs / n * bins / (bins - 1) - mean * mean) / variance) < 5 / sqrt(n));
        assert_in_range(bins, CELLS * 3 / 4, CELLS);
        assert_true(fabs((columns / n * LINES / (LINES - 1) - mean * mean) / variance) <
                    5 / sqrt(n));
    }
    free(w);
}

TEST(another_sweep_has_other_noise_and_the_same_one_the_same)
{
    struct world *w = make_world();
    int16_t first[CELLS];
    set_scale(w, 1, 5000, 400);
    lm_receiver_pulse(&w->receiver, w->power);
    lm_receiver_run(&w->receiver, NULL, 3, 9, w->power, w->level);
    memcpy(first, w->level, sizeof first);
    for (uint32_t sweep = 9; sweep < 12; sweep++) {
        memset(w->power, 0, sizeof w->power);
        lm_receiver_pulse(&w->receiver, w->power);
        lm_receiver_run(&w->receiver, NULL, 3, sweep, w->power, w->level);
        int same = 0;
        for (uint32_t i = 0; i < CELLS; i++) {
            same += w->level[i] == first[i];
        }
        assert_true(sweep == 9 ? same == CELLS : same < 10);
    }
    free(w);
}

/* Powers behind the pulse, taken from the levels: the noise is turned off, and the time gain's end
 * lies beyond the line. */
static void set_pulse_only(struct world *w, double cell_m, uint32_t pulse_ns)
{
    w->radar = lm_radar_default;
    w->radar.receiver.noise_db_q8 = -120 * 256;
    w->radar.receiver.air_loss_db_per_km_q16 = 0;
    w->radar.range[scale_of(80)].stc_end_m = 400000;
    set_world(w, scale_of(80), 0, cell_m, CELLS, 3000, pulse_ns);
}

TEST(a_pulse_keeps_the_energy_and_is_as_wide_as_it_is_long)
{
    struct world *w = make_world();
    static const uint32_t pulses_ns[] = {100, 400, 1000, 3200, 6400};
    for (int n = 0; n < 5; n++) {
        const double pulse_m = ref_pulse_m(pulses_ns[n] * 1e-9);
        for (double bins = 1.01; bins < 9; bins += 0.13) {
            set_pulse_only(w, pulse_m / bins, pulses_ns[n]);
            memset(w->power, 0, sizeof w->power);
            w->power[100] = 1 << 24;
            lm_receiver_pulse(&w->receiver, w->power);
            lm_receiver_run(&w->receiver, NULL, 0, 0, w->power, w->level);
            double sum = 0, highest = 0;
            for (uint32_t i = 0; i < CELLS; i++) {
                sum += w->power[i];
                highest = fmax(highest, w->power[i]);
            }
            assert_true(fabs(sum / (1 << 24) - 1) < 1e-4);
            assert_true(fabs(sum / highest * w->ref.bins.step_m / pulse_m - 1) < 0.05);
        }
    }
    free(w);
}

TEST(a_pulse_means_its_bins_as_the_equations_say)
{
    struct world *w = make_world();
    struct hs_rng rng;
    hs_rng_seed(&rng, 5);
    static double power[CELLS];
    for (int n = 0; n < 100; n++) {
        const uint32_t pulse_ns = hs_rng_below(&rng, 20000);
        set_pulse_only(w, 20 + 600 * hs_rng_uniform(&rng), pulse_ns);
        for (uint32_t i = 0; i < CELLS; i++) {
            w->power[i] = n % 10 ? (uint32_t)hs_rng_u64(&rng) : UINT32_MAX;
            power[i] = w->power[i];
        }
        lm_receiver_pulse(&w->receiver, w->power);
        lm_receiver_run(&w->receiver, NULL, 0, 0, w->power, w->level);
        ref_pulse(power, CELLS, ref_pulse_m(pulse_ns * 1e-9) / w->ref.bins.step_m);
        for (uint32_t i = 0; i < CELLS; i++) {
            assert_true(fabs(w->power[i] - power[i]) < 16 + 2e-4 * UINT32_MAX);
        }
    }
    free(w);
}

TEST(a_pulse_not_longer_than_a_bin_changes_nothing)
{
    struct world *w = make_world();
    set_pulse_only(w, 60, 400); /* 59.96 m */
    for (uint32_t i = 0; i < CELLS; i++) {
        w->power[i] = i * 7919;
    }
    lm_receiver_pulse(&w->receiver, w->power);
    lm_receiver_run(&w->receiver, NULL, 0, 0, w->power, w->level);
    for (uint32_t i = 0; i < CELLS; i++) {
        assert_int_equal(w->power[i], i * 7919);
    }
    free(w);
}

TEST(behind_the_time_gains_end_levels_fall_by_30_decibels_a_decade)
{
    struct world *w = make_world();
    for (uint8_t range = 0; range < lm_radar_default.ranges; range++) {
        set_scale(w, range, 4000, 100); /* shorter than any bin */
        const double stc_m = lm_radar_default.range[range].stc_end_m;
        w->radar.receiver.noise_db_q8 = -100 * 256;
        w->radar.receiver.air_loss_db_per_km_q16 = 0;
        set_world(w, range, 0, lm_radar_default.range[range].range_m / (double)CELLS, CELLS, 4000,
                  10);
        for (uint32_t i = 0; i < CELLS; i++) {
            w->power[i] = 1 << 24;
        }
        lm_receiver_pulse(&w->receiver, w->power);
        lm_receiver_run(&w->receiver, NULL, 0, 0, w->power, w->level);
        for (uint32_t i = 0; i < CELLS; i++) {
            const double fall_db = fmax(0, 30 * log10(bin_m(w, i) / stc_m));
            assert_true(fabs(w->receiver.fall_db_q8[i] / 256.0 - fall_db) < 0.005);
            assert_true(bin_m(w, i) > stc_m || w->receiver.fall_db_q8[i] == 0);
            assert_true(fabs(w->level[i] / 256.0 + fall_db) < 0.05);
        }
    }
    free(w);
}

TEST(levels_are_those_of_the_reference)
{
    struct world *w = make_world();
    struct hs_rng rng;
    hs_rng_seed(&rng, 8);
    static struct lm_weather weather;
    static struct ref_weather_line ref_weather;
    static double power[CELLS], level_db[CELLS];
    double worst_db = 0;
    int compared = 0;
    for (uint32_t line = 0; line < 64; line++) {
        const uint8_t range = (uint8_t)(line % lm_radar_default.ranges);
        set_scale(w, range, 200 + 10000 * hs_rng_uniform(&rng),
                  lm_radar_default.range[range].pulse_ns[LM_FOV_NORM]);
        weather.has_rain = line % 3 == 0;
        weather.noise_rise_db_q8 = (int32_t)hs_rng_below(&rng, 40 * 256);
        ref_weather.jam = pow(10, weather.noise_rise_db_q8 / 2560.0) - 1;
        for (uint32_t i = 0; i < CELLS; i++) {
            w->power[i] = (uint32_t)(hs_rng_u64(&rng) >> (32 + hs_rng_below(&rng, 30)));
            power[i] = ldexp(w->power[i], -24);
            weather.loss_db_q8[i] = (int32_t)hs_rng_below(&rng, 60 * 256);
            weather.rain_db_q8[i] = (int32_t)hs_rng_below(&rng, 60 * 256) - 60 * 256;
            ref_weather.pass[i] = weather.has_rain ? pow(10, -weather.loss_db_q8[i] / 2560.0) : 1;
            ref_weather.rain[i] = weather.has_rain ? pow(10, weather.rain_db_q8[i] / 2560.0) : 0;
        }
        lm_receiver_pulse(&w->receiver, w->power);
        lm_receiver_run(&w->receiver, &weather, line, 5, w->power, w->level);
        ref_receive(&w->ref, &ref_weather, line, 5, power, level_db);
        for (uint32_t i = 0; i < CELLS; i++) {
            /* The shares of a pulse are cut to steps of 2^-24, ten in all: 0.01 dB at -36 dB. */
            const double sum_db = level_db[i] + ref_stc_fall_db(&w->ref, bin_m(w, i));
            const double step_db = 10 * log10(1 + 10 * pow(2, -24) / pow(10, sum_db / 10));
            const double error_db = fabs(w->level[i] / 256.0 - level_db[i]);
            if (sum_db < -50) {
                continue;
            }
            compared++;
            worst_db = fmax(worst_db, error_db - step_db);
        }
    }
    print_message("# levels: worst error %.4f dB of %d\n", worst_db, compared);
    assert_true(compared > 60 * CELLS);
    assert_true(worst_db < 0.05);
    free(w);
}

TEST(whatever_the_table_says_levels_stay_in_their_bounds)
{
    struct world *w = make_world();
    struct hs_rng rng;
    hs_rng_seed(&rng, 6);
    static const uint32_t pulses_ns[] = {10, 11, 1000, 60000, 100000};
    for (int n = 0; n < 400; n++) {
        w->radar = lm_radar_default;
        w->radar.receiver.noise_db_q8 = n % 2 ? 20 * 256 : -100 * 256;
        w->radar.receiver.noise_range_m = 1852 + hs_rng_below(&rng, 198149);
        w->radar.receiver.noise_height_m = (uint16_t)hs_rng_below(&rng, 30001);
        w->radar.receiver.noise_pulse_ns = pulses_ns[hs_rng_below(&rng, 5)];
        w->radar.receiver.air_loss_db_per_km_q16 = (uint16_t)hs_rng_below(&rng, (1 << 14) + 1);
        w->radar.range[scale_of(80)].code_gain_db_q8[LM_FOV_NORM] =
            (uint16_t)hs_rng_below(&rng, 40 * 256 + 1);
        w->radar.range[scale_of(80)].stc_end_m = n % 3 ? hs_rng_below(&rng, 400000) : 0;
        w->radar.receiver.noise_looks_log2 = (uint8_t)hs_rng_below(&rng, 256);
        w->radar.antenna.elevation_beam = n % 5 ? (fx_bam_t)hs_rng_u64(&rng) : 0;
        const uint32_t cells = hs_rng_below(&rng, LM_CELLS_MAX + 1);
        const double cell_m = n % 7 ? 700 * hs_rng_uniform(&rng) + 0.01 : 0.004;
        const double height_m = 60000 * hs_rng_uniform(&rng) - 30000;
        const double near_m = n % 2 ? 0 : 20000 * hs_rng_uniform(&rng);
        set_world(w, scale_of(80), near_m, cell_m, cells, height_m, pulses_ns[n % 5]);
        uint32_t total = w->receiver.weight_q16[0];
        for (int m = 1; m <= LM_PULSE_REACH_MAX; m++) {
            total += 2 * w->receiver.weight_q16[m];
        }
        assert_int_equal(total, 65536);
        for (uint32_t i = 0; i < LM_CELLS_ROOM; i++) {
            w->power[i] = n % 4 ? UINT32_MAX : 0;
            w->level[i] = 12345;
        }
        lm_receiver_pulse(&w->receiver, w->power);
        lm_receiver_run(&w->receiver, NULL, UINT32_MAX, UINT32_MAX, w->power, w->level);
        for (uint32_t i = 0; i < LM_CELLS_ROOM; i++) {
            assert_true(i < cells ? abs(w->level[i]) < 500 * 256 : w->level[i] == 12345);
        }
    }
    free(w);
}
