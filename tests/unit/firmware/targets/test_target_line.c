/* Targets in lines of the picture: the right cell, the right level, hidden by what stands before
 * them. Places come from PROJ's geodesics, levels from the equations in double precision. */
#include "fx/trig.h"
#include "hs/angle.h"
#include "lm/target_line.h"

#include "check.h"
#include "lm/illumination.h"
#include "reference/rcs.h"
#include "reference/reference.h"
#include "target_support.h"
#include "wgs84.h"

#include <stdlib.h>

static const double pi = 3.14159265358979323846;

enum { CELLS = 256, LINES = 256 };
static const double height_m = 6000, range_m = 37040, cell_m = 37040.0 / CELLS;

/* Line `line` of a sector of 120 degrees around `heading`. */
static struct lm_target_line sector_line(double lat, double lon, double heading, uint32_t line)
{
    const fx_bam_t width = FX_BAM_DEG(120) / LINES;
    const int32_t from_middle = (int32_t)line - LINES / 2;
    const uint32_t cell_q8 = (uint32_t)(range_m * 256 / CELLS);
    return (struct lm_target_line){.position = {hs_bam(lat), hs_bam(lon)},
                                   .azimuth = hs_bam(heading) +
                                              (fx_bam_t)(from_middle * (int32_t)width) + width / 2,
                                   .width = width,
                                   .first_m_q8 = cell_q8 / 2,
                                   .cell_m_q8 = cell_q8,
                                   .cells = CELLS,
                                   .height_m_q10 = (int32_t)(height_m * 1024),
                                   .wavelength_um = X_BAND_UM};
}

static struct lm_target_candidates near_of(const struct lm_target *targets, uint32_t count,
                                           struct lm_position position, uint32_t reach_m)
{
    struct lm_target_candidates candidates;
    const struct lm_target_set set = {.items = targets, .count = count};
    const struct lm_target_query scene = {.position = position, .reach_m = reach_m};
    lm_target_candidates_select(&candidates, &set, &scene);
    return candidates;
}

static void clear(int16_t *level_q8)
{
    for (int i = 0; i < LM_CELLS_MAX; i++) {
        level_q8[i] = LM_LEVEL_SHADOW;
    }
}

/* The level of a cross section by EQUATIONS.md, "Targets". */
static double level_db(double rcs_db, double at_m, double width_m, double length_m)
{
    const struct ref_view view = {height_m, 0, length_m};
    return rcs_db - 10 * log10(width_m * length_m * ref_grazing(&view, at_m, at_m - length_m));
}

/* ---- sector ---- */

/* What a sweep shows: how many cells and lines, the power in all of them, and the middle of the
 * power, counted in lines from the edge of the first. */
struct found {
    uint32_t times, cell;
    double level, line;
};

static struct found sweep(const struct lm_target *targets, uint32_t count, double lat, double lon,
                          double heading)
{
    struct lm_target_candidates candidates;
    struct found f = {0};
    double power = 0;
    int16_t level_q8[LM_CELLS_MAX];
    candidates =
        near_of(targets, count, (struct lm_position){hs_bam(lat), hs_bam(lon)}, (uint32_t)range_m);
    for (uint32_t i = 0; i < LINES; i++) {
        const struct lm_target_line line = sector_line(lat, lon, heading, i);
        clear(level_q8);
        const uint32_t given = lm_target_line_add(&candidates, &line, NULL, level_q8);
        uint32_t changed = 0;
        for (uint32_t k = 0; k < CELLS; k++) {
            if (level_q8[k] != LM_LEVEL_SHADOW) {
                const double cell_power = pow(10, level_q8[k] / 2560.0);
                power += cell_power;
                f.line += (i + 0.5) * cell_power;
                f.cell = k;
                changed++;
            }
        }
        assert_true(given >= changed);
        f.times += changed;
    }
    f.line /= power;
    f.level = 10 * log10(power);
    return f;
}

TEST(a_target_is_in_the_right_cell_of_two_lines_that_share_it)
{
    static const double places[][2] = {{46, 11}, {0, 179.99}, {-71, -40}};
    struct hs_rng rng;
    double worst = 0, worst_line = 0;
    hs_rng_seed(&rng, 3);
    for (int i = 0; i < 60; i++) {
        const double *p = places[i % 3], heading = 360 * hs_rng_uniform(&rng);
        /* Not on the edge of a cell, where a metre decides, and between two lines. */
        const uint32_t line = 1 + hs_rng_below(&rng, LINES - 2);
        const uint32_t cell = 6 + hs_rng_below(&rng, CELLS - 6);
        const double off = 0.1 + 0.8 * hs_rng_uniform(&rng);
        const double azimuth = heading + (line + off - LINES / 2) * 120 / LINES;
        const double at_m = (cell + off) * cell_m, rcs = 60 * hs_rng_uniform(&rng) - 10;
        double to[2];
        wgs84_direct(p[0], p[1], azimuth, at_m, &to[0], &to[1]);
        const struct lm_target t = point_at(to[0], to[1], 0, rcs);
        const struct found f = sweep(&t, 1, p[0], p[1], heading);
        assert_int_equal(f.times, 2);
        assert_int_equal(f.cell, cell);
        const double middle_m = (cell + 0.5) * cell_m;
        const double width_m = middle_m * (120.0 / LINES) * pi / 180;
        worst = fmax(worst, fabs(f.level - level_db(rcs, middle_m, width_m, cell_m)));
        worst_line = fmax(worst_line, fabs(f.line - (line + off)));
    }
    print_message("# worst level in a sweep %.4f dB, worst place %.4f lines\n", worst, worst_line);
    assert_true(worst < 0.04);
    assert_true(worst_line < 0.015);
}

/* Lines a metre apart and cells of two metres, seventy kilometres away. */
TEST(a_target_is_where_the_geodesic_puts_it_within_a_metre)
{
    struct hs_rng rng;
    hs_rng_seed(&rng, 8);
    for (int i = 0; i < 1000; i++) {
        const double lat = 75 * (2 * hs_rng_uniform(&rng) - 1),
                     azimuth = 360 * hs_rng_uniform(&rng);
        double to[2];
        wgs84_direct(lat, 11, azimuth, 70000, &to[0], &to[1]);
        const struct lm_target t = point_at(to[0], to[1], 0, 10);
        struct lm_target_line l = sector_line(lat, 11, azimuth, 0);
        struct lm_target_candidates candidates;
        int16_t level_q8[LM_CELLS_MAX];
        l.azimuth = hs_bam(azimuth);
        l.width = hs_bam(1.0 / 70000 * 180 / pi);
        l.cell_m_q8 = 2 * 256;
        l.first_m_q8 = (70000 - 200) * 256;
        clear(level_q8);
        candidates = near_of(&t, 1, l.position, 70000);
        assert_int_equal(lm_target_line_add(&candidates, &l, NULL, level_q8), 1);
        assert_true(level_q8[100] != LM_LEVEL_SHADOW);
    }
}

TEST(no_target_is_lost_or_doubled_between_two_lines_and_two_cells)
{
    for (int i = 0; i < 200; i++) {
        double to[2];
        wgs84_direct(46, 11, 30 + i * 1e-6, 20000 + i * 0.7, &to[0], &to[1]);
        const struct lm_target t = point_at(to[0], to[1], 0, 10);
        const struct found f = sweep(&t, 1, 46, 11, 30);
        assert_in_range(f.times, 1, 2);
        const double middle_m = (f.cell + 0.5) * cell_m;
        const double width_m = middle_m * (120.0 / LINES) * pi / 180;
        assert_true(fabs(f.level - level_db(10, middle_m, width_m, cell_m)) < 0.04);
    }
}

TEST(different_targets_in_one_cell_add_their_powers)
{
    double to[2];
    wgs84_direct(46, 11, 1.3, 20000, &to[0], &to[1]);
    const struct lm_target t[2] = {point_at(to[0], to[1], 0, 20), point_at(to[0], to[1], 0, 20)};
    const struct found one = sweep(t, 1, 46, 11, 0), both = sweep(t, 2, 46, 11, 0);
    assert_true(fabs(both.level - one.level - 10 * log10(2)) < 0.02);
}

/* Two reflectors of 20 and 26 dBsm ten metres apart share a cell: their phasor sum comes and goes
 * with the bearing. */
TEST(scatterers_of_one_target_in_one_cell_add_as_phasors)
{
    struct lm_target t = point_at(46, 11, 0, 0);
    add_scatterer(&t, LM_SHAPE_SPHERE, 5642, -5000, 500, 0, 0, 0);
    add_scatterer(&t, LM_SHAPE_SPHERE, 11284, 5000, 500, 0, 0, 0);
    double lowest = 1e9, highest = -1e9;
    for (int i = 0; i < 200; i++) {
        double from[2];
        /* In the middle of a cell and, a fifth of a degree off the heading, of a line. */
        wgs84_direct(46, 11, 200 + i * 0.01, 138.5 * cell_m, &from[0], &from[1]);
        const struct found f = sweep(&t, 1, from[0], from[1], 20 + i * 0.01 + 0.2);
        assert_in_range(f.times, 1, 3);
        lowest = fmin(lowest, f.level), highest = fmax(highest, f.level);
    }
    /* (2 + 1)^2 against (2 - 1)^2. */
    print_message("# two in one cell: %.2f dB between in and out of phase\n", highest - lowest);
    assert_true(fabs(highest - lowest - 20 * log10(3)) < 0.1);
}

/* ---- hidden ---- */

enum { BITS = 30 };

TEST(what_lies_below_the_horizon_of_the_cells_before_is_hidden)
{
    double to[2];
    const double azimuth = (100.5 - LINES / 2) * 120 / LINES;
    wgs84_direct(46, 11, azimuth, 140.5 * cell_m, &to[0], &to[1]);
    for (int up_m = -50; up_m <= 50; up_m += 10) {
        const struct lm_target t = point_at(to[0], to[1], up_m, 30);
        const struct lm_target_line l = sector_line(46, 11, 0, 100);
        const double at = ref_tangent(height_m, 140.5 * cell_m, up_m);
        const struct lm_target_candidates candidates =
            near_of(&t, 1, l.position, (uint32_t)range_m);
        for (int i = -1; i <= 1; i += 2) {
            int16_t level_q8[LM_CELLS_MAX];
            int32_t horizon[LM_CELLS_MAX];
            for (int k = 0; k < LM_CELLS_MAX; k++) {
                horizon[k] = (int32_t)ldexp(k > 140 ? 1 : at + i * 1e-6, BITS);
            }
            const struct lm_target_horizon sight = {horizon, BITS};
            clear(level_q8);
            assert_int_equal(lm_target_line_add(&candidates, &l, &sight, level_q8), i < 0);
        }
    }
}

/* Across a pole no place is found: neither is drawn, whatever line looks there. */
TEST(a_target_across_a_pole_is_on_no_line)
{
    const struct lm_position here = {FX_BAM_DEG(89) + FX_BAM_DEG(9) / 10, 0};
    const struct lm_target t = point_at(89.9, 180, 0, 40);
    struct lm_target_candidates candidates = near_of(&t, 1, here, 60000);
    if (candidates.count == 0) { /* or that is so already when it is chosen */
        const struct lm_target near = point_at(89.9, 0.5, 0, 40);
        candidates = near_of(&near, 1, here, 60000);
        assert_int_equal(candidates.count, 1);
        candidates.candidate[0].state.position.longitude = FX_BAM_180;
    }
    for (uint32_t i = 0; i < 3 * LINES; i++) {
        int16_t level_q8[LM_CELLS_MAX];
        struct lm_target_line l = sector_line(89.9, 0, 120.0 * (i / LINES), i % LINES);
        clear(level_q8);
        assert_int_equal(lm_target_line_add(&candidates, &l, NULL, level_q8), 0);
    }
}

/* A beacon whose closing speed the line's gate lets not pass, or that is on no line, answers not.
 */
TEST(a_beacon_outside_of_the_gate_answers_not)
{
    double to[2];
    wgs84_direct(46, 11, (100.5 - LINES / 2) * 120 / LINES, 140.5 * cell_m, &to[0], &to[1]);
    struct lm_target t = point_at(to[0], to[1], 0, 30);
    struct lm_target_reply reply[LM_TARGET_CANDIDATES_MAX];
    t.flags |= LM_TARGET_IS_BEACON;
    t.signature = 3;
    seal_target(&t);
    struct lm_target_line l = sector_line(46, 11, 0, 100);
    const struct lm_target_candidates candidates = near_of(&t, 1, l.position, (uint32_t)range_m);
    assert_int_equal(lm_target_line_replies(&candidates, &l, NULL, reply), 1);
    assert_int_equal(reply[0].code, 3);
    assert_int_equal(reply[0].cell, 140);
    l.gate_mm_s[0] = 5000;
    l.gate_mm_s[1] = 20000;
    assert_int_equal(lm_target_line_replies(&candidates, &l, NULL, reply), 0);
}

/* ---- choice ---- */

TEST(no_more_are_chosen_than_there_is_room_for_and_the_rest_is_counted)
{
    enum { MANY = LM_TARGET_CANDIDATES_MAX + 9 };
    struct lm_target t[MANY + 1];
    struct lm_target_candidates candidates;
    t[0] = point_at(46.6, 11, 0, 0); /* 67 km: out of reach */
    for (int i = 1; i <= MANY; i++) {
        t[i] = point_at(46 + i * 0.001, 11, 0, 0);
    }
    candidates = near_of(t, MANY + 1, (struct lm_position){hs_bam(46), hs_bam(11)}, 37040);
    assert_int_equal(candidates.count, LM_TARGET_CANDIDATES_MAX);
    assert_int_equal(candidates.left_out, 9);
    assert_int_equal(candidates.candidate[0].index, 1);
}

/* An antenna that has flown on since the choice finds the same targets as one that has just chosen.
 */
TEST(a_choice_holds_for_a_kilometre_of_flight)
{
    struct hs_rng rng;
    hs_rng_seed(&rng, 5);
    for (int i = 0; i < 3000; i++) {
        double to[2], from[2];
        const double to_m = 300 + 36000 * hs_rng_uniform(&rng);
        wgs84_direct(46, 11, 360 * hs_rng_uniform(&rng), to_m, &to[0], &to[1]);
        wgs84_direct(46, 11, 360 * hs_rng_uniform(&rng), 1020, &from[0], &from[1]);
        const struct lm_target t = point_at(to[0], to[1], 0, 10);
        struct lm_target_candidates before, now;
        int16_t level_q8[LM_CELLS_MAX];
        const struct lm_position here = {hs_bam(from[0]), hs_bam(from[1])};
        before = near_of(&t, 1, (struct lm_position){hs_bam(46), hs_bam(11)}, 37040);
        now = near_of(&t, 1, here, 37040);
        struct lm_target_line l = sector_line(from[0], from[1], 0, 0);
        l.azimuth = fx_atan2(now.candidate[0].east_m_q8, now.candidate[0].north_m_q8);
        clear(level_q8);
        assert_int_equal(lm_target_line_add(&before, &l, NULL, level_q8),
                         lm_target_line_add(&now, &l, NULL, level_q8));
    }
}

/* A line beside a target, by no more than a few times what the target and the line are wide, of a
 * radar that has flown on since the choice; it may begin or end beside the target. */
static struct lm_target_line line_beside(struct hs_rng *rng, double lat, double to_azimuth,
                                         double at_m)
{
    double from[2];
    const double away_m = 1000 * hs_rng_uniform(rng);
    wgs84_direct(lat, 11, 360 * hs_rng_uniform(rng), away_m, &from[0], &from[1]);
    struct lm_target_line l = sector_line(from[0], from[1], 0, 0);
    const double off = pow(hs_rng_uniform(rng), 3) * (hs_rng_below(rng, 2) ? 1 : -1);
    l.azimuth = hs_bam(to_azimuth + off * (5 + 90 * fmin(1, 2500 / at_m)));
    l.is_doppler = hs_rng_below(rng, 2) != 0;
    l.beam = FX_BAM_DEG(3);
    l.speed_mm_s = 100000;
    l.track = l.azimuth + FX_BAM_DEG(50);
    l.width *= 1 + hs_rng_below(rng, 10);
    const uint32_t edge = (uint32_t)(fmax(at_m - 1200 + 2400 * hs_rng_uniform(rng), 0) / cell_m);
    l.first = hs_rng_below(rng, 4) ? 0 : edge;
    l.cells = hs_rng_below(rng, 4) ? CELLS : edge;
    return l;
}

/* Points, bodies up to 370 m from their origin, and movers, near and far: the quick look at what a
 * line may meet loses none. With the slack of the whole Earth, all of them are looked at. */
TEST(a_target_that_is_passed_over_would_have_given_the_line_nothing)
{
    static const double latitudes[] = {0, 46, -75, 87};
    struct hs_rng rng;
    uint32_t given = 0;
    hs_rng_seed(&rng, 9);
    for (int i = 0; i < 40000; i++) {
        double to[2];
        const double lat = latitudes[i % 4], azimuth = 360 * hs_rng_uniform(&rng);
        const double at_m = 300 + 36000 * pow(hs_rng_uniform(&rng), 2);
        wgs84_direct(lat, 11, azimuth, at_m, &to[0], &to[1]);
        struct lm_target t = i % 3 ? point_at(0, 0, 0, 10) : random_target(&rng, 1 << 18);
        t.latitude = hs_bam(to[0]), t.longitude = hs_bam(to[1]);
        if (i % 3 == 1) {
            t.heading = (fx_bam_t)hs_rng_u64(&rng);
            t.speed_mm_s = 15000, t.leg_m = 1;
        }
        const struct lm_target_line l = line_beside(&rng, lat, azimuth, at_m);
        struct lm_target_candidates candidates =
            near_of(&t, 1, (struct lm_position){hs_bam(lat), hs_bam(11)}, (uint32_t)range_m);
        int16_t quick_q8[LM_CELLS_MAX], all_q8[LM_CELLS_MAX];
        clear(quick_q8), clear(all_q8);
        lm_target_line_add(&candidates, &l, NULL, quick_q8);
        candidates.candidate[0].slack_m_q8 = 1u << 31;
        given += lm_target_line_add(&candidates, &l, NULL, all_q8) != 0;
        assert_memory_equal(quick_q8, all_q8, sizeof all_q8);
    }
    print_message("# %u of 40000 lines were given something\n", given);
    assert_true(given > 2500);
}

/* ---- hostile records ---- */

/* Records that were changed at random and sealed again, as a hostile image might have them: those
 * that pass the check can be used from anywhere (built with the sanitizers, too: targets.mk). */
TEST(a_record_that_passes_the_check_can_be_used)
{
    struct hs_rng rng;
    struct lm_target t = {0};
    uint32_t passed = 0, given = 0;
    hs_rng_seed(&rng, 6);
    for (int i = 0; i < 20000; i++) {
        if (i % 10 == 0) {
            t = random_target(&rng, LM_TARGET_OFFSET_MAX_MM);
        }
        if (!damage_target(&rng, &t)) {
            t = random_target(&rng, LM_TARGET_OFFSET_MAX_MM);
            continue;
        }
        passed++;
        const bool is_here = hs_rng_below(&rng, 2) != 0;
        struct lm_target_line l = sector_line(46, 11, 0, 1);
        l.position = is_here
                         ? (struct lm_position){t.latitude + hs_rng_below(&rng, 9000), t.longitude}
                         : (struct lm_position){(fx_bam_t)((int64_t)hs_rng_u64(&rng) >> 34),
                                                (fx_bam_t)hs_rng_u64(&rng)};
        l.azimuth = (fx_bam_t)hs_rng_u64(&rng);
        l.width = FX_BAM_180;
        l.is_doppler = i % 2;
        l.track = (fx_bam_t)hs_rng_u64(&rng);
        l.speed_mm_s = hs_rng_below(&rng, 1 << 21);
        l.wavelength_um = i % 3 ? LM_WAVELENGTH_MIN_UM : LM_WAVELENGTH_MAX_UM;
        struct lm_target_candidates candidates;
        int16_t level_q8[LM_CELLS_MAX];
        int32_t horizon[LM_CELLS_MAX] = {0};
        const struct lm_target_horizon sight = {horizon, 20};
        clear(level_q8);
        candidates = near_of(&t, 1, l.position, 250000);
        given += lm_target_line_add(&candidates, &l, i % 5 ? NULL : &sight, level_q8);
    }
    print_message("# %u records passed, %u cells were given something\n", passed, given);
    assert_true(passed > 2000 && given > 500);
}
