/* Targets in a patch: the shape of a point, its place and its power, sums of points, movers, and
 * what hides them. The shape is judged by the closed form of Taylor weighting, places by PROJ's
 * geodesics, sums by the equations of EQUATIONS.md in double precision. */
#include "hs/angle.h"
#include "lm/target_patch.h"

#include "check.h"
#include "extent.h"
#include "lm/illumination.h"
#include "reference/reference.h"
#include "target_support.h"
#include "wgs84.h"

#include <complex.h>
#include <stdlib.h>

static const double pi = 3.14159265358979323846;

/* A patch of 128 cells of 2 m, 20 km away. */
enum { LINES = 128, CELLS = LINES, NOTHING_Q8 = -120 * 256 };
static const double height_m = 6000, cell_m = 2, range_m = 20000;

/* Large, and only one is used at a time. */
static struct lm_target_patch points;
static int16_t picture[LINES][LM_CELLS_ROOM];

static struct lm_patch_geometry geometry(double lat, double lon, double look)
{
    return (struct lm_patch_geometry){.centre = {hs_bam(lat), hs_bam(lon)},
                                      .look = hs_bam(look),
                                      .centre_m_q8 = (uint32_t)(range_m * 256),
                                      .cell_m_q8 = (uint32_t)(cell_m * 256),
                                      .lines = LINES,
                                      .cells = CELLS,
                                      .heights = {(int32_t)(height_m * 1024), 0},
                                      .wavelength_um = X_BAND_UM};
}

static void find_points(const struct lm_target *t, uint32_t count,
                        const struct lm_patch_geometry *g, uint64_t time_us)
{
    struct lm_target_candidates candidates;
    const struct lm_target_set set = {.items = t, .count = count};
    const struct lm_target_query scene = {
        .position = g->centre, .reach_m = 20000, .time_us = time_us};
    lm_target_candidates_select(&candidates, &set, &scene);
    lm_target_patch_set(&points, &candidates, g);
}

static void draw(const struct lm_patch_geometry *g, int32_t least_q8)
{
    for (uint32_t k = 0; k < LINES; k++) {
        for (uint32_t i = 0; i < CELLS; i++) {
            picture[k][i] = NOTHING_Q8;
        }
        lm_target_patch_add_scatterers(&points, k, least_q8, g, picture[k]);
    }
}

/* The place `across`, `along` metres from the centre as the radar looks. */
static void place_at(double lat, double lon, double look, double across, double along, double to[2])
{
    wgs84_direct(lat, lon, look + atan2(across, along) * 180 / pi, hypot(across, along), &to[0],
                 &to[1]);
}

/* Middle of a line or of a cell that is shown, from the centre. */
static double middle_of(double number)
{
    return (number + 0.5 - LINES / 2) * cell_m;
}

/* Across offset of a line at a cell: lines are rays. */
static double across_of(double line, double cell)
{
    return middle_of(line) * (range_m + middle_of(cell)) / range_m;
}

/* Line and cell of fractions, places from the middles of the first ones. */
static struct lm_target point_in(double line, double cell, double rcs_db)
{
    double to[2];
    place_at(46, 11, 0, across_of(line, cell), middle_of(cell), to);
    return point_at(to[0], to[1], 0, rcs_db);
}

static double level_db(double rcs_db, double cell)
{
    const struct ref_view view = {height_m, 0, cell_m};
    const double at_m = range_m + middle_of(cell);
    const double width_m = cell_m * at_m / range_m;
    return rcs_db - 10 * log10(width_m * cell_m * ref_grazing(&view, at_m, at_m - cell_m));
}

/* ---- the shape ---- */

static double sinc(double x)
{
    return x == 0 ? 1 : sin(pi * x) / (pi * x);
}

/* Taylor's response in its closed form: zeros moved from 1..3 to z_n. Power adds up to one. */
static double taylor(double x)
{
    const double a = acosh(pow(10, 35 / 20.0)) / pi, s2 = 16 / (a * a + 12.25);
    x = fabs(x - round(x)) < 1e-6 && x != 0 ? x + 1e-6 : x; /* beside the poles */
    double h = sinc(x), energy_db = 0.9140;                 /* a loss of 0.91 dB */
    for (int n = 1; n < 4; n++) {
        const double z2 = s2 * (a * a + (n - 0.5) * (n - 0.5));
        h *= (1 - x * x / z2) / (1 - x * x / (n * n));
    }
    return h * pow(10, -energy_db / 20);
}

/* A cut through the point, 16 samples a cell, power; sample 128 is its middle. */
enum { STEPS = 16, CUT = 2 * 8 * STEPS };

static void measure(const double cut[CUT], double *width, double *side_db)
{
    double peak = 0, side = 0;
    for (int i = 0; i < CUT; i++) {
        peak = fmax(peak, cut[i]);
    }
    int right = CUT / 2;
    while (cut[right] > peak / 2) {
        right++;
    }
    *width = 2.0 / STEPS *
             (right - 1 - CUT / 2 + (cut[right - 1] - peak / 2) / (cut[right - 1] - cut[right]));
    int null = right;
    while (cut[null + 1] < cut[null]) {
        null++;
    }
    for (int i = null; i < CUT; i++) {
        side = fmax(side, cut[i]);
    }
    *side_db = 10 * log10(side / peak);
}

/* On the levels of line 60 and cell 70 while a point is moved past them in sixteenths of a cell,
 * 30 dB above what is left out at its side lobes. */
TEST(a_points_width_and_side_lobes_are_those_of_the_taylor_table)
{
    for (int is_along = 0; is_along < 2; is_along++) {
        double cut[CUT], width, side_db;
        for (int i = 0; i < CUT; i++) {
            const double away = (i - CUT / 2) / (double)STEPS;
            const struct lm_target t = point_in(60 + !is_along * away, 70 + is_along * away, 60);
            const struct lm_patch_geometry g = geometry(46, 11, 0);
            find_points(&t, 1, &g, 0);
            draw(&g, NOTHING_Q8);
            cut[i] = pow(10, picture[60][70] / 2560.0);
        }
        measure(cut, &width, &side_db);
        print_message("# %s: width %.3f cells, side lobe %.2f dB\n", is_along ? "along" : "across",
                      width, side_db);
        assert_true(fabs(width / 1.184 - 1) < 0.05);
        assert_true(fabs(side_db + 35.2) < 1);
    }
}

TEST(the_table_is_taylors_response)
{
    double worst = 0, energy = 0;
    for (int x_q8 = -8 * 256; x_q8 <= 8 * 256; x_q8++) {
        worst = fmax(worst, fabs(lm_response(x_q8) / 32768.0 - taylor(x_q8 / 256.0)));
        energy += pow(lm_response(x_q8) / 32768.0, 2) / 256;
        const int whole = abs(x_q8) / 256;
        for (int n = 0; n <= whole; n++) {
            assert_true(20 * log10(fabs(taylor(x_q8 / 256.0)) + 1e-9) <=
                        lm_response_envelope_db_q8[n] / 256.0 + 0.01);
        }
    }
    print_message("# worst response off by %.5f of one, energy %.5f\n", worst, energy);
    assert_true(worst < 1.3e-3);
    assert_true(fabs(energy - 1) < 0.002);
}

/* ---- place and power ---- */

TEST(a_point_is_at_its_place_with_all_its_power)
{
    struct hs_rng rng;
    double worst_cells = 0, worst_db = 0;
    hs_rng_seed(&rng, 4);
    for (int i = 0; i < 100; i++) {
        const double lat = 75 * (2 * hs_rng_uniform(&rng) - 1), look = 360 * hs_rng_uniform(&rng);
        const double line = 20 + 88 * hs_rng_uniform(&rng), cell = 20 + 88 * hs_rng_uniform(&rng);
        double to[2], power = 0, across = 0, along = 0;
        place_at(lat, 20, look, across_of(line, cell), middle_of(cell), to);
        const struct lm_target t = point_at(to[0], to[1], 0, 35);
        const struct lm_patch_geometry g = geometry(lat, 20, look);
        find_points(&t, 1, &g, 0);
        draw(&g, NOTHING_Q8);
        for (int k = 0; k < LINES; k++) {
            for (int c = 0; c < CELLS; c++) {
                const double p = picture[k][c] == NOTHING_Q8 ? 0 : pow(10, picture[k][c] / 2560.0);
                power += p, across += p * k, along += p * (c);
            }
        }
        worst_cells = fmax(worst_cells, hypot(across / power - line, along / power - cell));
        worst_db = fmax(worst_db, fabs(10 * log10(power) - level_db(35, cell)));
    }
    print_message("# worst place %.3f cells, worst power %.3f dB\n", worst_cells, worst_db);
    assert_true(worst_cells < 0.1);
    assert_true(worst_db < 0.05);
}

TEST(what_is_left_out_lies_below_the_least_level)
{
    const struct lm_patch_geometry g = geometry(46, 11, 0);
    static int16_t whole[LINES][LM_CELLS_ROOM];
    for (int rcs_db = -60; rcs_db <= 60; rcs_db += 4) {
        const struct lm_target t = point_in(60.3, 70.4, rcs_db);
        find_points(&t, 1, &g, 0);
        draw(&g, NOTHING_Q8);
        memcpy(whole, picture, sizeof whole);
        draw(&g, -56 * 256);
        for (int k = 0; k < LINES; k++) {
            for (int c = 0; c < CELLS; c++) {
                assert_true(picture[k][c] == whole[k][c] ||
                            (picture[k][c] == NOTHING_Q8 && whole[k][c] < -56 * 256));
            }
        }
    }
}

/* ---- sums ---- */

/* The picture of all points in double precision: phasors within a target, powers between them. */
static double expected_power(uint32_t line, uint32_t cell)
{
    double power = 0;
    for (uint32_t i = 0; i < points.scatterer_count;) {
        double complex sum = 0;
        const uint8_t target = points.scatterer[i].target;
        for (; i < points.scatterer_count && points.scatterer[i].target == target; i++) {
            const struct lm_patch_scatterer *p = &points.scatterer[i];
            const double dx = line - p->across_cells_q8 / 256.0,
                         dy = cell - p->along_cells_q8 / 256.0;
            /* Seven cells to either side of the one that holds it: of two, the farther. */
            if (fabs(dx) < 8 && dy > -7.5 && dy <= 7.5) {
                sum += pow(10, p->level_db_q8 / 5120.0) * taylor(dx) * taylor(dy) *
                       cexp(I * (double)p->phase * (2 * pi / 4294967296.0));
            }
        }
        power += pow(cabs(sum), 2);
    }
    return power;
}

TEST(bodies_add_as_phasors_and_targets_as_powers_everywhere)
{
    struct hs_rng rng;
    double worst_db = 0, squares = 0;
    uint32_t cells = 0;
    hs_rng_seed(&rng, 9);
    for (int i = 0; i < 6; i++) {
        struct lm_target t[4];
        for (int k = 0; k < 4; k++) {
            double to[2];
            t[k] = random_target(&rng, 15000);
            place_at(46, 11, 0, across_of(40 + 12 * k, 80 - 9 * k), middle_of(80 - 9 * k), to);
            t[k].latitude = hs_bam(to[0]);
            t[k].longitude = hs_bam(to[1]);
            seal_target(&t[k]);
        }
        const struct lm_patch_geometry g = geometry(46, 11, 0);
        find_points(t, 4, &g, 0);
        draw(&g, NOTHING_Q8);
        double strongest = 0;
        for (uint32_t k = 0; k < LINES; k++) {
            for (uint32_t c = 0; c < CELLS; c++) {
                strongest = fmax(strongest, expected_power(k, c));
            }
        }
        for (uint32_t k = 0; k < LINES; k++) {
            for (uint32_t c = 0; c < CELLS; c++) {
                const double power = expected_power(k, c);
                if (power > strongest * 1e-5) {
                    const double error_db = fabs(picture[k][c] / 256.0 - 10 * log10(power));
                    worst_db = fmax(worst_db, error_db);
                    squares += error_db * error_db;
                    cells++;
                }
            }
        }
    }
    print_message("# %u cells within 50 dB of the strongest: rms %.3f dB, worst %.2f dB\n", cells,
                  sqrt(squares / cells), worst_db);
    assert_true(cells > 2000);
    assert_true(sqrt(squares / cells) < 0.1);
    assert_true(worst_db < 1.5);
}

/* Cases 2 and 4 change from pulse to pulse; a patch is made of all pulses of its dwell. */
TEST(a_fluctuating_point_has_one_strength_in_a_patch)
{
    for (uint8_t swerling = 1; swerling <= 4; swerling++) {
        struct lm_target t = point_in(60, 70, 30);
        t.swerling = swerling;
        seal_target(&t);
        struct lm_patch_geometry g = geometry(46, 11, 0);
        int32_t strength[2];
        for (g.epoch = 0; g.epoch < 2; g.epoch++) {
            find_points(&t, 1, &g, 0);
            draw(&g, NOTHING_Q8);
            const int16_t *left = picture[59], *right = picture[61];
            assert_true(abs(left[70] - right[70]) < 64);
            strength[g.epoch] = picture[60][70];
        }
        assert_true(strength[0] != strength[1]);
    }
}

/* ---- movers ---- */

TEST(a_mover_is_displaced_by_r_v_over_v_sin_o_within_a_cell)
{
    struct hs_rng rng;
    hs_rng_seed(&rng, 5);
    for (int i = 0; i < 50; i++) {
        const double speed = 0.5 + hs_rng_uniform(&rng), heading = 360 * hs_rng_uniform(&rng);
        const double across_m_s = i % 2 ? 176.8 : -240;
        struct lm_target t = point_in(64, 70, 35);
        t.heading = hs_bam(heading);
        t.speed_mm_s = (uint32_t)lround(speed * 1000);
        t.leg_m = 10;
        seal_target(&t);
        struct lm_patch_geometry g = geometry(46, 11, 0);
        g.across_mm_s = (int32_t)lround(across_m_s * 1000);
        find_points(&t, 1, &g, 0);
        const double closing = -speed * cos(heading * pi / 180);
        /* s v / V at its range, where lines are s / S cells apart. */
        const double expected = 64 + range_m * closing / across_m_s / cell_m;
        assert_true(fabs(points.scatterer[0].across_cells_q8 / 256.0 - expected) < 1);
        assert_true(fabs(points.scatterer[0].along_cells_q8 / 256.0 - (70)) < 0.1);
    }
}

TEST(what_a_mover_is_smeared_to_is_what_the_aperture_makes_of_it)
{
    static double wanted[LINES][CELLS], found[LINES][CELLS];
    const double flies_m_s = 200;
    const struct {
        double right_m_s, closing_m_s; /* a cell of 2 m for each, and two across */
    } cases[] = {{0.2, 0}, {1.5, 0}, {5, 0}, {-16, 0}, {0, 5}, {4, -4}, {-8, 7}, {12, 12}};
    for (size_t n = 0; n < sizeof cases / sizeof *cases; n++) {
        const double right = cases[n].right_m_s, closing = cases[n].closing_m_s;
        struct lm_patch_geometry g = geometry(46, 11, 0);
        g.across_mm_s = (int32_t)lround(flies_m_s * 1000);
        g.dwell_ms = 2000;
        /* From where Doppler puts it onto line 64. */
        const double shift_m = range_m * closing / flies_m_s;
        struct lm_target t = point_in(64 - shift_m / cell_m, 70, 35);
        t.heading = hs_bam(atan2(right, -closing) * 180 / pi);
        t.speed_mm_s = (uint32_t)lround(hypot(right, closing) * 1000);
        t.leg_m = 100;
        seal_target(&t);
        find_points(&t, 1, &g, 0);
        draw(&g, -60 * 256);
        for (int k = 0; k < LINES; k++) {
            for (int i = 0; i < CELLS; i++) {
                found[k][i] = picture[k][i] > NOTHING_Q8 ? pow(10, picture[k][i] / 2560.0) : 0;
            }
        }
        const double drift = (2 * right - right * right / flies_m_s) * 2 / cell_m;
        const struct ref_mover mover = {64, 70, drift, -closing * 2 / cell_m, 1};
        memset(wanted, 0, sizeof wanted);
        assert_int_equal(ref_add_mover(&mover, LINES, CELLS, wanted[0]), 0);
        const struct extent is = extent_of(found[0], LINES, CELLS);
        const struct extent should = extent_of(wanted[0], LINES, CELLS);
        const double lost_db = 10 * log10(is.sum) - level_db(35, 70);
        print_message(
            "# smeared %.1f and %.1f cells: %.1f x %.1f, %.2f; wanted %.1f x %.1f, %.2f; "
            "power %.2f dB\n",
            drift, -closing * 2 / cell_m, is.across, is.along, is.correlation, should.across,
            should.along, should.correlation, lost_db);
        assert_true(fabs(is.across - should.across) < 0.3 + 0.15 * should.across);
        assert_true(fabs(is.along - should.along) < 0.3 + 0.15 * should.along);
        assert_true(fabs(is.correlation - should.correlation) < 0.25);
        assert_true(fabs(lost_db) < 0.3);
    }
}

/* ---- passed over ---- */

TEST(lines_that_pass_by_a_target_would_have_nothing_of_it)
{
    static int16_t noted[LINES][LM_CELLS_ROOM];
    struct hs_rng rng;
    uint32_t passed_by = 0, touched = 0;
    hs_rng_seed(&rng, 8);
    for (int i = 0; i < 40; i++) {
        struct lm_target t = random_target(&rng, LM_TARGET_OFFSET_MAX_MM);
        const struct lm_target place = point_in(LINES * hs_rng_uniform(&rng), 70, 30);
        t.latitude = place.latitude;
        t.longitude = place.longitude;
        t.speed_mm_s = i % 2 ? hs_rng_below(&rng, 8000) : 0;
        t.leg_m = 10;
        seal_target(&t);
        struct lm_patch_geometry g = geometry(46, 11, 0);
        g.across_mm_s = 200000;
        g.dwell_ms = 2000;
        find_points(&t, 1, &g, 0);
        draw(&g, NOTHING_Q8);
        memcpy(noted, picture, sizeof noted);
        for (uint32_t k = 0; k < LINES; k++) {
            passed_by += points.on_line[k] == 0;
            touched += points.on_line[k] != 0;
            points.on_line[k] = 1;
        }
        draw(&g, NOTHING_Q8);
        assert_memory_equal(picture, noted, sizeof noted);
    }
    print_message("# %u lines touched, %u passed by\n", touched, passed_by);
    assert_true(touched > LINES && passed_by > LINES);
}

/* ---- hidden and leaning ---- */

enum { BITS = 30, WALL = 20 };

TEST(a_wall_hides_what_is_lower_than_the_ray_over_it_on_all_lines)
{
    /* Seen from 6000 m at 20 km, a wall of 30 m throws a shadow of 100 m: 66 m behind it, a
     * target shows from 10 m up. */
    const struct lm_patch_geometry g = geometry(46, 11, 0);
    int32_t horizon[CELLS];
    double highest = -2;
    for (int i = 0; i < CELLS; i++) {
        const double at_m = range_m + middle_of(i);
        horizon[i] = (int32_t)ldexp(highest, BITS);
        highest = fmax(highest, ref_tangent(height_m, at_m, i == WALL ? 30 : 0));
    }
    for (int up_m = 0; up_m < 20; up_m++) {
        for (int is_before = 0; is_before < 2; is_before++) {
            struct lm_target t = point_in(64, WALL + (is_before ? -4 : 33), 30);
            t.elevation_m_q6 = up_m * 64;
            seal_target(&t);
            const double at_m = range_m + middle_of(WALL);
            const bool is_seen = is_before || ref_tangent(height_m, at_m + 66, up_m) >
                                                  ref_tangent(height_m, at_m, 30);
            assert_true(is_before || is_seen == (up_m >= 11));
            find_points(&t, 1, &g, 0);
            for (uint32_t k = 0; k < LINES; k++) {
                lm_target_patch_mark_hidden(&points, k, horizon, BITS, CELLS - 1);
            }
            draw(&g, NOTHING_Q8);
            int lines = 0;
            for (int k = 0; k < LINES; k++) {
                for (int c = 0; c < CELLS; c++) {
                    lines += picture[k][c] != NOTHING_Q8;
                }
            }
            assert_int_equal(lines > 0, is_seen);
        }
    }
}

TEST(layover_brings_a_body_nearer_by_its_height_times_the_lean)
{
    struct lm_target t = point_in(64, 70, 0);
    t.scatterer_count = 0;
    add_scatterer(&t, LM_SHAPE_SPHERE, 5642, 0, 0, 40000, 0, 0);
    struct lm_patch_geometry g = geometry(46, 11, 0);
    g.lean_q16 = (int32_t)lround(0.3 * 65536);
    find_points(&t, 1, &g, 0);
    assert_true(fabs(points.scatterer[0].along_cells_q8 / 256.0 - (70 - 0.3 * 40 / cell_m)) < 0.1);
}

/* ---- hostile records ---- */

TEST(a_target_that_cannot_be_located_from_the_patch_is_left_out)
{
    const struct lm_target t[2] = {point_in(60, 60, 20), point_in(70, 70, 20)};
    struct lm_patch_geometry g = geometry(46, 11, 0);
    find_points(t, 2, &g, 0);
    assert_int_equal(points.target_count, 2);
    struct lm_target_candidates candidates;
    const struct lm_target_set set = {.items = t, .count = 2};
    const struct lm_target_query scene = {.position = g.centre, .reach_m = 20000};
    lm_target_candidates_select(&candidates, &set, &scene);
    g.centre.latitude += FX_BAM_DEG(4); /* 440 km */
    lm_target_patch_set(&points, &candidates, &g);
    assert_int_equal(points.target_count, 0);
    assert_int_equal(points.scatterer_count, 0);
    g.centre = (struct lm_position){FX_BAM_DEG(89.9), FX_BAM_DEG(191)}; /* across the pole */
    candidates.candidate[0].state.position = (struct lm_position){FX_BAM_DEG(89.9), FX_BAM_DEG(11)};
    candidates.count = 1;
    lm_target_patch_set(&points, &candidates, &g);
    assert_int_equal(points.target_count, 0);
}

/* It has no range, and its cell no width. */
TEST(a_target_at_the_antenna_is_outside_of_the_patch)
{
    double to[2];
    place_at(46, 11, 0, 0, -range_m, to);
    const struct lm_target t = point_at(to[0], to[1], 0, 20);
    const struct lm_patch_geometry g = geometry(46, 11, 0);
    struct lm_target_candidates candidates;
    const struct lm_target_set set = {.items = &t, .count = 1};
    const struct lm_target_query scene = {.position = g.centre, .reach_m = 30000};
    lm_target_candidates_select(&candidates, &set, &scene);
    assert_int_equal(candidates.count, 1);
    lm_target_patch_set(&points, &candidates, &g);
    draw(&g, -60 * 256);
    for (int k = 0; k < LINES * CELLS; k++) {
        assert_int_equal(picture[k / CELLS][k % CELLS], NOTHING_Q8);
    }
}

TEST(no_horizon_hides_what_stands_before_the_first_cell)
{
    int32_t horizon[LM_CELLS_ROOM];
    for (int i = 0; i < LM_CELLS_ROOM; i++) {
        horizon[i] = INT32_MAX;
    }
    for (int is_before = 0; is_before < 2; is_before++) {
        const struct lm_target t = point_in(60, is_before ? -3 : 3, 20);
        const struct lm_patch_geometry g = geometry(46, 11, 0);
        find_points(&t, 1, &g, 0);
        assert_int_equal(points.scatterer[0].line, 60);
        lm_target_patch_mark_hidden(&points, 60, horizon, 30, CELLS);
        assert_int_equal(points.scatterer[0].is_hidden, !is_before);
    }
}

TEST(a_record_that_passes_the_check_can_be_used_in_a_patch)
{
    struct hs_rng rng;
    uint32_t passed = 0, given = 0;
    struct lm_target t = {0};
    hs_rng_seed(&rng, 6);
    for (int i = 0; i < 6000; i++) {
        if (i % 10 == 0) {
            t = random_target(&rng, LM_TARGET_OFFSET_MAX_MM);
            t.speed_mm_s = hs_rng_below(&rng, LM_TARGET_SPEED_MAX_MM_S) + 1;
            t.leg_m = hs_rng_below(&rng, LM_TARGET_LEG_MAX_M) + 1;
        }
        if (!damage_target(&rng, &t)) {
            i += 9 - i % 10;
            continue;
        }
        passed++;
        struct lm_patch_geometry g = geometry(46, 11, 0);
        const struct lm_mover_state mover = lm_mover_state_at(&t, (uint64_t)i << 30);
        g.centre = (struct lm_position){mover.position.latitude + hs_rng_below(&rng, 9000),
                                        mover.position.longitude};
        g.look = (fx_bam_t)hs_rng_u64(&rng);
        g.wavelength_um = i % 3 ? LM_WAVELENGTH_MIN_UM : LM_WAVELENGTH_MAX_UM;
        g.cell_m_q8 = i % 2 ? 128 : 10240;
        g.across_mm_s = (int32_t)hs_rng_below(&rng, 9) - 4;
        g.dwell_ms = hs_rng_below(&rng, 1 << 17);
        g.lean_q16 = (int32_t)hs_rng_below(&rng, 1 << 22);
        find_points(&t, 1, &g, (uint64_t)i << 30);
        draw(&g, -56 * 256);
        for (uint32_t k = 0; k < LINES; k++) {
            for (uint32_t c = 0; c < CELLS; c++) {
                given += picture[k][c] != NOTHING_Q8;
            }
        }
    }
    print_message("# %u records passed, %u cells were given something\n", passed, given);
    assert_true(passed > 500 && given > 500);
}
