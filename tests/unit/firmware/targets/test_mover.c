/* Targets that move: where they are, and where a Doppler picture puts them. Places come from
 * PROJ's geodesics, displacements from theory: V cos(o') = V cos(o) + v. */
#include "hs/angle.h"
#include "lm/radar.h"
#include "lm/scan_conv.h"
#include "lm/target_line.h"

#include "check.h"
#include "lm/illumination.h"
#include "reference/reference.h"
#include "target_support.h"
#include "tiny_map.h"
#include "wgs84.h"

static const double pi = 3.14159265358979323846;

enum { CELLS = 256, LINES = 4096, RANGE_M = 37040 };
static const double height_m = 6000, cell_m = (double)RANGE_M / CELLS;

static double metres_apart(const double a[2], struct lm_position b)
{
    return wgs84_metres(a[0], a[1], hs_degrees(b.latitude), hs_degrees(b.longitude));
}

static struct lm_target moving_point(double lat, double lon, double heading, double speed_m_s,
                                     uint32_t leg_m)
{
    struct lm_target t = point_at(lat, lon, 0, 40);
    t.heading = hs_bam(heading);
    t.speed_mm_s = (uint32_t)lround(speed_m_s * 1000);
    t.leg_m = leg_m;
    seal_target(&t);
    return t;
}

/* ---- where it is ---- */

TEST(a_mover_goes_to_the_end_of_its_leg_and_back)
{
    const struct lm_target t = moving_point(46, 11, 30, 20, 5000); /* 250 s each way */
    const double times_s[] = {0, 1, 100, 249, 251, 400, 499, 500, 700, 1e6, 1e9};
    for (size_t i = 0; i < sizeof times_s / sizeof *times_s; i++) {
        const double gone = fmod(times_s[i] * 20, 10000);
        const double way = gone > 5000 ? 10000 - gone : gone;
        double to[2];
        wgs84_direct(46, 11, 30, way, &to[0], &to[1]);
        const struct lm_mover_state mover = lm_mover_state_at(&t, (uint64_t)(times_s[i] * 1e6));
        assert_true(metres_apart(to, mover.position) < 0.05);
        assert_int_equal(mover.heading, gone > 5000 ? hs_bam(210) : hs_bam(30));
    }
}

TEST(the_slowest_the_fastest_and_the_longest_stay_on_their_leg)
{
    const struct {
        uint32_t speed_mm_s, leg_m;
    } cases[] = {{1, LM_TARGET_LEG_MAX_M},
                 {LM_TARGET_SPEED_MAX_MM_S, 1},
                 {LM_TARGET_SPEED_MAX_MM_S, LM_TARGET_LEG_MAX_M}};
    const uint64_t times_us[] = {0, 1, 1ull << 32, 1ull << 53, UINT64_MAX};
    for (size_t i = 0; i < 3; i++) {
        struct lm_target t = moving_point(46, 11, 90, 1, cases[i].leg_m);
        t.speed_mm_s = cases[i].speed_mm_s;
        seal_target(&t);
        assert_int_equal(lm_target_check(&t), LM_OK);
        for (size_t k = 0; k < sizeof times_us / sizeof *times_us; k++) {
            const double from[2] = {46, 11};
            const struct lm_mover_state mover = lm_mover_state_at(&t, times_us[k]);
            assert_true(metres_apart(from, mover.position) < cases[i].leg_m + 0.1);
        }
    }
}

TEST(a_target_without_speed_stays)
{
    const struct lm_target t = point_at(46, 11, 0, 10);
    const struct lm_mover_state mover = lm_mover_state_at(&t, UINT64_MAX);
    assert_int_equal(mover.position.latitude, t.latitude);
    assert_int_equal(mover.position.longitude, t.longitude);
    assert_int_equal(mover.heading, t.heading);
}

/* A way by places: legs of 3, 20 and 0.5 km. */
static const double places[4][2] = {{46, 11}, {46.02, 11.026}, {46.19, 11.1}, {46.186, 11.104}};

/* The first `legs` legs, by PROJ. */
static struct lm_target path_target(uint8_t legs, double speed_m_s, double length_m[])
{
    const struct geod_geodesic earth = wgs84();
    struct lm_target t = point_at(places[0][0], places[0][1], 0, 40);
    for (uint8_t i = 0; i < legs; i++) {
        const double *from = places[i], *to = places[i + 1];
        double heading;
        geod_inverse(&earth, from[0], from[1], to[0], to[1], &length_m[i], &heading, NULL);
        t.path[i] = (struct lm_path_leg){hs_bam(from[0]), hs_bam(from[1]), hs_bam(heading),
                                         (uint32_t)lround(length_m[i] * 1000)};
    }
    t.flags = LM_TARGET_HAS_PATH;
    t.path_legs = legs;
    t.heading = t.path[0].heading;
    t.speed_mm_s = (uint32_t)lround(speed_m_s * 1000);
    seal_target(&t);
    return t;
}

TEST(a_mover_on_a_path_goes_through_its_places_and_back_or_round)
{
    double length_m[3];
    struct lm_target t = path_target(3, 20, length_m);
    const double whole_m = length_m[0] + length_m[1] + length_m[2];
    for (int is_round = 0; is_round < 2; is_round++) {
        t.path_is_round = is_round != 0;
        seal_target(&t);
        assert_int_equal(lm_target_check(&t), LM_OK);
        for (double seconds = 0; seconds < 20000; seconds += 37.5) {
            const double gone = fmod(seconds * 20, is_round ? whole_m : 2 * whole_m);
            const bool is_back = gone > whole_m;
            double way = is_back ? 2 * whole_m - gone : gone, to[2];
            int leg = 0;
            while (leg < 2 && way > length_m[leg]) {
                way -= length_m[leg++];
            }
            const fx_bam_t heading = t.path[leg].heading;
            wgs84_direct(places[leg][0], places[leg][1], hs_degrees(heading), way, &to[0], &to[1]);
            const struct lm_mover_state mover = lm_mover_state_at(&t, (uint64_t)(seconds * 1e6));
            assert_true(metres_apart(to, mover.position) < 0.05);
            assert_int_equal(mover.heading, heading + (is_back ? FX_BAM_180 : 0));
        }
    }
}

TEST(the_longest_path_and_the_shortest_are_gone_at_any_time)
{
    double length_m[1];
    for (int i = 0; i < 4; i++) {
        struct lm_target t = path_target(1, 20, length_m);
        t.path_is_round = i % 2 != 0;
        t.path_legs = i < 2 ? 1 : LM_TARGET_LEGS_MAX;
        t.speed_mm_s = i < 2 ? LM_TARGET_SPEED_MAX_MM_S : 1;
        for (int k = 0; k < t.path_legs; k++) {
            t.path[k] = t.path[0];
            t.path[k].length_mm = i < 2 ? 1000 : LM_TARGET_LEG_MAX_M * 1000u;
        }
        seal_target(&t);
        assert_int_equal(lm_target_check(&t), LM_OK);
        for (uint64_t time = 1; time != 0; time <<= 1) {
            const struct lm_mover_state mover = lm_mover_state_at(&t, time - 1);
            assert_true(metres_apart(places[0], mover.position) <
                        t.path[0].length_mm / 1000.0 + 0.1);
        }
    }
}

TEST(an_unsound_path_is_refused)
{
    double length_m[3];
    for (int lie = 0; lie < 11; lie++) {
        struct lm_target t = path_target(3, 20, length_m);
        switch (lie) {
        case 0:
            break;
        case 1:
            t.path_legs = 0;
            break;
        case 2:
            t.path_legs = LM_TARGET_LEGS_MAX + 1;
            break;
        case 3:
            t.path_is_round = 2;
            break;
        case 4:
            t.leg_m = 1;
            break;
        case 5:
            t.speed_mm_s = 0;
            break;
        case 6:
            t.speed_mm_s = LM_TARGET_SPEED_MAX_MM_S + 1;
            break;
        case 7:
            t.path[2].length_mm = 999;
            break;
        case 8:
            t.path[1].length_mm = LM_TARGET_LEG_MAX_M * 1000u + 1;
            break;
        case 9:
            t.path[2].latitude = FX_BAM_90 + 1;
            break;
        default:
            t.flags = 0;
            break;
        }
        seal_target(&t);
        assert_int_equal(lm_target_check(&t), lie == 0 ? LM_OK : LM_ERR_CORRUPT);
    }
    struct lm_target bodies = path_target(1, 20, length_m);
    bodies.scatterer_count = 1;
    bodies.scatterers[0] = (struct lm_scatterer){.kind = LM_SHAPE_SPHERE, .size_mm = {1000, 0}};
    seal_target(&bodies);
    assert_int_equal(lm_target_check(&bodies), LM_ERR_CORRUPT);
}

TEST(unsound_motion_is_refused)
{
    const struct {
        uint32_t speed_mm_s, leg_m;
        uint16_t flags;
        int status;
    } cases[] = {{0, 0, 0, LM_OK},
                 {0, 0, LM_TARGET_ABOVE_GROUND, LM_OK},
                 {0, 1, 0, LM_ERR_CORRUPT},
                 {1, 0, 0, LM_ERR_CORRUPT},
                 {1, LM_TARGET_LEG_MAX_M + 1, 0, LM_ERR_CORRUPT},
                 {LM_TARGET_SPEED_MAX_MM_S + 1, 1, 0, LM_ERR_CORRUPT},
                 {0, 0, LM_TARGET_FLAGS + 1, LM_ERR_CORRUPT},
                 {0, 0, 0x8000, LM_ERR_CORRUPT}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct lm_target t = point_at(46, 11, 0, 10);
        t.speed_mm_s = cases[i].speed_mm_s;
        t.leg_m = cases[i].leg_m;
        t.flags = cases[i].flags;
        seal_target(&t);
        assert_int_equal(lm_target_check(&t), cases[i].status);
    }
}

/* ---- where it appears ---- */

/* The definition itself: still ground where the target appears has its Doppler shift. */
TEST(the_shift_solves_v_cos_o_plus_v_r_wherever_that_has_a_solution)
{
    const double speed = 250000;
    double worst = 0;
    int without = 0;
    for (int tenths = -1799; tenths < 1800; tenths += 7) {
        for (int closing = -30000; closing <= 30000; closing += 777) {
            const double off = tenths / 10.0 * pi / 180, cosine = cos(off) + closing / speed;
            int32_t shift;
            const bool has = lm_mover_shift(closing, 250000, hs_bam(tenths / 10.0), &shift);
            if (fabs(fabs(cosine) - 1) < 1e-8) {
                continue; /* a matter of rounding */
            }
            assert_int_equal(has, fabs(cosine) < 1);
            without += !has;
            const double nearer = has ? fabs(off) - acos(cosine) : 0;
            const double error =
                hs_degrees((fx_bam_t)shift) * pi / 180 - copysign(nearer, off * nearer);
            worst = fmax(worst, fabs(error));
        }
    }
    print_message("# worst shift %.1e radian; %d have none\n", worst, without);
    assert_true(worst < 1e-6);
    assert_true(without > 500);
    int32_t shift;
    assert_true(lm_mover_shift(1000, 0, hs_bam(45), &shift));
    assert_int_equal(shift, 0);
}

/* Lines of 120 degrees / 4096, half a milliradian: 19 m at 37 km. */
static struct lm_target_line sector_line(uint32_t line)
{
    const fx_bam_t width = FX_BAM_DEG(120) / LINES;
    const uint32_t cell_q8 = (uint32_t)(cell_m * 256);
    return (struct lm_target_line){
        .position = {hs_bam(46), hs_bam(11)},
        .azimuth = (fx_bam_t)(((int32_t)line - LINES / 2) * (int32_t)width) + width / 2,
        .width = width,
        .first_m_q8 = cell_q8 / 2,
        .cell_m_q8 = cell_q8,
        .cells = CELLS,
        .height_m_q10 = (int32_t)(height_m * 1024),
        .wavelength_um = X_BAND_UM};
}

/* The power of the target in all lines, and its middle, degrees. */
static double power_of(const struct lm_target *t, const struct lm_target_line *how, double *at_deg)
{
    struct lm_target_candidates candidates;
    const struct lm_target_set set = {.items = t, .count = 1};
    const struct lm_target_query scene = {.position = {hs_bam(46), hs_bam(11)}, .reach_m = RANGE_M};
    int16_t level_q8[LM_CELLS_MAX];
    double power = 0, moment = 0;
    lm_target_candidates_select(&candidates, &set, &scene);
    for (uint32_t i = 0; i < LINES; i++) {
        struct lm_target_line line = sector_line(i);
        line.is_doppler = how->is_doppler;
        line.beam = hs_bam(3.3);
        line.speed_mm_s = how->speed_mm_s;
        line.track = how->track;
        line.gate_mm_s[0] = how->gate_mm_s[0];
        line.gate_mm_s[1] = how->gate_mm_s[1];
        for (int k = 0; k < LM_CELLS_MAX; k++) {
            level_q8[k] = LM_LEVEL_SHADOW;
        }
        (void)lm_target_line_add(&candidates, &line, NULL, level_q8);
        for (int k = 0; k < CELLS; k++) {
            const double cell_power =
                level_q8[k] == LM_LEVEL_SHADOW ? 0 : pow(10, level_q8[k] / 2560.0);
            power += cell_power;
            moment += cell_power * hs_degrees(line.azimuth);
        }
    }
    *at_deg = moment / power;
    return power;
}

static double decibels(double ratio)
{
    return 10 * log10(ratio);
}

/* Where its Doppler shift is that of still ground, weakened by the two-way pattern of the beam that
 * looks there: 24.08 dB times the square of the displacement in beams. */
TEST(a_sharpened_sector_shows_a_mover_where_ground_has_its_shift_if_the_beam_sees_it)
{
    struct hs_rng rng;
    int seen = 0, unseen = 0;
    hs_rng_seed(&rng, 12);
    for (int i = 0; i < 80; i++) {
        const double azimuth = 80 * hs_rng_uniform(&rng) - 40, heading = 360 * hs_rng_uniform(&rng);
        const double speed = 12 * hs_rng_uniform(&rng), track = i % 2 ? 55 : -55;
        double to[2], at_deg = 0, moved_deg;
        wgs84_direct(46, 11, azimuth, 20000 + 10000 * hs_rng_uniform(&rng), &to[0], &to[1]);
        const struct lm_target t = moving_point(to[0], to[1], heading, speed, 1000);
        const struct lm_target_line how = {.is_doppler = true,
                                           .speed_mm_s = 250000,
                                           .track = hs_bam(track)},
                                    plain = {0};
        const double still = power_of(&t, &plain, &at_deg), moved = power_of(&t, &how, &moved_deg);
        assert_true(fabs(at_deg - azimuth) < 30.0 / LINES);
        const double closing = -speed * cos((heading - azimuth) * pi / 180);
        const double off = fabs(track - azimuth) * pi / 180, cosine = cos(off) + closing / 250;
        const double nearer_deg = (off - acos(cosine)) * 180 / pi;
        const double beams = nearer_deg / 3.3;
        if (!(fabs(beams) < 1.25)) {
            assert_true(moved == 0 || fabs(fabs(beams) - 1.25) < 0.01);
            unseen++;
            continue;
        }
        seen++;
        assert_true(fabs(moved_deg - azimuth -
                         copysign(nearer_deg, (track - azimuth) * nearer_deg)) < 120.0 / LINES);
        assert_true(fabs(decibels(moved / still) + 80 * log10(2) * beams * beams) < 0.5);
    }
    assert_true(seen > 40 && unseen > 5);
}

/* Cells that hold some of a mover in the line that it lies in, and whether they hold it alike. */
static int cells_filled(uint32_t stretch_cells, double range_m, bool *are_alike)
{
    const struct lm_target t = moving_point(46 + range_m / 111132, 11, 180, 10, 1000);
    const struct lm_target_set set = {.items = &t, .count = 1};
    const struct lm_target_query scene = {.position = {hs_bam(46), hs_bam(11)}, .reach_m = RANGE_M};
    struct lm_target_candidates candidates;
    struct lm_target_line line = sector_line(LINES / 2);
    int16_t level_q8[LM_CELLS_MAX], highest = INT16_MIN, lowest = INT16_MAX;
    int filled = 0;
    lm_target_candidates_select(&candidates, &set, &scene);
    line.gate_mm_s[1] = 20000;
    line.stretch_cells = stretch_cells;
    for (int k = 0; k < LM_CELLS_MAX; k++) {
        level_q8[k] = LM_LEVEL_SHADOW;
    }
    (void)lm_target_line_add(&candidates, &line, NULL, level_q8);
    for (int k = 0; k < LM_CELLS_MAX; k++) {
        if (level_q8[k] != LM_LEVEL_SHADOW) {
            filled++;
            highest = level_q8[k] > highest ? level_q8[k] : highest;
            lowest = level_q8[k] < lowest ? level_q8[k] : lowest;
        }
    }
    *are_alike = highest == lowest;
    return filled;
}

TEST(a_stretched_mover_fills_the_cells_beside_its_own_and_none_beyond_the_line)
{
    bool are_alike;
    for (uint32_t stretch = 0; stretch <= 4; stretch++) {
        assert_int_equal(cells_filled(stretch, 20000, &are_alike), 2 * stretch + 1);
        assert_true(are_alike);
        const double last_cell_m = RANGE_M * (1 - 0.5 / CELLS);
        assert_int_equal(cells_filled(stretch, last_cell_m - 60, &are_alike), stretch + 1);
    }
}

TEST(a_mover_of_gmt_is_three_pixels_thick_or_more_on_a_glass_of_480)
{
    const struct lm_frame frame = lm_frame_of_display(480, 480);
    const uint32_t cells = 2u * lm_radar_default.mode[LM_SECTOR_GMT].stretch_cells + 1;
    assert_true(cells * lm_ppi_radius_px(&frame, false) >= 3u * lm_radar_default.cells);
}

TEST(the_gates_show_only_closing_speeds_within_them_either_way)
{
    const struct lm_target_line how = {.gate_mm_s = {2000, 20000}};
    double at_deg;
    for (int speed = 0; speed <= 24; speed++) {
        for (int is_away = 0; is_away < 2; is_away++) {
            struct lm_target t = moving_point(46.2, 11, is_away ? 0 : 180, speed, 1000);
            if (speed == 0) {
                t.leg_m = 0;
                seal_target(&t);
            }
            assert_int_equal(power_of(&t, &how, &at_deg) > 0, speed >= 2 && speed <= 20);
        }
    }
    /* Across the line of sight it has none. */
    const struct lm_target t = moving_point(46.2, 11, 90, 15, 1000);
    assert_true(power_of(&t, &how, &at_deg) == 0);
}

/* Theory: the beam sees still ground at closing speeds from V cos(o + B/2) to V cos(o - B/2). */
TEST(the_clutter_of_the_beam_spreads_by_the_cosines_of_its_edges)
{
    struct hs_rng rng;
    double worst = 0;
    hs_rng_seed(&rng, 23);
    for (int i = 0; i < 20000; i++) {
        const double off_deg = 360 * hs_rng_uniform(&rng) - 180;
        const double beam_deg = 0.8 + 19.2 * hs_rng_uniform(&rng);
        const uint32_t speed_mm_s = hs_rng_below(&rng, 2000001);
        const double near = cos((off_deg - beam_deg / 2) * pi / 180),
                     far = cos((off_deg + beam_deg / 2) * pi / 180);
        const uint32_t spread_mm_s =
            lm_mover_clutter_mm_s(speed_mm_s, hs_bam(beam_deg), hs_bam(off_deg));
        const double wanted_mm_s =
            1000 * ref_gmt_least_m_s(0, speed_mm_s / 1000.0, beam_deg, off_deg);
        /* V B sin o / 2 is the first term of the difference: the next is B^2 / 24 of it. */
        const double exact_mm_s = fabs(near - far) / 2 * speed_mm_s;
        assert_true(fabs(wanted_mm_s / exact_mm_s - 1) < 0.006 || exact_mm_s < 1);
        assert_true(fabs(spread_mm_s - wanted_mm_s) < 2 + wanted_mm_s / 4096 + speed_mm_s / 32768.);
        worst = fmax(worst, fabs(spread_mm_s - wanted_mm_s));
    }
    print_message("# clutter's spread: worst error %.0f mm/s at up to 2 km/s\n", worst);
    assert_int_equal(lm_mover_clutter_mm_s(250000, hs_bam(3.3), 0), 0);
    assert_int_equal(lm_mover_clutter_mm_s(0, hs_bam(3.3), hs_bam(90)), 0);
}

/* Movers that come nearer at speeds a little below and above the gate, at any angle off the
 * velocity. */
TEST(the_gate_is_never_finer_than_the_clutter_of_the_beam)
{
    double at_deg;
    for (int off_deg = -170; off_deg <= 170; off_deg += 20) {
        const struct lm_target_line how = {
            .gate_mm_s = {1543, 51444}, .speed_mm_s = 180000, .track = hs_bam(off_deg)};
        const double least = ref_gmt_least_m_s(1.543, 180, 3.3, off_deg);
        const struct lm_target slow = moving_point(46.2, 11, 180, least - 0.02, 1000);
        const struct lm_target fast = moving_point(46.2, 11, 180, least + 0.02, 1000);
        assert_true(power_of(&slow, &how, &at_deg) == 0);
        assert_true(power_of(&fast, &how, &at_deg) > 0);
    }
}

/* ---- when ---- */

TEST(movers_are_placed_anew_for_every_sweep_and_not_for_every_line)
{
    const struct lm_target t = moving_point(46.1, 11, 90, 50, 50000);
    const struct lm_target_set set = {.items = &t, .count = 1};
    struct lm_target_query scene = {.position = {hs_bam(46), hs_bam(11)}, .reach_m = RANGE_M};
    struct lm_target_candidates candidates = {0};
    lm_target_candidates_refresh(&candidates, &set, &scene);
    const struct lm_position first = candidates.candidate[0].state.position;
    scene.position.latitude += 1000; /* the antenna moves on, in the same sweep */
    lm_target_candidates_refresh(&candidates, &set, &scene);
    assert_memory_equal(&candidates.candidate[0].state.position, &first, sizeof first);
    scene.time_us = 8000000; /* the next sweep */
    lm_target_candidates_refresh(&candidates, &set, &scene);
    double to[2];
    wgs84_direct(46.1, 11, 90, 400, &to[0], &to[1]);
    assert_true(metres_apart(to, candidates.candidate[0].state.position) < 0.05);
}

/* ---- how high ---- */

static double hill(void *ctx, const struct tiny_place *p)
{
    (void)ctx;
    return 300 + p->east_m / 20;
}

/* A target 25 m high goes east over a hill: above the ground, or above the sea. */
static void check_heights(bool is_above_ground)
{
    struct tiny_map map;
    struct tiny_spec spec = tiny_spec_at(46, 11);
    spec.shift0 = 11;
    spec.rows = spec.columns = 4;
    spec.elevation_m = hill;
    tiny_map_open(&map, &spec, 32);
    struct lm_target t = moving_point(46, 11, 90, 10, 2000);
    t.elevation_m_q6 = 25 * 64;
    t.flags = is_above_ground ? LM_TARGET_ABOVE_GROUND : 0;
    seal_target(&t);
    const struct lm_target_set set = {.items = &t, .count = 1};
    for (uint64_t seconds = 0; seconds <= 200; seconds += 50) {
        const struct lm_target_query scene = {.position = {hs_bam(46), hs_bam(11)},
                                              .reach_m = 5000,
                                              .time_us = seconds * 1000000,
                                              .tiles = &map.tiles};
        struct lm_target_candidates candidates = {0};
        lm_target_candidates_refresh(&candidates, &set, &scene); /* asks for the tile */
        tiny_map_read_tiles(&map);
        candidates.is_chosen = false;
        lm_target_candidates_refresh(&candidates, &set, &scene);
        const double expected_m = is_above_ground ? 325 + (double)seconds * 10 / 20 : 25;
        assert_true(fabs(candidates.candidate[0].elevation_m_q6 / 64.0 - expected_m) < 1);
    }
    tiny_map_close(&map);
}

TEST(a_target_above_the_ground_stands_on_the_map_wherever_it_has_gone)
{
    check_heights(true);
}

TEST(a_target_above_the_sea_stays_as_high_wherever_it_has_gone)
{
    check_heights(false);
}
