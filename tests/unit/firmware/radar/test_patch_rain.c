/* Rain over a patch against the closed forms and the reference in double precision:
 * docs/EQUATIONS.md, "Rain over a patch". */
#include "hs/angle.h"
#include "hs/rng.h"
#include "lm/patch_rain.h"
#include "lm/sar.h"

#include "check.h"
#include "reference_support.h"
#include "target_support.h"
#include "tiny_map.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { LINES = 256, CELLS = LINES };

static const double wavelength_m = 0.031228;

/* A patch of 5 m cells 30 km away, seen from 5,000 m above it. */
struct world {
    struct lm_radar radar;
    struct lm_patch_geometry geometry;
    struct lm_patch_rain rain;
    struct lm_environment environment;
    struct lm_position antenna;
    struct lm_geo_origin origin;
    struct ref_patch_rain ref;
    struct ref_view view;
};

static struct world *make_world(double range_m, double height_m, double cell_m)
{
    struct world *w = calloc(1, sizeof *w);
    assert_non_null(w);
    w->radar = lm_radar_default;
    w->antenna = (struct lm_position){FX_BAM_DEG(46), FX_BAM_DEG(11)};
    lm_geo_set_origin(&w->origin, w->antenna);
    w->geometry = (struct lm_patch_geometry){
        .centre = lm_geo_direct(&w->origin, 0, (uint32_t)lround(range_m * 256)),
        .centre_m_q8 = (uint32_t)lround(range_m * 256),
        .cell_m_q8 = (uint32_t)lround(cell_m * 256),
        .lines = LINES,
        .cells = CELLS,
        .heights = {.antenna_m_q10 = (int32_t)lround(height_m * 1024)},
        .wavelength_um = w->radar.wavelength_um,
    };
    w->view = (struct ref_view){height_m, 0, cell_m};
    w->ref = (struct ref_patch_rain){
        .wavelength_m = wavelength_m,
        .azimuth_beam_deg = hs_degrees(w->radar.antenna.azimuth_beam),
        .elevation_beam_deg = hs_degrees(w->radar.antenna.elevation_beam),
        .slant = hypot(range_m, height_m) / range_m,
    };
    return w;
}

static void add_rain(struct world *w, double distance_m, double off_deg, double radius_m,
                     double mm_per_h)
{
    const struct lm_position centre =
        lm_geo_direct(&w->origin, hs_bam(off_deg), (uint32_t)lround(distance_m * 256));
    w->environment.rain[w->environment.rain_count++] =
        (struct lm_rain){centre, (uint32_t)lround(radius_m), (uint16_t)lround(mm_per_h)};
    struct ref_environment *e = &w->ref.environment;
    e->rain[e->rain_count++] = (struct ref_rain){distance_m, off_deg, radius_m, mm_per_h};
}

static void look(struct world *w)
{
    lm_patch_rain_find(&w->rain, &w->environment, &w->radar, w->antenna, 0);
    lm_patch_rain_set(&w->rain, &w->radar, &w->geometry, w->radar.sar.noise_floor_db_q8);
}

static double across_m(const struct world *w, uint32_t line)
{
    return (line + 0.5 - LINES / 2.0) * w->view.cell_m;
}

static double range_m(const struct world *w, uint32_t cell)
{
    return w->geometry.centre_m_q8 / 256.0 + (cell + 0.5 - LINES / 2.0) * w->view.cell_m;
}

/* What rain takes of the echoes of a line, read from levels far above all noise. */
static void look_at_line(struct world *w, uint32_t line, double *loss_db)
{
    static int16_t level_q8[LM_CELLS_ROOM];
    for (uint32_t i = 0; i < CELLS; i++) {
        level_q8[i] = 120 * 256;
    }
    if (w->rain.count != 0) {
        lm_patch_rain_run(&w->rain, &w->geometry, line, level_q8, level_q8);
    }
    for (uint32_t i = 0; i < CELLS; i++) {
        loss_db[i] = 120 - level_q8[i] / 256.0;
    }
}

/* 2 k R^alpha for each kilometre of the slanting way, by hand: 6 km of rain on the ground. */
TEST(rain_before_a_patch_weakens_all_of_it_by_the_recommendations_rate)
{
    static const int rates[] = {1, 5, 20, 60, 150};
    double loss_db[LM_CELLS_ROOM];
    for (int n = 0; n < 5; n++) {
        struct world *w = make_world(20000, 9000, 5);
        add_rain(w, 10000, 0, 3000, rates[n]);
        look(w);
        const double slant = hypot(20000, 9000) / 20000;
        const double wanted_db = 2 * 0.01217 * pow(rates[n], 1.2571) * 6 * slant;
        assert_int_equal(w->rain.count, 1);
        look_at_line(w, LINES / 2, loss_db);
        for (uint32_t i = 0; i < CELLS; i++) {
            assert_true(fabs(loss_db[i] - wanted_db) < 0.02 + 0.002 * wanted_db);
        }
        print_message("# %3d mm/h: %.2f dB of %.2f\n", rates[n], loss_db[0], wanted_db);
        free(w);
    }
}

/* Rays part at the antenna: the edge of a circle half-way falls twice as far from the middle of the
 * patch as it is from the line of sight. */
TEST(the_shadow_of_rain_half_way_is_twice_as_wide)
{
    double loss_db[LM_CELLS_ROOM];
    struct world *w = make_world(30000, 5000, 5);
    const double edge_m = 200; /* right of the line of sight, at 15 km */
    const double off_deg = atan2(edge_m + 3000, 15000) * 180 / acos(-1.0);
    add_rain(w, hypot(edge_m + 3000, 15000), off_deg, 3000, 100);
    look(w);
    uint32_t first = 0;
    for (uint32_t line = 0; line < LINES; line++) {
        look_at_line(w, line, loss_db);
        if (loss_db[CELLS / 2] > 0.5 && first == 0) {
            first = line;
        }
        assert_true(loss_db[CELLS / 2] < 0.01 || first != 0);
    }
    print_message("# the shadow begins %.0f m right of the middle\n", across_m(w, first));
    assert_true(fabs(across_m(w, first) - 2 * edge_m) < 30);
    free(w);
}

/* Noise and rain of a line, where the ground returns nothing. */
static void look_into_the_dark(struct world *w, uint32_t line, double *level_db)
{
    static int16_t level_q8[LM_CELLS_ROOM];
    for (uint32_t i = 0; i < CELLS; i++) {
        level_q8[i] = LM_LEVEL_SHADOW;
    }
    lm_patch_rain_run(&w->rain, &w->geometry, line, level_q8, level_q8);
    for (uint32_t i = 0; i < CELLS; i++) {
        level_db[i] = level_q8[i] / 256.0;
    }
}

/* Rain that fills the beam: what its drops scatter, from the half of the beam above the ground. */
TEST(the_veil_is_what_the_drops_in_the_upper_half_of_the_beam_scatter)
{
    const double pi = acos(-1.0);
    double level_db[LM_CELLS_ROOM];
    for (double mm_per_h = 2; mm_per_h < 70; mm_per_h *= 2) {
        struct world *w = make_world(30000, 5000, 10);
        add_rain(w, 32000, 0, 6000, mm_per_h); /* from 26 km on */
        look(w);
        look_into_the_dark(w, LINES / 2, level_db);
        const double noise = pow(10, w->radar.sar.noise_floor_db_q8 / 2560.0);
        for (uint32_t i = 0; i < CELLS; i += 17) {
            const double s = range_m(w, i), g = 5000 / s - s / (2 * REF_EFFECTIVE_EARTH_M);
            const double eta =
                pow(pi, 5) * 0.93 * 200e-18 * pow(mm_per_h, 1.6) / pow(wavelength_m, 4);
            /* Of a Gaussian beam's two-way pattern above the axis. */
            const double height_m = s * 4.6 * pi / 180 * 0.7527 / 2;
            const double before_km = (s - 26000) / 1000 * hypot(30000, 5000) / 30000;
            const double loss_db = 2 * 0.01217 * pow(mm_per_h, 1.2571) * before_km;
            const double wanted_db = 10 * log10(eta * height_m / g) - loss_db;
            /* The circle's near edge is rounder than a wall: rays off the axis meet it later. */
            const double off_db = 10 * log10(pow(10, level_db[i] / 10) - noise) - wanted_db;
            assert_true(off_db > -0.1 && off_db < 0.4);
        }
        print_message("# %2.0f mm/h: %.1f dB of gamma in the middle\n", mm_per_h,
                      level_db[CELLS / 2]);
        free(w);
    }
}

/* Both, for circles anywhere, in dB: worst loss, worst noise with veil, and the mean square of the
 * latter. */
struct apart {
    double loss_db, veil_db, squares;
    int met, cells;
};

static void compare_line(struct world *w, uint32_t line_number, struct apart *apart)
{
    static double loss_db[LM_CELLS_ROOM], dark_db[LM_CELLS_ROOM];
    const double noise = pow(10, w->radar.sar.noise_floor_db_q8 / 2560.0);
    const double aside_deg =
        atan2(across_m(w, line_number), w->geometry.centre_m_q8 / 256.0) * 180 / acos(-1.0);
    look_at_line(w, line_number, loss_db);
    look_into_the_dark(w, line_number, dark_db);
    for (uint32_t i = 0; i < CELLS; i += 13) {
        const double veil = ref_patch_veil(&w->ref, &w->view, range_m(w, i), aside_deg);
        const double wanted_db =
            ref_patch_loss_db(&w->ref, aside_deg, range_m(w, i), w->view.cell_m);
        const double off_db = dark_db[i] - 10 * log10(noise + veil);
        apart->loss_db = fmax(apart->loss_db, fabs(loss_db[i] - wanted_db));
        apart->veil_db = fmax(apart->veil_db, fabs(off_db));
        apart->squares += off_db * off_db;
        apart->cells++;
    }
}

TEST(any_circles_do_to_a_patch_what_the_reference_says)
{
    struct hs_rng rng;
    struct apart apart = {0};
    hs_rng_seed(&rng, 5);
    for (int n = 0; n < 60; n++) {
        const double far_m = 15000 + 45000 * hs_rng_uniform(&rng);
        const double cell_m = 1 + floor(9 * hs_rng_uniform(&rng));
        struct world *w = make_world(far_m, 1000 + 8000 * hs_rng_uniform(&rng), cell_m);
        for (int k = 0; k < 1 + n % LM_RAINS_MAX; k++) {
            const double mm_per_h = 1 + hs_rng_below(&rng, 30);
            const double radius_m = round(1000 + 12000 * hs_rng_uniform(&rng));
            const double off_deg = 20 * hs_rng_uniform(&rng) - 10;
            add_rain(w, 1.1 * far_m * hs_rng_uniform(&rng), off_deg, radius_m, mm_per_h);
        }
        look(w);
        apart.met += w->rain.count != 0;
        for (uint32_t k = 0; k < LINES && w->rain.count != 0; k += 85) {
            compare_line(w, k, &apart);
        }
        free(w);
    }
    const double rms_db = sqrt(apart.squares / apart.cells);
    print_message(
        "# %d of 60 meet rain; loss off by %.3f dB at most, noise and veil by %.2f dB, "
        "%.3f rms\n",
        apart.met, apart.loss_db, apart.veil_db, rms_db);
    assert_in_range(apart.met, 30, 60);
    assert_true(apart.loss_db < 0.25);
    assert_true(apart.veil_db < 0.3 && rms_db < 0.03);
}

/* A beam is 1.7 km wide at 30 km: what returns is not seen more sharply across than by that. */
TEST(the_veil_ends_as_softly_as_the_beam_is_wide)
{
    double level_db[LM_CELLS_ROOM], loss_db[LM_CELLS_ROOM], share[LINES];
    struct world *w = make_world(30000, 5000, 15);
    add_rain(w, hypot(30000, 40000), atan2(40000, 30000) * 180 / acos(-1.0), 40000, 1);
    look(w);
    const double noise = pow(10, w->radar.sar.noise_floor_db_q8 / 2560.0);
    for (uint32_t k = 0; k < LINES; k++) {
        look_into_the_dark(w, k, level_db);
        look_at_line(w, k, loss_db);
        /* What passes through the rain before it is another matter. */
        share[k] = (pow(10, level_db[CELLS / 2] / 10) - noise) * pow(10, loss_db[CELLS / 2] / 10);
    }
    double at_quarter = 0, at_three_quarters = 0;
    for (uint32_t k = 1; k < LINES; k++) {
        const double before = share[k - 1] / share[LINES - 1], here = share[k] / share[LINES - 1];
        at_quarter = before < 0.25 && here >= 0.25 ? across_m(w, k) : at_quarter;
        at_three_quarters = before < 0.75 && here >= 0.75 ? across_m(w, k) : at_three_quarters;
    }
    /* Quartiles of a Gaussian whose half-power width is the two-way beam's: 0.573 of that apart. */
    const double wanted_m = 0.573 * 30000 * 3.3 * acos(-1.0) / 180 / sqrt(2);
    print_message("# a quarter to three quarters in %.0f m of %.0f\n",
                  at_three_quarters - at_quarter, wanted_m);
    assert_true(fabs(at_three_quarters - at_quarter - wanted_m) < 50);
    assert_true(fabs(at_quarter + at_three_quarters) < 60);
    free(w);
}

TEST(rain_behind_beside_and_far_from_a_patch_is_not_there)
{
    struct world *w = make_world(30000, 5000, 5);
    memset(&w->rain, 0xa5, sizeof w->rain);
    look(w);
    assert_int_equal(w->rain.count, 0);
    add_rain(w, 45000, 0, 14000, 100);
    add_rain(w, 20000, 90, 15000, 100);
    add_rain(w, 8000, 180, 7900, 100);
    look(w);
    assert_int_equal(w->rain.count, 0);
    for (uint32_t i = 0; i < LM_CELLS_ROOM; i++) {
        assert_int_equal((uint32_t)w->rain.veil[0].level_db_q8[i], 0xa5a5a5a5);
        assert_int_equal((uint32_t)w->rain.volume_db_q8[i], 0xa5a5a5a5);
        assert_int_equal((uint32_t)w->rain.loss_db_q8[i], 0xa5a5a5a5);
    }
    lm_patch_rain_find(&w->rain, NULL, &w->radar, w->antenna, 0);
    assert_int_equal(w->rain.count, 0);
    free(w);
}

/* Whatever the limits of circles and patches allow. The sanitizers watch in test_fuzz_unit. */
TEST(no_rain_within_its_limits_makes_levels_of_no_meaning)
{
    static const double ranges_m[] = {3000, 250000}, heights_m[] = {-30000, 0, 30000};
    double loss_db[LM_CELLS_ROOM], dark_db[LM_CELLS_ROOM];
    for (int n = 0; n < 6; n++) {
        struct world *w = make_world(ranges_m[n % 2], heights_m[n / 2], n % 2 ? 40 : 0.3);
        for (int k = 0; k < LM_RAINS_MAX; k++) {
            add_rain(w, k * ranges_m[n % 2] / 4, 0, 100000, 150);
        }
        look(w);
        assert_int_equal(w->rain.count, LM_RAINS_MAX);
        for (uint32_t line = 0; line < LINES; line += 15) {
            look_at_line(w, line, loss_db);
            look_into_the_dark(w, line, dark_db);
            for (uint32_t i = 0; i < CELLS; i++) {
                assert_true(dark_db[i] * 256 >= w->radar.sar.noise_floor_db_q8 && dark_db[i] < 80);
                assert_true(loss_db[i] >= 0);
            }
        }
        free(w);
    }
}

/* ---- in a patch ---- */

static struct tiny_map map;
static struct lm_sar sar;
static struct lm_line line;
static struct lm_tone tone;

static struct tiny_cell sea(void *ctx, const struct tiny_place *p)
{
    (void)ctx;
    (void)p;
    return (struct tiny_cell){-40, TINY_WATER, 0};
}

/* The strongest level of a patch of the sea with one corner of 40 dB in it, and the mean of its
 * first lines, where the corner is not. */
static void draw(const struct lm_environment *e, double *peak_db, double *mean_db)
{
    const struct lm_sar_command command = {.centre = {FX_BAM_DEG(46), FX_BAM_DEG(11)},
                                           .cell_mm = 5000,
                                           .range_m = 20000,
                                           .height_m_q6 = 4000 * 64};
    struct lm_target t = point_at(46, 11, 0, 40);
    const struct lm_target_set set = {.items = &t, .count = 1};
    const struct lm_sar_setup scene = {
        .targets = &set, .epoch = 3, .sea_state = LM_SEA_STATE_OF_IMAGE, .environment = e};
    double sum = 0;
    int32_t peak_q8 = INT32_MIN;
    assert_int_equal(lm_sar_start(&sar, &lm_radar_default, &map.db, &command, &scene), LM_OK);
    for (uint32_t k = 0; k < LINES; k++) {
        lm_sar_prefetch(&sar, &map.tiles, k);
        tiny_map_read_tiles(&map);
    }
    for (uint32_t k = 0; k < LINES; k++) {
        const int16_t *drawn_q8 = lm_sar_draw_line(&sar, &map.tiles, &tone, &line);
        for (uint32_t i = 0; i < CELLS; i++) {
            const int32_t level_q8 = drawn_q8[i];
            peak_q8 = level_q8 > peak_q8 ? level_q8 : peak_q8;
            sum += k < 100 ? pow(10, level_q8 / 2560.0) : 0;
        }
    }
    *peak_db = peak_q8 / 256.0;
    *mean_db = 10 * log10(sum / (100 * LINES));
}

TEST(bodies_in_a_patch_are_weakened_and_the_veil_lies_on_the_sea)
{
    struct tiny_spec spec = tiny_spec_at(46, 11);
    spec.shift0 = 9;
    spec.rows = spec.columns = 6;
    spec.cell = sea;
    tiny_map_open(&map, &spec, 200);
    assert_int_equal(lm_tone_set(&tone, &lm_radar_default.sar.tone), LM_OK);
    struct lm_geo_origin centre;
    lm_geo_set_origin(&centre, (struct lm_position){FX_BAM_DEG(46), FX_BAM_DEG(11)});
    double fair_db, rainy_db, fair_sea_db, rainy_sea_db;
    struct lm_environment e = {.sea_state = LM_SEA_STATE_OF_IMAGE};
    draw(&e, &fair_db, &fair_sea_db);
    /* 10 km of rain before the patch, which ends 2 km before it. */
    e.rain[e.rain_count++] =
        (struct lm_rain){lm_geo_direct(&centre, FX_BAM_180, 7000 * 256), 5000, 40};
    draw(&e, &rainy_db, &rainy_sea_db);
    const double loss_db = 2 * 0.01217 * pow(40, 1.2571) * 10 * hypot(20000, 4000) / 20000;
    print_message("# the corner loses %.2f dB of %.2f\n", fair_db - rainy_db, loss_db);
    assert_true(fabs(fair_db - rainy_db - loss_db) < 0.2);
    assert_true(rainy_sea_db < fair_sea_db);
    /* 4 km of light rain over it. */
    e.rain[0] = (struct lm_rain){{FX_BAM_DEG(46), FX_BAM_DEG(11)}, 4000, 25};
    draw(&e, &rainy_db, &rainy_sea_db);
    const double veil_db = sar.rain.veil[0].level_db_q8[CELLS / 2] / 256.0;
    print_message("# sea %.1f dB, in rain %.1f dB, the veil is %.1f dB in the middle\n",
                  fair_sea_db, rainy_sea_db, veil_db);
    assert_true(rainy_sea_db > fair_sea_db + 5);
    assert_true(fabs(rainy_sea_db - veil_db) < 1);
    tiny_map_close(&map);
}

/* A quarter of an eighth of the Earth away there is no plane to have a circle in. */
TEST(rain_on_another_side_of_the_earth_is_left_out)
{
    struct world *w = make_world(30000, 5000, 5);
    w->environment.rain_count = 2;
    w->environment.rain[0] = (struct lm_rain){{FX_BAM_DEG(46), FX_BAM_DEG(200)}, 5000, 20};
    w->environment.rain[1] = (struct lm_rain){{FX_BAM_DEG(46), FX_BAM_DEG(11)}, 5000, 20};
    lm_patch_rain_find(&w->rain, &w->environment, &w->radar, w->antenna, 0);
    assert_int_equal(w->rain.count, 1);
    assert_int_equal(w->rain.shower[0].radius_m, 5000);
    free(w);
}

/* What scatterers in these cells of the middle line lose by rain so far away, in a patch 30 km
 * away. */
static void find_losses(double rain_m, double radius_m, const int32_t *cells, uint32_t count,
                        double *loss_db)
{
    static struct lm_target_patch points;
    struct world *w = make_world(30000, 5000, 5);
    add_rain(w, rain_m, 0, radius_m, 40);
    lm_patch_rain_find(&w->rain, &w->environment, &w->radar, w->antenna, 0);
    lm_patch_rain_set(&w->rain, &w->radar, &w->geometry, LM_DB_Q8(-46));
    assert_int_equal(w->rain.count, 1);
    memset(&points, 0, sizeof points);
    points.scatterer_count = count;
    for (uint32_t i = 0; i < count; i++) {
        points.scatterer[i] = (struct lm_patch_scatterer){.line = LINES / 2, .cell = cells[i]};
    }
    lm_patch_rain_weaken(&w->rain, &w->geometry, &points);
    for (uint32_t i = 0; i < count; i++) {
        loss_db[i] = -points.scatterer[i].level_db_q8 / 256.0;
    }
    free(w);
}

/* What stands at the edge of a shower, in its middle and behind it has none, half and all of its
 * rain before it. */
TEST(a_scatterer_loses_by_the_rain_before_it_and_no_more)
{
    const int32_t cells[3] = {CELLS / 2 - 800, CELLS / 2, CELLS / 2 + 800};
    double loss_db[3];
    find_losses(30000, 3000, cells, 3, loss_db);
    print_message("# before, in the middle and behind: %.2f, %.2f and %.2f dB\n", loss_db[0],
                  loss_db[1], loss_db[2]);
    assert_true(loss_db[0] == 0);
    assert_true(loss_db[2] > 1);
    assert_true(fabs(loss_db[1] - loss_db[2] / 2) < 0.1 * loss_db[2]);
}

/* All of the rain lies before a scatterer that is displaced beyond any range. */
TEST(a_scatterer_however_far_has_no_more_loss_than_all_the_rain)
{
    const int32_t cells[2] = {CELLS, 1 << 22};
    double loss_db[2];
    find_losses(15000, 4000, cells, 2, loss_db);
    assert_true(loss_db[0] > 1);
    assert_true(loss_db[1] == loss_db[0]);
}
