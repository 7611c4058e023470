/* What is known between the fixes of a track, and what is not. */
#include "check.h"
#include "nav/make_track.h"
#include "nav/read_track.h"
#include "nav/route.h"
#include "nav/track.h"
#include "support.h"
#include "wgs84.h"

#include <math.h>

static const double degree = 3.14159265358979323846 / 180.0;
static const struct nav_limits usual = {0, 411};

/* cmocka compares single precision only. */
static void assert_near(double is, double wanted, double tolerance)
{
    assert_true(fabs(is - wanted) <= tolerance);
}

static void add(struct nav_track *t, double seconds, double latitude, double longitude)
{
    struct nav_fix f = nav_fix_blank();
    f.time_us = llround((1000000 + seconds) * 1e6);
    f.latitude_deg = latitude;
    f.longitude_deg = longitude;
    f.height_m = 500 + 10 * seconds;
    assert_int_equal(nav_track_add(t, &f), 0);
}

/* Against the direct and inverse problems of PROJ's geodesic library: at a share of the time the
 * aircraft has done that share of the way and not left the geodesic, anywhere on the globe. */
TEST(the_position_follows_the_geodesic_at_constant_speed)
{
    static const double ends[][4] = {{43.5, 7, 43.51, 7.02},
                                     {0, 179.99, 0.01, -179.98},
                                     {-60, 20, -59.97, 20.1},
                                     {89.98, 0, 89.99, 170},
                                     {-0.01, -30, 0.02, -30}};
    for (int i = 0; i < 5; i++) {
        struct nav_track t = {0};
        struct nav_findings found;
        struct nav_motion m;
        struct nav_state s;
        const double *e = ends[i];
        add(&t, 0, e[0], e[1]);
        add(&t, 10, e[2], e[3]);
        nav_track_complete(&t, &(struct nav_limits){0, 1e9}, &found);
        nav_motion_init(&m, &t);
        const double whole = wgs84_metres(e[0], e[1], e[2], e[3]);
        for (int k = 0; k <= 10; k++) {
            nav_motion_position(&m, t.fix[0].time_us + k * 1000000, &s);
            const double done = wgs84_metres(e[0], e[1], s.latitude_deg, s.longitude_deg);
            const double left = wgs84_metres(s.latitude_deg, s.longitude_deg, e[2], e[3]);
            assert_near(done, whole * k / 10, 1e-6);
            assert_near(done + left, whole, 1e-6);
            assert_near(s.height_m, 500 + 10 * k, 1e-9);
        }
        nav_track_free(&t);
    }
}

TEST(a_gap_is_not_covered_and_ends_the_leg)
{
    struct nav_track t = {0};
    struct nav_findings found;
    struct nav_motion m;
    for (int i = 0; i <= 40; i++) {
        add(&t, i < 20 ? i : i + 31, 43 + i * 0.001, 7);
    }
    nav_track_complete(&t, &usual, &found);
    assert_int_equal(found.gaps, 1);
    assert_near(found.max_gap_s, 30, 0);
    nav_motion_init(&m, &t);
    const int64_t start = t.fix[0].time_us;
    assert_true(nav_motion_covers(&m, start));
    assert_true(nav_motion_covers(&m, start + 19000000));
    assert_false(nav_motion_covers(&m, start + 19000001));
    assert_false(nav_motion_covers(&m, start + 50999999));
    assert_true(nav_motion_covers(&m, start + 51000000));
    assert_false(nav_motion_covers(&m, start - 1));
    assert_false(nav_motion_covers(&m, t.fix[40].time_us + 1));
    /* Speeds beside the gap come from their own side of it. */
    assert_near(t.fix[19].speed_ms, 111, 1);
    assert_near(t.fix[20].speed_ms, 111, 1);
    nav_track_free(&t);
}

TEST(a_slow_track_has_a_longer_gap_by_default)
{
    struct nav_track t = {0};
    struct nav_findings found;
    for (int i = 0; i < 10; i++) {
        add(&t, 60 * i + (i > 5 ? 100 : 0), 43 + i * 0.01, 7);
    }
    nav_track_complete(&t, &usual, &found);
    assert_near(found.max_gap_s, 180, 0);
    assert_int_equal(found.gaps, 0);
    nav_track_free(&t);
}

/* 5 km in a second: the aircraft stays where it was until the second is over, and nothing that is
 * derived knows of the jump. */
TEST(a_jump_happens_at_its_time_and_nowhere_else)
{
    struct nav_track t = {0};
    struct nav_findings found;
    struct nav_motion m;
    struct nav_state s;
    for (int i = 0; i <= 20; i++) {
        add(&t, i, 43 + i * 0.001 + (i > 10 ? 0.05 : 0), 7);
    }
    nav_track_complete(&t, &usual, &found);
    assert_int_equal(found.jumps, 1);
    nav_motion_init(&m, &t);
    const int64_t start = t.fix[0].time_us;
    nav_motion_position(&m, start + 10999999, &s);
    assert_near(s.latitude_deg, 43.010, 1e-12);
    nav_motion_position(&m, start + 11000000, &s);
    assert_near(s.latitude_deg, 43.061, 1e-12);
    for (int i = 0; i <= 20; i++) {
        assert_near(t.fix[i].speed_ms, 111.1, 0.5);
        assert_near(t.fix[i].roll_deg, 0, 1e-6);
    }
    nav_track_free(&t);
}

TEST(a_held_position_is_kept_and_counted)
{
    struct nav_track t = {0};
    struct nav_findings found;
    struct nav_motion m;
    struct nav_state s;
    for (int i = 0; i <= 10; i++) {
        add(&t, i, 43 + (i == 5 ? 4 : i) * 0.001, 7);
    }
    nav_track_complete(&t, &usual, &found);
    assert_int_equal(found.holds, 1);
    assert_int_equal(found.jumps, 0);
    nav_motion_init(&m, &t);
    nav_motion_position(&m, t.fix[0].time_us + 4500000, &s);
    assert_near(s.latitude_deg, 43.004, 1e-12);
    nav_track_free(&t);
}

TEST(what_the_record_says_is_not_replaced)
{
    struct nav_track t = {0};
    struct nav_findings found;
    for (int i = 0; i < 5; i++) {
        add(&t, i, 43 + i * 0.001, 7);
        t.fix[i].heading_deg = 33;
        t.fix[i].roll_deg = -12;
        t.fix[i].speed_ms = 90;
        t.fix[i].track_deg = 2;
        t.fix[i].climb_ms = 1;
        t.fix[i].pitch_deg = 4;
    }
    nav_track_complete(&t, &usual, &found);
    assert_true(t.fix[2].heading_deg == 33 && t.fix[2].roll_deg == -12);
    assert_true(t.fix[2].speed_ms == 90 && t.fix[2].track_deg == 2);
    assert_true(t.fix[2].climb_ms == 1 && t.fix[2].pitch_deg == 4);
    nav_track_free(&t);
}

/* A turn of v / R needs a bank of atan(v^2 / (g R)); with only positions given, that is what must
 * come out of them, for right and left turns, and the climb angle as pitch. */
TEST(bank_and_pitch_are_derived_from_positions_alone)
{
    const double radius = 4000, speed = 160;
    for (int side = -1; side <= 1; side += 2) {
        struct nav_track circle = {0}, t = {0};
        struct nav_findings found;
        const struct nav_circle c = {45, 6, side * radius, 0, speed, 30};
        assert_int_equal(nav_make_circle(&c, 0, 120, &circle), 0);
        for (size_t i = 0; i < circle.count; i += 10) {
            add(&t, (double)i / 10, circle.fix[i].latitude_deg, circle.fix[i].longitude_deg);
        }
        nav_track_complete(&t, &usual, &found);
        const double bank = side * atan(speed * speed / (9.80665 * radius)) / degree;
        for (size_t i = 2; i + 2 < t.count; i++) {
            assert_near(t.fix[i].roll_deg, bank, 0.05);
            assert_near(t.fix[i].speed_ms, speed, 0.05);
            assert_near(t.fix[i].climb_ms, 10, 1e-6);
            assert_near(t.fix[i].pitch_deg, atan(10.0 / 160) / degree, 0.01);
            assert_near(nav_wrap_180(t.fix[i].track_deg - circle.fix[10 * i].track_deg), 0, 0.02);
        }
        nav_track_free(&circle);
        nav_track_free(&t);
    }
}

/* In a steady turn at bank phi the body turns at psi' sin(phi) in pitch and psi' cos(phi) in yaw.
 */
TEST(a_circle_is_a_circle_and_is_flown_banked)
{
    const struct nav_circle c = {42, -30, 5000, 3000, 150, 90};
    struct nav_track t = {0};
    struct nav_findings found;
    struct nav_motion m;
    struct nav_state s;
    assert_int_equal(nav_make_circle(&c, 0, 220, &t), 0);
    nav_track_complete(&t, &usual, &found);
    nav_motion_init(&m, &t);
    const double bank = atan(150.0 * 150 / (9.80665 * 5000)), turn = 150.0 / 5000 / degree;
    for (int64_t at = 0; at <= 220 * INT64_C(1000000); at += 12500) {
        nav_motion_position(&m, at, &s);
        nav_motion_kinematics(&m, at, &s);
        assert_near(wgs84_metres(42, -30, s.latitude_deg, s.longitude_deg), 5000, 0.01);
        assert_near(s.roll_deg, bank / degree, 1e-9);
        assert_near(hypot(s.east_ms, s.north_ms), 150, 1e-9);
        if (at < 220000000) {
            assert_near(s.pitch_rate, turn * sin(bank), 2e-3);
            assert_near(s.yaw_rate, turn * cos(bank), 2e-3);
            assert_near(s.roll_rate, 0, 1e-9);
        }
    }
    /* East of the centre, turning right, it flies south. */
    nav_motion_kinematics(&m, 0, &s);
    assert_near(s.track_deg, 180, 0.05);
    nav_track_free(&t);
}

TEST(a_straight_line_covers_its_distance)
{
    const struct nav_straight line = {60, 179.5, 70, 1000, 200};
    struct nav_track t = {0};
    assert_int_equal(nav_make_straight(&line, 0, 300, &t), 0);
    assert_int_equal(t.count, 3001);
    const struct nav_fix *last = &t.fix[3000];
    assert_near(wgs84_metres(60, 179.5, last->latitude_deg, last->longitude_deg), 60000, 1e-3);
    assert_true(last->longitude_deg < 0);
    nav_track_free(&t);
}

/* Half a degree from the pole the direction of a straight line changes by 0.2 degrees a second;
 * what is derived for a fix must be that of the fix and not of a neighbour. */
TEST(the_derived_track_is_right_near_the_pole)
{
    const struct nav_straight line = {89.5, 10, 80, 1000, 200};
    struct nav_track straight = {0}, t = {0};
    struct nav_findings found;
    assert_int_equal(nav_make_straight(&line, 0, 60, &straight), 0);
    for (size_t i = 0; i < straight.count; i += 10) {
        add(&t, (double)i / 10, straight.fix[i].latitude_deg, straight.fix[i].longitude_deg);
    }
    nav_track_complete(&t, &usual, &found);
    for (size_t i = 0; i < t.count; i++) {
        assert_near(nav_wrap_180(t.fix[i].track_deg - straight.fix[10 * i].track_deg), 0, 1e-3);
    }
    nav_track_free(&straight);
    nav_track_free(&t);
}

TEST(headings_turn_the_short_way_through_north)
{
    struct nav_track t = {0};
    struct nav_findings found;
    struct nav_motion m;
    struct nav_state s;
    add(&t, 0, 43, 7);
    add(&t, 10, 43.01, 7);
    t.fix[0].heading_deg = t.fix[0].track_deg = 350;
    t.fix[1].heading_deg = t.fix[1].track_deg = 20;
    t.fix[0].roll_deg = t.fix[1].roll_deg = 0;
    t.fix[0].pitch_deg = t.fix[1].pitch_deg = 0;
    nav_track_complete(&t, &usual, &found);
    nav_motion_init(&m, &t);
    nav_motion_kinematics(&m, t.fix[0].time_us + 5000000, &s);
    assert_near(s.heading_deg, 5, 1e-9);
    assert_near(s.track_deg, 5, 1e-9);
    nav_motion_kinematics(&m, t.fix[0].time_us, &s);
    assert_near(s.heading_deg, -10, 1e-9);
    assert_near(s.track_deg, 350, 1e-9);
    assert_near(s.yaw_rate, 3, 1e-9);
    nav_track_free(&t);
}

/* What the note beside the recording says of it, found again. */
TEST(the_real_flights_blemishes_are_found)
{
    char path[512];
    if (!support_data_path("nav_tracks/zero_gravity.csv.gz", path, sizeof path)) {
        skip();
    }
    struct nav_track t = {0};
    struct nav_reading r = {0};
    struct nav_findings found;
    assert_int_equal(nav_read_track(path, NAV_FORMAT_BY_NAME, &t, &r), 0);
    assert_int_equal(t.count, 10367);
    assert_int_equal(r.malformed + r.disordered + r.missing, 0);
    assert_int_equal(t.datum, NAV_DATUM_BAROMETRIC);
    nav_track_complete(&t, &(struct nav_limits){0, 800 * 1852.0 / 3600}, &found);
    assert_int_equal(found.holds, 620);
    assert_in_range(found.jumps, 150, 153);
    assert_int_equal(found.gaps, 0);
    assert_near(t.fix[0].height_m, 2950 * 0.3048, 1e-9);
    assert_near(t.fix[0].speed_ms, 155 * 1852.0 / 3600, 1e-9);
    assert_true(t.fix[0].roll_deg == 0.5);
    /* Most jumps come behind a repeated report, and go with it. */
    assert_int_equal(nav_track_drop_repeats(&t), 321);
    nav_track_complete(&t, &(struct nav_limits){0, 800 * 1852.0 / 3600}, &found);
    assert_in_range(found.jumps, 0, 20);
    nav_track_free(&t);
}

/* A fix each second, so many metres north of the one before. */
static void add_steps(struct nav_track *t, const double *step_m, int count)
{
    double north_m = 0;
    for (int i = 0; i < count; i++) {
        struct nav_fix f = nav_fix_blank();
        north_m += step_m[i];
        f.time_us = (int64_t)i * 1000000;
        f.latitude_deg = 46 + north_m / 111000;
        f.longitude_deg = 7;
        assert_int_equal(nav_track_add(t, &f), 0);
    }
}

TEST(a_position_repeated_in_motion_is_left_out_and_one_of_a_standing_aircraft_is_not)
{
    static const double moving[] = {0, 100, 100, 0, 0, 300, 100};
    static const double standing[] = {0, 1, 0, 0, 0, 1, 2};
    struct nav_track t = {0};
    add_steps(&t, moving, 7);
    assert_int_equal(nav_track_drop_repeats(&t), 2);
    assert_int_equal(t.count, 5);
    assert_true(t.fix[2].time_us == 2000000 && t.fix[3].time_us == 5000000);
    nav_track_free(&t);
    add_steps(&t, standing, 7);
    assert_int_equal(nav_track_drop_repeats(&t), 0);
    assert_int_equal(t.count, 7);
    nav_track_free(&t);
}

/* How near a flight comes to a place. */
static double nearest_m(const struct nav_track *t, double latitude_deg, double longitude_deg)
{
    struct geod_geodesic earth;
    geod_init(&earth, 6378137.0, 1 / 298.257223563);
    double nearest = 1e9;
    for (size_t i = 0; i < t->count; i++) {
        double m;
        geod_inverse(&earth, t->fix[i].latitude_deg, t->fix[i].longitude_deg, latitude_deg,
                     longitude_deg, &m, NULL, NULL);
        nearest = fmin(nearest, m);
    }
    return nearest;
}

TEST(a_route_is_flown_at_its_speed_with_banked_turns)
{
    static const double places[][3] = {{46, 7, 2000}, {46.2, 7, 2000}, {46.2, 7.3, 3000}};
    struct nav_track route = {.datum = NAV_DATUM_SEA_LEVEL}, flight = {0};
    for (int i = 0; i < 3; i++) {
        struct nav_fix f = nav_fix_blank();
        f.latitude_deg = places[i][0];
        f.longitude_deg = places[i][1];
        f.height_m = places[i][2];
        assert_int_equal(nav_track_add(&route, &f), 0);
    }
    assert_int_equal(nav_fly_route(&route, 150, 5000000, &flight), 0);
    assert_int_equal(flight.datum, NAV_DATUM_SEA_LEVEL);
    /* 22,233 m and 23,163 m; the corner is cut by 2 r (1 - pi / 4) of r = v^2 / (g tan 25). */
    const double radius_m = 150 * 150 / (9.80665 * tan(25 * 3.14159265358979 / 180));
    assert_near((double)(flight.count - 1) * 150, 22233 + 23163 - 2 * radius_m * 0.2146, 250);
    assert_near(nearest_m(&flight, 46.2, 7.3), 0, 151);
    assert_near(nearest_m(&flight, 46.2, 7), radius_m * (1.41421356 - 1), 100);
    struct nav_findings found;
    nav_track_complete(&flight, &(struct nav_limits){0, 411}, &found);
    double bank_deg = 0;
    for (size_t i = 0; i < flight.count; i++) {
        bank_deg = fmax(bank_deg, flight.fix[i].roll_deg);
        assert_near(flight.fix[i].speed_ms, 150, 0.5);
        assert_true(flight.fix[i].roll_deg > -3);
    }
    assert_near(bank_deg, 25, 1);
    assert_near(flight.fix[flight.count - 1].height_m, 3000, 15);
    assert_int_equal(found.jumps, 0);
    nav_track_free(&flight);
    route.count = 1;
    assert_int_equal(nav_fly_route(&route, 150, 0, &flight), -1);
    nav_track_free(&route);
    nav_track_free(&flight);
}
