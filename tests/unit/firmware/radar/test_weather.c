/* Rain and jammers along a line, against the closed forms and the reference in double precision:
 * docs/EQUATIONS.md, "Rain" and "Noise". */
#include "check.h"
#include "hs/angle.h"
#include "hs/rng.h"
#include "lm/receiver.h"
#include "lm/status.h"
#include "lm/weather.h"
#include "reference/reference.h"
#include "scales.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { CELLS = 256, HEIGHT_M = 4000 };

struct world {
    struct lm_radar radar;
    struct lm_slant slant;
    struct lm_receiver receiver;
    struct lm_environment environment;
    struct lm_weather weather;
    struct lm_position antenna;
    struct lm_geo_origin origin;
    struct ref_bins bins;
    struct ref_environment ref;
    struct ref_weather_line ref_weather;
};

/* A line of the 40 nautical mile scale seen from 4,000 m, at 46 N 11 E. */
static struct world *make_world(void)
{
    struct world *w = calloc(1, sizeof *w);
    assert_non_null(w);
    const uint32_t cell_q8 = 74080;
    struct lm_range_grid *grid = calloc(1, sizeof *grid);
    assert_non_null(grid);
    w->radar = lm_radar_default;
    lm_range_grid_set(grid, &w->radar.illumination, cell_q8 / 2, cell_q8, CELLS, HEIGHT_M * 1024,
                      0);
    lm_slant_set(&w->slant, cell_q8 / 2, cell_q8, CELLS, grid, cell_q8 / 2);
    lm_receiver_set(&w->receiver, &w->radar, &w->slant, HEIGHT_M * 1024, scale_of(40), LM_FOV_EXP);
    free(grid);
    w->bins = (struct ref_bins){cell_q8 / 512.0, cell_q8 / 256.0, CELLS};
    w->antenna = (struct lm_position){FX_BAM_DEG(46), FX_BAM_DEG(11)};
    lm_geo_set_origin(&w->origin, w->antenna);
    w->environment.sea_state = 3;
    return w;
}

static double bin_m(const struct world *w, uint32_t i)
{
    return w->bins.first_m + i * w->bins.step_m;
}

static struct lm_position place_at(const struct world *w, double distance_m, double azimuth_deg)
{
    return lm_geo_direct(&w->origin, hs_bam(azimuth_deg), (uint32_t)lround(distance_m * 256));
}

/* Both environments get the same; lines are looked at along north. */
static void add_rain(struct world *w, double distance_m, double azimuth_deg, double radius_m,
                     double mm_per_h)
{
    w->environment.rain[w->environment.rain_count++] =
        (struct lm_rain){place_at(w, distance_m, azimuth_deg), (uint32_t)lround(radius_m),
                         (uint16_t)lround(mm_per_h)};
    w->ref.rain[w->ref.rain_count++] =
        (struct ref_rain){distance_m, azimuth_deg, radius_m, mm_per_h};
}

static void add_jammer(struct world *w, double distance_m, double azimuth_deg, double ratio_db)
{
    w->environment.jammer[w->environment.jammer_count++] =
        (struct lm_jammer){place_at(w, distance_m, azimuth_deg), (int16_t)lround(ratio_db * 256)};
    w->ref.jammer[w->ref.jammer_count++] = (struct ref_jammer){distance_m, azimuth_deg, ratio_db};
}

static void look(struct world *w)
{
    assert_int_equal(lm_environment_check(&w->environment), LM_OK);
    lm_weather_line(&w->weather, &w->environment, &w->receiver, &w->radar, w->antenna, 0);
    ref_weather(&w->ref, w->radar.wavelength_um * 1e-6, hs_degrees(w->radar.antenna.azimuth_beam),
                hs_degrees(w->radar.antenna.elevation_beam), HEIGHT_M, &w->bins, &w->ref_weather);
}

static void clear(struct world *w)
{
    w->environment.rain_count = w->environment.jammer_count = 0;
    w->ref.rain_count = w->ref.jammer_count = 0;
}

static double pass_db(const struct world *w, uint32_t i)
{
    return -w->weather.loss_db_q8[i] / 256.0;
}

TEST(fair_weather_has_no_rain_and_costs_no_bin)
{
    struct world *w = make_world();
    memset(&w->weather, 0xa5, sizeof w->weather);
    look(w);
    assert_false(w->weather.has_rain);
    assert_int_equal(w->weather.noise_rise_db_q8, 0);
    for (uint32_t i = 0; i < LM_CELLS_ROOM; i++) {
        assert_int_equal((uint32_t)w->weather.loss_db_q8[i], 0xa5a5a5a5);
        assert_int_equal((uint32_t)w->weather.rain_db_q8[i], 0xa5a5a5a5);
    }
    free(w);
}

/* 2 k R^alpha a kilometre, by hand: nothing before the rain, all of it behind. */
TEST(rain_weakens_what_lies_behind_it_by_the_recommendations_rate)
{
    static const int rates[] = {1, 2, 5, 10, 25, 50, 100, 150};
    struct world *w = make_world();
    for (int n = 0; n < 8; n++) {
        clear(w);
        add_rain(w, 30000, 0, 4000, rates[n]);
        look(w);
        const double behind_db = 2 * 0.01217 * pow(rates[n], 1.2571) * 8;
        assert_true(w->weather.has_rain);
        for (uint32_t i = 0; i < CELLS; i++) {
            const double r = bin_m(w, i);
            if (r < 25800) {
                assert_int_equal(w->weather.loss_db_q8[i], 0);
            } else if (r > 34200) {
                assert_true(fabs(pass_db(w, i) + behind_db) < 0.02 + 0.002 * behind_db);
            } else if (r > 26400 && r < 33600) {
                /* The distance itself is known to 0.2 %. */
                const double so_far_db = behind_db * (r - 26000) / 8000;
                assert_true(fabs(pass_db(w, i) + so_far_db) < 0.02 + behind_db * 60 / 8000);
            }
        }
    }
    free(w);
}

TEST(rain_returns_what_its_drops_scatter)
{
    struct world *w = make_world();
    const double pi = acos(-1.0), wavelength_m = 0.031228;
    for (double mm_per_h = 4; mm_per_h < 100; mm_per_h *= 2) {
        clear(w);
        add_rain(w, 30000, 0, 4000, mm_per_h);
        look(w);
        for (uint32_t i = 0; i < CELLS; i++) {
            const double r = bin_m(w, i), s = sqrt(r * r - 1.0 * HEIGHT_M * HEIGHT_M);
            if (r < 25500 || r > 34500) {
                assert_true(w->weather.rain_db_q8[i] < -150 * 256);
                continue;
            }
            if (r < 26400 || r > 33600) {
                continue;
            }
            const double eta =
                pow(pi, 5) * 0.93 * 200e-18 * pow(mm_per_h, 1.6) / pow(wavelength_m, 4);
            const double g = HEIGHT_M / s - s / (2 * REF_EFFECTIVE_EARTH_M);
            const double fresh_db = 10 * log10(eta * r * 4.6 * pi / 180 / g);
            const double returned_db = w->weather.rain_db_q8[i] / 256.0;
            assert_true(fabs(returned_db - fresh_db - pass_db(w, i)) < 0.03);
        }
    }
    free(w);
}

TEST(any_circles_do_to_a_line_what_the_reference_says)
{
    struct world *w = make_world();
    struct hs_rng rng;
    hs_rng_seed(&rng, 3);
    int hits = 0;
    for (int n = 0; n < 300; n++) {
        clear(w);
        for (int k = 0; k < 1 + n % LM_RAINS_MAX; k++) {
            const double mm_per_h = 1 + hs_rng_below(&rng, 40);
            const double radius_m = round(2000 + 25000 * hs_rng_uniform(&rng));
            const double azimuth_deg = 360 * hs_rng_uniform(&rng);
            add_rain(w, 80000 * hs_rng_uniform(&rng), azimuth_deg, radius_m, mm_per_h);
        }
        look(w);
        hits += w->weather.has_rain;
        double last = 0;
        for (uint32_t i = 0; i < CELLS; i++) {
            const double pass = w->weather.has_rain ? pow(10, pass_db(w, i) / 10) : 1;
            const double rain =
                w->weather.has_rain ? pow(10, w->weather.rain_db_q8[i] / 2560.0) : 0;
            /* Edges are known to 0.2 % of the distance, which is less than a bin (289 m). What a
             * bin returns lies between the neighbours' then. */
            double least = INFINITY, most = last;
            for (uint32_t k = i ? i - 1 : 0; k <= i + 1 && k < CELLS; k++) {
                least = fmin(least, w->ref_weather.rain[k]);
                most = fmax(most, w->ref_weather.rain[k]);
            }
            last = w->ref_weather.rain[i];
            assert_true(fabs(pass - w->ref_weather.pass[i]) < 0.03);
            assert_true(rain > 0.95 * least - 1e-6 && rain < 1.05 * most + 1e-6);
        }
    }
    print_message("# %d of 300 lines meet rain\n", hits);
    assert_in_range(hits, 100, 290);
    free(w);
}

TEST(who_flies_in_the_rain_is_in_it_from_the_first_bin)
{
    struct world *w = make_world();
    add_rain(w, 1000, 180, 9000, 20);
    look(w);
    const double rate_db = 2 * 0.01217 * pow(20, 1.2571) / 1000;
    for (uint32_t i = 0; i < CELLS; i++) {
        const double within_m = fmin(bin_m(w, i), 8000);
        if (fabs(bin_m(w, i) - 8000) > 300) {
            assert_true(fabs(pass_db(w, i) + rate_db * within_m) < 0.02);
        }
        assert_true((w->weather.rain_db_q8[i] > -150 * 256) == (bin_m(w, i) < 8150));
    }
    free(w);
}

TEST(rain_beside_and_behind_the_line_is_not_in_it)
{
    struct world *w = make_world();
    add_rain(w, 30000, 90, 20000, 100);
    add_rain(w, 30000, 180, 20000, 100);
    add_rain(w, 30000, 11, 5000, 100); /* 5.7 km off */
    look(w);
    assert_false(w->weather.has_rain);
    add_rain(w, 30000, 11, 6000, 100);
    look(w);
    assert_true(w->weather.has_rain);
    free(w);
}

TEST(a_strobe_has_the_one_way_pattern_and_falls_with_the_square_of_range)
{
    struct world *w = make_world();
    for (double distance_m = 5000; distance_m < 250000; distance_m *= 1.7) {
        for (double off_deg = -20; off_deg <= 20; off_deg += 0.5) {
            clear(w);
            add_jammer(w, distance_m, off_deg, 40);
            look(w);
            const double x = off_deg / 3.3;
            const double jam_db = 40 - 20 * log10(distance_m / 18520) - 40 * log10(2) * x * x;
            const double rise_db = 10 * log10(1 + pow(10, jam_db / 10));
            /* Bearings are known to a twentieth of a degree at these distances. */
            const double slope = 2 * 40 * log10(2) * fabs(x) / 3.3;
            assert_true(fabs(w->weather.noise_rise_db_q8 / 256.0 - rise_db) < 0.05 + 0.05 * slope);
            assert_true(fabs(10 * log10(1 + w->ref_weather.jam) - rise_db) < 1e-5);
        }
    }
    /* Half power off the axis by half the one-way beam. */
    clear(w);
    add_jammer(w, 18520, 0, 50);
    look(w);
    assert_true(fabs(w->weather.noise_rise_db_q8 / 256.0 - 50) < 0.05);
    clear(w);
    add_jammer(w, 18520, 1.65, 50);
    look(w);
    assert_true(fabs(w->weather.noise_rise_db_q8 / 256.0 - (50 - 10 * log10(2))) < 0.05);
    free(w);
}

TEST(jammers_add_their_powers)
{
    struct world *w = make_world();
    for (uint32_t n = 1; n <= LM_JAMMERS_MAX; n++) {
        add_jammer(w, 18520, 0, 10);
        look(w);
        assert_true(fabs(w->weather.noise_rise_db_q8 / 256.0 - 10 * log10(1 + 10.0 * n)) < 0.08);
    }
    free(w);
}

/* Through the whole receiver: the strobe is brighter the farther out, as the noise is. */
TEST(a_strobe_lifts_the_noise_of_every_bin_alike)
{
    struct world *w = make_world();
    static uint32_t power[LM_CELLS_ROOM];
    static int16_t quiet[LM_CELLS_ROOM], jammed[LM_CELLS_ROOM];
    uint32_t held = 0;
    add_jammer(w, 18520, 0, 30);
    look(w);
    lm_receiver_pulse(&w->receiver, power);
    lm_receiver_run(&w->receiver, NULL, 1, 1, power, quiet);
    lm_receiver_pulse(&w->receiver, power);
    lm_receiver_run(&w->receiver, &w->weather, 1, 1, power, jammed);
    for (uint32_t i = 0; i < CELLS; i++) {
        const int32_t risen_q8 = quiet[i] + w->weather.noise_rise_db_q8;
        /* Near the antenna a deep fade may end at the lowest level. */
        assert_true(quiet[i] == LM_LEVEL_SHADOW || abs(jammed[i] - fx_sat_i16(risen_q8)) <= 1);
        held += quiet[i] == LM_LEVEL_SHADOW;
    }
    assert_true(held < 8);
    free(w);
}

TEST(what_is_far_away_is_not_there)
{
    struct world *w = make_world();
    struct lm_environment *e = &w->environment;
    e->rain_count = LM_RAINS_MAX;
    e->jammer_count = LM_JAMMERS_MAX;
    for (uint32_t n = 0; n < 4; n++) {
        const struct lm_position far = {FX_BAM_DEG(46) + (n & 1 ? hs_bam(11.3) : 0),
                                        FX_BAM_DEG(11) + (n & 2 ? hs_bam(-170) : hs_bam(11.3))};
        e->rain[n] = (struct lm_rain){far, 100000, 150};
        e->jammer[n] = (struct lm_jammer){far, 80 * 256};
    }
    assert_int_equal(lm_environment_check(e), LM_OK);
    lm_weather_line(&w->weather, e, &w->receiver, &w->radar, w->antenna, hs_bam(90));
    assert_false(w->weather.has_rain);
    assert_int_equal(w->weather.noise_rise_db_q8, 0);
    free(w);
}

/* The environment's places are a script's: also the antenna's own, the pole and the antimeridian.
 */
TEST(no_environment_in_range_leaves_the_bounds)
{
    struct world *w = make_world();
    struct hs_rng rng;
    hs_rng_seed(&rng, 15);
    static uint32_t power[LM_CELLS_ROOM];
    static int16_t level[LM_CELLS_ROOM];
    for (int n = 0; n < 2000; n++) {
        struct lm_environment *e = &w->environment;
        w->antenna = (struct lm_position){hs_bam(180 * hs_rng_uniform(&rng) - 90),
                                          hs_bam(360 * hs_rng_uniform(&rng))};
        e->rain_count = (uint8_t)hs_rng_below(&rng, LM_RAINS_MAX + 1);
        e->jammer_count = (uint8_t)hs_rng_below(&rng, LM_JAMMERS_MAX + 1);
        for (int k = 0; k < 4; k++) {
            const double spread = n % 3 ? 1 : 0;
            const struct lm_position near = {
                w->antenna.latitude + hs_bam(spread * hs_rng_normal(&rng)) / 4,
                w->antenna.longitude + hs_bam(spread * hs_rng_normal(&rng))};
            e->rain[k] = (struct lm_rain){near, 100 + hs_rng_below(&rng, 99901),
                                          (uint16_t)(1 + hs_rng_below(&rng, 150))};
            e->jammer[k] =
                (struct lm_jammer){near, (int16_t)((int)hs_rng_below(&rng, 25601) - 5120)};
        }
        lm_weather_line(&w->weather, e, &w->receiver, &w->radar, w->antenna,
                        (fx_bam_t)hs_rng_u64(&rng));
        assert_in_range(w->weather.noise_rise_db_q8, 0, 180 * 256);
        for (uint32_t i = 0; i < CELLS; i++) {
            assert_true(!w->weather.has_rain || w->weather.loss_db_q8[i] >= 0);
            power[i] = UINT32_MAX;
        }
        lm_receiver_pulse(&w->receiver, power);
        lm_receiver_run(&w->receiver, &w->weather, 0, 0, power, level);
        for (uint32_t i = 0; i < CELLS; i++) {
            assert_true(abs(level[i]) < 500 * 256);
        }
    }
    free(w);
}

static int checked(const struct lm_environment *e, struct lm_rain rain, struct lm_jammer jammer)
{
    struct lm_environment changed = *e;
    changed.rain[1] = rain;
    changed.jammer[1] = jammer;
    return lm_environment_check(&changed);
}

TEST(an_environment_out_of_its_ranges_is_refused)
{
    const struct lm_position here = {FX_BAM_DEG(46), FX_BAM_DEG(11)};
    const struct lm_rain rain = {here, 5000, 10};
    const struct lm_jammer jammer = {here, 256};
    const struct lm_environment good = {.rain = {rain, rain},
                                        .jammer = {jammer, jammer},
                                        .rain_count = 2,
                                        .jammer_count = 2,
                                        .sea_state = LM_SEA_STATE_MAX};
    assert_int_equal(lm_environment_check(&good), LM_OK);
    static const struct {
        uint32_t radius_m;
        uint16_t mm_per_h;
        int status;
    } rains[] = {{100, 1, LM_OK},
                 {100000, 150, LM_OK},
                 {99, 10, LM_ERR_RANGE},
                 {100001, 10, LM_ERR_RANGE},
                 {UINT32_MAX, 10, LM_ERR_RANGE},
                 {5000, 0, LM_ERR_RANGE},
                 {5000, 151, LM_ERR_RANGE}};
    for (int n = 0; n < 7; n++) {
        const struct lm_rain r = {here, rains[n].radius_m, rains[n].mm_per_h};
        assert_int_equal(checked(&good, r, jammer), rains[n].status);
    }
    const int16_t ratios[] = {-20 * 256, 80 * 256, -20 * 256 - 1, 80 * 256 + 1};
    const struct lm_position off_earth = {FX_BAM_90 + 1, 0}, below = {(fx_bam_t)-FX_BAM_90 - 1, 0};
    for (int n = 0; n < 4; n++) {
        assert_int_equal(checked(&good, rain, (struct lm_jammer){here, ratios[n]}),
                         n < 2 ? LM_OK : LM_ERR_RANGE);
    }
    assert_int_equal(checked(&good, (struct lm_rain){off_earth, 5000, 10}, jammer), LM_ERR_RANGE);
    assert_int_equal(checked(&good, rain, (struct lm_jammer){below, 256}), LM_ERR_RANGE);
    struct lm_environment bad = good;
    bad.rain_count = LM_RAINS_MAX + 1;
    assert_int_equal(lm_environment_check(&bad), LM_ERR_RANGE);
    bad = good;
    bad.jammer_count = 255;
    assert_int_equal(lm_environment_check(&bad), LM_ERR_RANGE);
    bad = good;
    bad.sea_state = LM_SEA_STATE_MAX + 1;
    assert_int_equal(lm_environment_check(&bad), LM_ERR_RANGE);
}
