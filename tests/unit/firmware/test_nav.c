/* The ownship between two messages: where it is by geodesy, and when it stops being believed. */
#include "bus_frames.h"
#include "hs/rng.h"
#include "lm/nav.h"

#include <geodesic.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>

#include <cmocka.h>

static const double semi_major = 6378137.0, flattening = 1 / 298.257223563;

static void hear(struct lm_nav *nav, struct lm_can_frame frame)
{
    lm_nav_take(nav, &frame);
}

static void hear_float(struct lm_nav *nav, enum lm_bus_field field, double value, uint64_t time_us)
{
    hear(nav, bus_float(field, value, time_us));
}

/* A coordinate as a DOUBLE, both halves at the same time. */
static void hear_double(struct lm_nav *nav, enum lm_bus_field field, double degrees,
                        uint64_t time_us)
{
    const uint32_t id = lm_bus_canas17.rows[field].id;
    const uint64_t bits = bus_double_bits(degrees);
    hear(nav, bus_frame(id, LM_CANAS_DOUBLEH, 0, (uint32_t)(bits >> 32), time_us));
    hear(nav, bus_frame(id, LM_CANAS_DOUBLEL, 1, (uint32_t)bits, time_us));
}

static double degrees_of(fx_bam_t angle)
{
    return (int32_t)angle * (360.0 / 0x1p32);
}

static struct lm_ownship at(const struct lm_nav *nav, uint64_t now_us)
{
    struct lm_ownship ownship;
    lm_nav_at(nav, now_us, &ownship);
    return ownship;
}

/* ---- dead reckoning ---- */

struct course {
    double latitude, longitude, height_m, north_m_s, east_m_s;
};

/* Constant velocity on the ellipsoid at a height, in 2,000 steps of the midpoint rule. */
static void fly_in_doubles(const struct course *c, double seconds, double *latitude,
                           double *longitude)
{
    const double e2 = flattening * (2 - flattening), radian = 3.14159265358979323846 / 180;
    const int steps = 2000;
    const double dt = seconds / steps;
    double phi = c->latitude * radian, lambda = c->longitude * radian;
    for (int i = 0; i < steps; i++) {
        double middle = phi;
        for (int pass = 0; pass < 2; pass++) {
            const double w2 = 1 - e2 * sin(middle) * sin(middle);
            const double m = semi_major * (1 - e2) / (w2 * sqrt(w2)) + c->height_m;
            middle = phi + c->north_m_s * dt / m / 2;
        }
        const double n = semi_major / sqrt(1 - e2 * sin(middle) * sin(middle)) + c->height_m;
        lambda += c->east_m_s * dt / (n * cos(middle));
        phi += 2 * (middle - phi);
    }
    *latitude = phi / radian;
    *longitude = lambda / radian;
}

static double metres_between(double latitude_a, double longitude_a, double latitude_b,
                             double longitude_b)
{
    struct geod_geodesic earth;
    geod_init(&earth, semi_major, flattening);
    double metres;
    geod_inverse(&earth, latitude_a, longitude_a, latitude_b, longitude_b, &metres, NULL, NULL);
    return metres;
}

/* The unit's answer after `seconds`, and the velocity and start that it believes, which the bus
 * rounded. */
static struct lm_ownship fly_in_firmware(struct course *c, uint64_t age_us)
{
    struct lm_nav nav;
    lm_nav_init(&nav, &lm_bus_canas17);
    const uint64_t start_us = 5000000;
    hear_double(&nav, LM_BUS_LATITUDE, c->latitude, start_us);
    hear_double(&nav, LM_BUS_LONGITUDE, c->longitude, start_us);
    hear_float(&nav, LM_BUS_NORTH_VELOCITY, c->north_m_s, start_us);
    hear_float(&nav, LM_BUS_EAST_VELOCITY, c->east_m_s, start_us);
    hear_float(&nav, LM_BUS_ELLIPSOID_HEIGHT, c->height_m, start_us);
    const struct lm_ownship ownship = at(&nav, start_us + age_us);
    c->north_m_s = ownship.velocity_north_mm_s / 1000.0;
    c->east_m_s = ownship.velocity_east_mm_s / 1000.0;
    return ownship;
}

static void two_seconds_of_constant_velocity_are_within_2_cm(void **state)
{
    (void)state;
    double worst = 0;
    for (int latitude = -80; latitude <= 80; latitude += 5) {
        for (int azimuth = 0; azimuth < 360; azimuth += 7) {
            struct course c = {
                .latitude = latitude + 0.1234567,
                .longitude = azimuth % 2 ? 179.9999 : -179.9999,
                .height_m = azimuth % 3 * 10000,
                .north_m_s = 300 * cos(azimuth * 0.017453292519943295),
                .east_m_s = 300 * sin(azimuth * 0.017453292519943295),
            };
            c.latitude = latitude == 80 ? 80 : c.latitude;
            const struct lm_ownship ownship = fly_in_firmware(&c, 2000000);
            assert_int_equal(ownship.position_quality, LM_NAV_STALE);
            double latitude_deg, longitude_deg;
            fly_in_doubles(&c, 2, &latitude_deg, &longitude_deg);
            const double error =
                metres_between(latitude_deg, longitude_deg, degrees_of(ownship.latitude),
                               degrees_of(ownship.longitude));
            worst = fmax(worst, error);
        }
    }
    print_message("# worst error against constant velocity: %.4f m\n", worst);
    assert_true(worst < 0.02);
}

static void two_seconds_are_within_17_cm_of_the_geodesic(void **state)
{
    (void)state;
    struct geod_geodesic earth;
    geod_init(&earth, semi_major, flattening);
    double worst = 0, worst_below_60 = 0;
    for (int latitude = -80; latitude <= 80; latitude += 5) {
        for (int azimuth = 0; azimuth < 360; azimuth += 5) {
            struct course c = {
                .latitude = latitude,
                .longitude = 179.999,
                .north_m_s = 300 * cos(azimuth * 0.017453292519943295),
                .east_m_s = 300 * sin(azimuth * 0.017453292519943295),
            };
            const struct lm_ownship ownship = fly_in_firmware(&c, 2000000);
            double latitude_deg, longitude_deg;
            geod_direct(&earth, latitude, 179.999, azimuth, 600, &latitude_deg, &longitude_deg,
                        NULL);
            const double error =
                metres_between(latitude_deg, longitude_deg, degrees_of(ownship.latitude),
                               degrees_of(ownship.longitude));
            worst = fmax(worst, error);
            worst_below_60 =
                latitude >= -60 && latitude <= 60 ? fmax(worst_below_60, error) : worst_below_60;
        }
    }
    print_message("# worst error against the geodesic: %.4f m, up to 60 degrees %.4f m\n", worst,
                  worst_below_60);
    assert_true(worst < 0.17 && worst_below_60 < 0.07);
}

static void each_coordinate_moves_from_its_own_time(void **state)
{
    (void)state;
    struct lm_nav nav;
    lm_nav_init(&nav, &lm_bus_canas17);
    hear_float(&nav, LM_BUS_NORTH_VELOCITY, 200, 0);
    hear_float(&nav, LM_BUS_EAST_VELOCITY, 100, 0);
    hear_double(&nav, LM_BUS_LATITUDE, 0, 100000);
    hear_double(&nav, LM_BUS_LONGITUDE, 0, 150000);
    const struct lm_ownship o = at(&nav, 200000);
    /* 20 m on the meridian's radius 6,335,439 m, 5 m on the equator's. */
    const double count = 6.283185307179586 / 0x1p32;
    assert_true(fabs(o.latitude - 20 / 6335439.327 / count) < 1);
    assert_true(fabs(o.longitude - 5 / 6378137.0 / count) < 1);
    assert_int_equal(o.position_quality, LM_NAV_GOOD);
}

static void near_a_pole_the_position_stays_one(void **state)
{
    (void)state;
    struct course c = {.latitude = 89.9999, .longitude = 20, .north_m_s = 1500, .east_m_s = 1500};
    const struct lm_ownship o = fly_in_firmware(&c, 2000000);
    assert_int_equal(o.latitude, FX_BAM_90);
    struct course s = {.latitude = -90, .longitude = 20, .north_m_s = -1500, .east_m_s = -1500};
    assert_int_equal(fly_in_firmware(&s, 2000000).latitude, 0u - FX_BAM_90);
}

/* ---- sources ---- */

static void ground_speed_and_track_serve_when_there_is_no_velocity(void **state)
{
    (void)state;
    struct lm_nav nav;
    lm_nav_init(&nav, &lm_bus_canas17);
    hear_float(&nav, LM_BUS_GROUND_SPEED, 100, 0);
    assert_int_equal(at(&nav, 0).velocity_quality, LM_NAV_DEAD);
    hear_float(&nav, LM_BUS_TRUE_TRACK, 120, 0);
    struct lm_ownship o = at(&nav, 0);
    assert_int_equal(o.velocity_quality, LM_NAV_GOOD);
    assert_in_range(o.velocity_north_mm_s + 50000, 0, 2);
    assert_in_range(o.velocity_east_mm_s - 86602, 0, 2);
    assert_in_range(o.ground_speed_mm_s - 99998, 0, 3);
    assert_true(fabs(degrees_of(o.track) - 120) < 0.001);
    hear_float(&nav, LM_BUS_NORTH_VELOCITY, -30, 1000000);
    hear_float(&nav, LM_BUS_EAST_VELOCITY, -40, 1000000);
    o = at(&nav, 1000000);
    assert_int_equal(o.velocity_north_mm_s, -30000);
    assert_int_equal(o.ground_speed_mm_s, 50000);
    assert_true(fabs(degrees_of(o.track) - (atan2(-40, -30) * 57.29577951308232)) < 1e-5);
    /* Stale is not yet dead. */
    hear_float(&nav, LM_BUS_GROUND_SPEED, 100, 3000000);
    hear_float(&nav, LM_BUS_TRUE_TRACK, 0, 3000000);
    assert_int_equal(at(&nav, 3000000).velocity_north_mm_s, -30000);
    assert_int_equal(at(&nav, 3000000).velocity_quality, LM_NAV_STALE);
    assert_int_equal(at(&nav, 3000001).velocity_north_mm_s, 100000);
}

static void the_best_height_that_lives_is_used_and_moved_on(void **state)
{
    (void)state;
    struct lm_nav nav;
    lm_nav_init(&nav, &lm_bus_canas17);
    hear_float(&nav, LM_BUS_BARO_ALTITUDE, 1000, 0);
    hear_float(&nav, LM_BUS_ALTITUDE_RATE, 10, 0);
    struct lm_ownship o = at(&nav, 500000);
    assert_int_equal(o.height_source, LM_BUS_BARO_ALTITUDE);
    assert_int_equal(o.height_q6, 1005 * 64);
    hear_float(&nav, LM_BUS_TRUE_ALTITUDE, 1100, 500000);
    assert_int_equal(at(&nav, 500000).height_source, LM_BUS_TRUE_ALTITUDE);
    hear_float(&nav, LM_BUS_ELLIPSOID_HEIGHT, 1150, 600000);
    hear_float(&nav, LM_BUS_UP_VELOCITY, -20, 600000);
    o = at(&nav, 1100000);
    assert_int_equal(o.height_source, LM_BUS_ELLIPSOID_HEIGHT);
    assert_int_equal(o.height_q6, 1140 * 64);
    hear_float(&nav, LM_BUS_TRUE_ALTITUDE, 1100, 5600000);
    assert_int_equal(at(&nav, 5600000).height_source, LM_BUS_ELLIPSOID_HEIGHT);
    assert_int_equal(at(&nav, 5600000).height_quality, LM_NAV_STALE);
    assert_int_equal(at(&nav, 5600001).height_source, LM_BUS_TRUE_ALTITUDE);
}

static void true_heading_is_preferred_while_it_lives(void **state)
{
    (void)state;
    struct lm_nav nav;
    lm_nav_init(&nav, &lm_bus_canas17);
    hear_float(&nav, LM_BUS_HEADING, -90, 0);
    struct lm_ownship o = at(&nav, 0);
    assert_int_equal(o.heading, 0xc0000000u);
    assert_int_equal(o.heading_source, LM_BUS_HEADING);
    hear_float(&nav, LM_BUS_TRUE_HEADING, 272, 0);
    assert_true(fabs(degrees_of(at(&nav, 0).heading) + 88) < 1e-6);
    hear_float(&nav, LM_BUS_HEADING, -90, 1000001);
    assert_int_equal(at(&nav, 1000000).heading_source, LM_BUS_TRUE_HEADING);
    assert_int_equal(at(&nav, 1000001).heading_source, LM_BUS_HEADING);
}

/* Turn the rotation matrix from body to north-east-down axes by small rotations about the body's
 * own axes, and read the heading off its first column: no formula for rates of Euler angles enters.
 */
static double heading_by_rotation(double heading, double pitch, double roll, double pitch_rate,
                                  double yaw_rate, double seconds)
{
    const double sh = sin(heading), ch = cos(heading), sp = sin(pitch), cp = cos(pitch),
                 sr = sin(roll), cr = cos(roll);
    double r[3][3] = {{cp * ch, sr * sp * ch - cr * sh, cr * sp * ch + sr * sh},
                      {cp * sh, sr * sp * sh + cr * ch, cr * sp * sh - sr * ch},
                      {-sp, sr * cp, cr * cp}};
    const int steps = 1000;
    const double q = pitch_rate * seconds / steps, y = yaw_rate * seconds / steps;
    for (int step = 0; step < steps; step++) {
        for (int i = 0; i < 3; i++) {
            /* r' = r * (1 + skew(0, q, y)) */
            const double a = r[i][0], b = r[i][1], c = r[i][2];
            r[i][0] = a + b * y - c * q;
            r[i][1] = b - a * y;
            r[i][2] = c + a * q;
        }
    }
    return atan2(r[1][0], r[0][0]);
}

static void heading_turns_as_the_body_does(void **state)
{
    (void)state;
    const double radian = 0.017453292519943295;
    double worst = 0;
    for (int pitch = -60; pitch <= 60; pitch += 20) {
        for (int roll = -180; roll < 180; roll += 30) {
            struct lm_nav nav;
            lm_nav_init(&nav, &lm_bus_canas17);
            hear_float(&nav, LM_BUS_TRUE_HEADING, 350, 0);
            hear_float(&nav, LM_BUS_PITCH, pitch, 50000);
            hear_float(&nav, LM_BUS_ROLL, roll, 50000);
            hear_float(&nav, LM_BUS_PITCH_RATE, 12, 50000);
            hear_float(&nav, LM_BUS_YAW_RATE, -7, 50000);
            const double got = degrees_of(at(&nav, 100000).heading) * radian;
            const double wanted = heading_by_rotation(350 * radian, pitch * radian, roll * radian,
                                                      12 * radian, -7 * radian, 0.1);
            worst = fmax(worst, fabs(remainder(got - wanted, 360 * radian)) / radian);
            /* Too old a rate is no rate. */
            assert_true(fabs(degrees_of(at(&nav, 150001).heading) + 10) < 1e-6);
        }
    }
    /* The rates also change the attitude, which the firmware holds still for these 100 ms. */
    print_message("# worst error of heading after 100 ms: %.4f degree\n", worst);
    assert_true(worst < 0.06);
}

static void heading_stands_still_where_it_means_nothing(void **state)
{
    (void)state;
    struct lm_nav nav;
    lm_nav_init(&nav, &lm_bus_canas17);
    hear_float(&nav, LM_BUS_TRUE_HEADING, 10, 0);
    hear_float(&nav, LM_BUS_PITCH, 85, 0);
    hear_float(&nav, LM_BUS_ROLL, 0, 0);
    hear_float(&nav, LM_BUS_PITCH_RATE, 0, 0);
    hear_float(&nav, LM_BUS_YAW_RATE, 100, 0);
    assert_true(fabs(degrees_of(at(&nav, 100000).heading) - 10) < 1e-6);
}

/* ---- ages ---- */

struct ages {
    enum lm_nav_quality position, height, heading, attitude, velocity, utc;
};

static void hear_everything(struct lm_nav *nav, uint64_t time_us)
{
    for (int i = 0; i < LM_BUS_UTC; i++) {
        hear_float(nav, (enum lm_bus_field)i, 1, time_us);
    }
    hear(nav, bus_frame(1200, LM_CANAS_CHAR4, 0, 0x173b3b00, time_us));
}

static void assert_ages(const struct lm_nav *nav, uint64_t now_us, struct ages expected)
{
    const struct lm_ownship o = at(nav, now_us);
    assert_int_equal(o.position_quality, expected.position);
    assert_int_equal(o.height_quality, expected.height);
    assert_int_equal(o.heading_quality, expected.heading);
    assert_int_equal(o.attitude_quality, expected.attitude);
    assert_int_equal(o.velocity_quality, expected.velocity);
    assert_int_equal(o.utc_quality, expected.utc);
}

#define D LM_NAV_DEAD
#define S LM_NAV_STALE
#define G LM_NAV_GOOD

static void every_quality_changes_at_the_microsecond_the_table_says(void **state)
{
    (void)state;
    struct lm_nav nav;
    lm_nav_init(&nav, &lm_bus_canas17);
    assert_ages(&nav, 0, (struct ages){D, D, D, D, D, D});
    const uint64_t t = 7000000;
    hear_everything(&nav, t);
    assert_ages(&nav, t, (struct ages){G, G, G, G, G, G});
    assert_ages(&nav, t + 100000, (struct ages){G, G, G, G, G, G});
    assert_ages(&nav, t + 100001, (struct ages){G, G, G, S, G, G});
    assert_ages(&nav, t + 300000, (struct ages){G, G, G, S, G, G});
    assert_ages(&nav, t + 300001, (struct ages){S, G, S, S, S, G});
    assert_ages(&nav, t + 500000, (struct ages){S, G, S, S, S, G});
    assert_ages(&nav, t + 500001, (struct ages){S, S, S, S, S, G});
    assert_ages(&nav, t + 1000000, (struct ages){S, S, S, S, S, G});
    assert_ages(&nav, t + 1000001, (struct ages){S, S, D, D, S, G});
    assert_ages(&nav, t + 2000000, (struct ages){S, S, D, D, S, G});
    assert_ages(&nav, t + 2000001, (struct ages){D, S, D, D, D, G});
    assert_ages(&nav, t + 3000001, (struct ages){D, S, D, D, D, S});
    assert_ages(&nav, t + 5000000, (struct ages){D, S, D, D, D, S});
    assert_ages(&nav, t + 5000001, (struct ages){D, D, D, D, D, S});
    assert_ages(&nav, t + 10000001, (struct ages){D, D, D, D, D, D});
    const struct lm_ownship o = at(&nav, t + 10000001);
    assert_true(o.latitude == 0 && o.longitude == 0 && o.height_q6 == 0 && o.heading == 0 &&
                o.pitch == 0 && o.roll == 0 && o.ground_speed_mm_s == 0 && o.utc_s == 0);
}

static void one_dead_coordinate_or_angle_kills_its_group(void **state)
{
    (void)state;
    struct lm_nav nav;
    lm_nav_init(&nav, &lm_bus_canas17);
    hear_everything(&nav, 0);
    hear_float(&nav, LM_BUS_LATITUDE, 1, 2000000);
    hear_float(&nav, LM_BUS_PITCH, 1, 2000000);
    hear_float(&nav, LM_BUS_NORTH_VELOCITY, 1, 2000000);
    assert_ages(&nav, 2000001, (struct ages){D, S, D, D, D, G});
}

static void a_position_that_cannot_be_moved_on_or_is_coarse_is_stale_at_best(void **state)
{
    (void)state;
    struct lm_nav nav;
    lm_nav_init(&nav, &lm_bus_canas17);
    hear_double(&nav, LM_BUS_LATITUDE, 47, 0);
    hear_double(&nav, LM_BUS_LONGITUDE, 11, 0);
    assert_int_equal(at(&nav, 100).position_quality, LM_NAV_STALE);
    assert_true(fabs(degrees_of(at(&nav, 100000).latitude) - 47) < 1e-7);
    hear_float(&nav, LM_BUS_NORTH_VELOCITY, 0, 0);
    hear_float(&nav, LM_BUS_EAST_VELOCITY, 0, 0);
    assert_int_equal(at(&nav, 100).position_quality, LM_NAV_GOOD);
    hear(&nav, bus_frame(1037, LM_CANAS_SHORT2, 0, 0x08000000u | 180, 100));
    assert_int_equal(at(&nav, 100).position_quality, LM_NAV_STALE);
    hear_double(&nav, LM_BUS_LONGITUDE, 11, 200);
    assert_int_equal(at(&nav, 200).position_quality, LM_NAV_GOOD);
}

static void a_lone_half_never_moves_the_position(void **state)
{
    (void)state;
    struct lm_nav nav;
    lm_nav_init(&nav, &lm_bus_canas17);
    hear_everything(&nav, 0);
    hear_double(&nav, LM_BUS_LATITUDE, 47, 0);
    const struct lm_ownship before = at(&nav, 1000);
    for (uint8_t i = 0; i < 100; i++) {
        hear(&nav, bus_frame(1036, i & 1 ? LM_CANAS_DOUBLEH : LM_CANAS_DOUBLEL, (uint8_t)(3 * i),
                             0x40500000u + i, 500));
        const struct lm_ownship after = at(&nav, 1000);
        assert_memory_equal(&before, &after, sizeof before);
    }
}

static void time_going_backwards_is_survived(void **state)
{
    (void)state;
    struct lm_nav nav;
    lm_nav_init(&nav, &lm_bus_canas17);
    hear_everything(&nav, 9000000);
    /* A little ahead is the order of reading two clocks; far ahead is another clock. */
    assert_ages(&nav, 8900000, (struct ages){G, G, G, G, G, G});
    assert_ages(&nav, 8899999, (struct ages){G, G, G, D, G, G});
    assert_ages(&nav, 8499999, (struct ages){D, D, D, D, D, G});
    assert_ages(&nav, 0, (struct ages){D, D, D, D, D, D});
    /* The recording starts over: what is heard now is believed now. */
    hear_everything(&nav, 10);
    assert_ages(&nav, 10, (struct ages){G, G, G, G, G, G});
    assert_int_equal(nav.position_jumps, 0);
    assert_ages(&nav, UINT64_MAX, (struct ages){D, D, D, D, D, D});
}

static void a_jump_is_believed_and_counted(void **state)
{
    (void)state;
    struct lm_nav nav;
    lm_nav_init(&nav, &lm_bus_canas17);
    hear_double(&nav, LM_BUS_LATITUDE, 60, 0);
    hear_double(&nav, LM_BUS_LONGITUDE, 179.999, 0);
    assert_int_equal(nav.position_jumps, 0);
    /* 149 m of latitude and, across the antimeridian, 149 m of longitude in 100 ms. */
    hear_double(&nav, LM_BUS_LATITUDE, 60 + 149 / 111400.0, 100000);
    hear_double(&nav, LM_BUS_LONGITUDE, 179.999 + 149 / 55800.0 - 360, 100000);
    assert_int_equal(nav.position_jumps, 0);
    hear_double(&nav, LM_BUS_LATITUDE, 60 + (149 + 152) / 111400.0, 200000);
    assert_int_equal(nav.position_jumps, 1);
    hear_double(&nav, LM_BUS_LONGITUDE, 179.999 + (149 + 152) / 55800.0 - 360, 200000);
    assert_int_equal(nav.position_jumps, 2);
    hear_double(&nav, LM_BUS_LATITUDE, -45, 300000);
    assert_int_equal(nav.position_jumps, 3);
    hear_double(&nav, LM_BUS_LONGITUDE, -100, 300000);
    assert_int_equal(nav.position_jumps, 4);
    assert_true(fabs(degrees_of(at(&nav, 300000).latitude) + 45) < 1e-7);
    /* Two fixes in one millisecond: what jitters is the bus. */
    hear_double(&nav, LM_BUS_LATITUDE, -45.001, 301000);
    assert_int_equal(nav.position_jumps, 4);
    /* 20 km in 14 s is an aircraft; a twin of an earlier time stamp is not. */
    hear_double(&nav, LM_BUS_LATITUDE, -45.18, 14300000);
    assert_int_equal(nav.position_jumps, 4);
    hear_double(&nav, LM_BUS_LATITUDE, -45, 0);
    assert_int_equal(nav.position_jumps, 5);
    /* A quarter round the world, but after the time that times 1500 just passes 2^64. */
    hear_double(&nav, LM_BUS_LATITUDE, 45, 12297829382473035u);
    assert_int_equal(nav.position_jumps, 5);
}

static void the_clock_runs_on_between_its_messages(void **state)
{
    (void)state;
    struct lm_nav nav;
    lm_nav_init(&nav, &lm_bus_canas17);
    hear(&nav, bus_frame(1200, LM_CANAS_CHAR4, 0, 0x173b3b00, 0)); /* 23:59:59 */
    assert_int_equal(at(&nav, 999999).utc_s, 86399);
    assert_int_equal(at(&nav, 1000000).utc_s, 0);
    assert_int_equal(at(&nav, 2500000).utc_s, 1);
}

static void the_same_frames_give_the_same_ownship_to_the_last_bit(void **state)
{
    (void)state;
    struct lm_nav a, b;
    memset(&a, 0x55, sizeof a);
    memset(&b, 0xaa, sizeof b);
    lm_nav_init(&a, &lm_bus_canas17);
    lm_nav_init(&b, &lm_bus_canas17);
    struct hs_rng rng;
    hs_rng_seed(&rng, 31);
    for (uint64_t t = 0; t < 10000000; t += 12500) {
        const enum lm_bus_field field = (enum lm_bus_field)hs_rng_below(&rng, LM_BUS_UTC);
        const struct lm_can_frame frame = bus_float(field, 50 * hs_rng_uniform(&rng), t);
        lm_nav_take(&a, &frame);
        lm_nav_take(&b, &frame);
        struct lm_ownship at_a, at_b;
        memset(&at_a, 1, sizeof at_a);
        memset(&at_b, 2, sizeof at_b);
        lm_nav_at(&a, t + 6000, &at_a);
        lm_nav_at(&b, t + 6000, &at_b);
        assert_memory_equal(&at_a, &at_b, sizeof at_a);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(two_seconds_of_constant_velocity_are_within_2_cm),
        cmocka_unit_test(two_seconds_are_within_17_cm_of_the_geodesic),
        cmocka_unit_test(each_coordinate_moves_from_its_own_time),
        cmocka_unit_test(near_a_pole_the_position_stays_one),
        cmocka_unit_test(ground_speed_and_track_serve_when_there_is_no_velocity),
        cmocka_unit_test(the_best_height_that_lives_is_used_and_moved_on),
        cmocka_unit_test(true_heading_is_preferred_while_it_lives),
        cmocka_unit_test(heading_turns_as_the_body_does),
        cmocka_unit_test(heading_stands_still_where_it_means_nothing),
        cmocka_unit_test(every_quality_changes_at_the_microsecond_the_table_says),
        cmocka_unit_test(one_dead_coordinate_or_angle_kills_its_group),
        cmocka_unit_test(a_position_that_cannot_be_moved_on_or_is_coarse_is_stale_at_best),
        cmocka_unit_test(a_lone_half_never_moves_the_position),
        cmocka_unit_test(time_going_backwards_is_survived),
        cmocka_unit_test(a_jump_is_believed_and_counted),
        cmocka_unit_test(the_clock_runs_on_between_its_messages),
        cmocka_unit_test(the_same_frames_give_the_same_ownship_to_the_last_bit),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
