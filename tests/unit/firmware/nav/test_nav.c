/* The ownship between two messages: where it is by geodesy, and when it stops being believed. */
#include "bus_frames.h"
#include "check.h"
#include "hs/angle.h"
#include "hs/rng.h"
#include "lm/nav.h"
#include "wgs84.h"

#include <math.h>
#include <stdio.h>

static const double semi_major = 6378137.0, flattening = 1 / 298.257223563;

/* The ownship and the decoder that it hears. */
struct ear {
    struct lm_bus bus;
    struct lm_nav nav;
};

static void open_ear(struct ear *ear)
{
    lm_bus_init(&ear->bus, &lm_bus_canas17);
    lm_nav_init(&ear->nav);
}

static void hear(struct ear *ear, struct lm_can_frame frame)
{
    struct lm_bus_event events[LM_BUS_EVENTS];
    const uint32_t count = lm_bus_take(&ear->bus, &frame, events);
    for (uint32_t i = 0; i < count; i++) {
        lm_nav_take(&ear->nav, &events[i]);
    }
}

static void hear_float(struct ear *ear, enum lm_bus_field field, double value, uint64_t time_us)
{
    hear(ear, bus_float(field, value, time_us));
}

/* A coordinate as a DOUBLE, both halves at the same time. */
static void hear_double(struct ear *ear, enum lm_bus_field field, double degrees, uint64_t time_us)
{
    const uint32_t id = lm_bus_canas17.rows[field].id;
    const uint64_t bits = bus_double_bits(degrees);
    hear(ear, bus_frame(id, LM_CANAS_DOUBLEH, 0, (uint32_t)(bits >> 32), time_us));
    hear(ear, bus_frame(id, LM_CANAS_DOUBLEL, 1, (uint32_t)bits, time_us));
}

static struct lm_ownship at(const struct ear *ear, uint64_t now_us)
{
    struct lm_ownship ownship;
    lm_nav_at(&ear->nav, now_us, &ownship);
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

/* The unit's answer after `seconds`, and the velocity and start that it believes, which the bus
 * rounded. */
static struct lm_ownship fly_in_firmware(struct course *c, uint64_t age_us)
{
    struct ear ear;
    open_ear(&ear);
    const uint64_t start_us = 5000000;
    hear_double(&ear, LM_BUS_LATITUDE, c->latitude, start_us);
    hear_double(&ear, LM_BUS_LONGITUDE, c->longitude, start_us);
    hear_float(&ear, LM_BUS_NORTH_VELOCITY, c->north_m_s, start_us);
    hear_float(&ear, LM_BUS_EAST_VELOCITY, c->east_m_s, start_us);
    hear_float(&ear, LM_BUS_ELLIPSOID_HEIGHT, c->height_m, start_us);
    const struct lm_ownship ownship = at(&ear, start_us + age_us);
    c->north_m_s = ownship.velocity_north_mm_s / 1000.0;
    c->east_m_s = ownship.velocity_east_mm_s / 1000.0;
    return ownship;
}

TEST(two_seconds_of_constant_velocity_are_within_2_cm)
{
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
                wgs84_metres(latitude_deg, longitude_deg, hs_degrees(ownship.latitude),
                             hs_degrees(ownship.longitude));
            worst = fmax(worst, error);
        }
    }
    print_message("# worst error against constant velocity: %.4f m\n", worst);
    assert_true(worst < 0.02);
}

TEST(two_seconds_are_within_17_cm_of_the_geodesic)
{
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
            wgs84_direct(latitude, 179.999, azimuth, 600, &latitude_deg, &longitude_deg);
            const double error =
                wgs84_metres(latitude_deg, longitude_deg, hs_degrees(ownship.latitude),
                             hs_degrees(ownship.longitude));
            worst = fmax(worst, error);
            worst_below_60 =
                latitude >= -60 && latitude <= 60 ? fmax(worst_below_60, error) : worst_below_60;
        }
    }
    print_message("# worst error against the geodesic: %.4f m, up to 60 degrees %.4f m\n", worst,
                  worst_below_60);
    assert_true(worst < 0.17 && worst_below_60 < 0.07);
}

TEST(each_coordinate_moves_from_its_own_time)
{
    struct ear ear;
    open_ear(&ear);
    hear_float(&ear, LM_BUS_NORTH_VELOCITY, 200, 0);
    hear_float(&ear, LM_BUS_EAST_VELOCITY, 100, 0);
    hear_double(&ear, LM_BUS_LATITUDE, 0, 100000);
    hear_double(&ear, LM_BUS_LONGITUDE, 0, 150000);
    const struct lm_ownship o = at(&ear, 200000);
    /* 20 m on the meridian's radius 6,335,439 m, 5 m on the equator's. */
    const double count = 6.283185307179586 / 0x1p32;
    assert_true(fabs(o.latitude - 20 / 6335439.327 / count) < 1);
    assert_true(fabs(o.longitude - 5 / 6378137.0 / count) < 1);
    assert_int_equal(o.position_quality, LM_NAV_GOOD);
}

TEST(near_a_pole_the_position_stays_one)
{
    struct course c = {.latitude = 89.9999, .longitude = 20, .north_m_s = 1500, .east_m_s = 1500};
    const struct lm_ownship o = fly_in_firmware(&c, 2000000);
    assert_int_equal(o.latitude, FX_BAM_90);
    struct course s = {.latitude = -90, .longitude = 20, .north_m_s = -1500, .east_m_s = -1500};
    assert_int_equal(fly_in_firmware(&s, 2000000).latitude, 0u - FX_BAM_90);
}

/* ---- sources ---- */

TEST(ground_speed_and_track_serve_when_there_is_no_velocity)
{
    struct ear ear;
    open_ear(&ear);
    hear_float(&ear, LM_BUS_GROUND_SPEED, 100, 0);
    assert_int_equal(at(&ear, 0).velocity_quality, LM_NAV_DEAD);
    hear_float(&ear, LM_BUS_TRUE_TRACK, 120, 0);
    struct lm_ownship o = at(&ear, 0);
    assert_int_equal(o.velocity_quality, LM_NAV_GOOD);
    assert_in_range(o.velocity_north_mm_s + 50000, 0, 2);
    assert_in_range(o.velocity_east_mm_s - 86602, 0, 2);
    assert_in_range(o.ground_speed_mm_s - 99998, 0, 3);
    assert_true(fabs(hs_degrees(o.track) - 120) < 0.001);
    hear_float(&ear, LM_BUS_NORTH_VELOCITY, -30, 1000000);
    hear_float(&ear, LM_BUS_EAST_VELOCITY, -40, 1000000);
    o = at(&ear, 1000000);
    assert_int_equal(o.velocity_north_mm_s, -30000);
    assert_int_equal(o.ground_speed_mm_s, 50000);
    assert_true(fabs(hs_degrees(o.track) - (atan2(-40, -30) * 57.29577951308232)) < 1e-5);
    /* Stale is not yet dead. */
    hear_float(&ear, LM_BUS_GROUND_SPEED, 100, 3000000);
    hear_float(&ear, LM_BUS_TRUE_TRACK, 0, 3000000);
    assert_int_equal(at(&ear, 3000000).velocity_north_mm_s, -30000);
    assert_int_equal(at(&ear, 3000000).velocity_quality, LM_NAV_STALE);
    assert_int_equal(at(&ear, 3000001).velocity_north_mm_s, 100000);
}

/* Whichever half is missing: a speed without a track leads nowhere. */
TEST(a_velocity_that_is_dead_is_none)
{
    for (int half = 0; half < 2; half++) {
        struct ear ear;
        open_ear(&ear);
        hear_float(&ear, half ? LM_BUS_TRUE_TRACK : LM_BUS_GROUND_SPEED, 100, 0);
        const struct lm_ownship own = at(&ear, 1000);
        assert_int_equal(own.velocity_quality, LM_NAV_DEAD);
        assert_int_equal(own.ground_speed_mm_s, 0);
        assert_int_equal(own.velocity_north_mm_s, 0);
        assert_int_equal(own.velocity_east_mm_s, 0);
    }
}

TEST(the_best_height_that_lives_is_used_and_moved_on)
{
    struct ear ear;
    open_ear(&ear);
    hear_float(&ear, LM_BUS_BARO_ALTITUDE, 1000, 0);
    hear_float(&ear, LM_BUS_ALTITUDE_RATE, 10, 0);
    struct lm_ownship o = at(&ear, 500000);
    assert_int_equal(o.height_source, LM_BUS_BARO_ALTITUDE);
    assert_int_equal(o.height_m_q6, 1005 * 64);
    hear_float(&ear, LM_BUS_TRUE_ALTITUDE, 1100, 500000);
    assert_int_equal(at(&ear, 500000).height_source, LM_BUS_TRUE_ALTITUDE);
    hear_float(&ear, LM_BUS_ELLIPSOID_HEIGHT, 1150, 600000);
    hear_float(&ear, LM_BUS_UP_VELOCITY, -20, 600000);
    o = at(&ear, 1100000);
    assert_int_equal(o.height_source, LM_BUS_ELLIPSOID_HEIGHT);
    assert_int_equal(o.height_m_q6, 1140 * 64);
    hear_float(&ear, LM_BUS_TRUE_ALTITUDE, 1100, 5600000);
    assert_int_equal(at(&ear, 5600000).height_source, LM_BUS_ELLIPSOID_HEIGHT);
    assert_int_equal(at(&ear, 5600000).height_quality, LM_NAV_STALE);
    assert_int_equal(at(&ear, 5600001).height_source, LM_BUS_TRUE_ALTITUDE);
}

TEST(the_barometric_height_comes_first_when_it_is_preferred_and_lives)
{
    struct ear ear;
    open_ear(&ear);
    ear.nav.is_baro_preferred = true;
    hear_float(&ear, LM_BUS_ELLIPSOID_HEIGHT, 1150, 0);
    assert_int_equal(at(&ear, 0).height_source, LM_BUS_ELLIPSOID_HEIGHT);
    hear_float(&ear, LM_BUS_BARO_ALTITUDE, 1000, 0);
    assert_int_equal(at(&ear, 0).height_source, LM_BUS_BARO_ALTITUDE);
    hear_float(&ear, LM_BUS_ELLIPSOID_HEIGHT, 1150, 6000000);
    assert_int_equal(at(&ear, 6000000).height_source, LM_BUS_ELLIPSOID_HEIGHT);
}

/* "Variation east, magnetic least": a compass that reads 350 where the variation is 12 degrees east
 * points to 002 true, and to 338 where it is 12 west. */
TEST(a_magnetic_heading_is_corrected_by_the_variation)
{
    struct ear ear;
    open_ear(&ear);
    hear_float(&ear, LM_BUS_MAGNETIC_HEADING, 350, 0);
    struct lm_ownship o = at(&ear, 0);
    assert_true(o.is_heading_magnetic && fabs(hs_degrees(o.heading) + 10) < 1e-5);
    hear_float(&ear, LM_BUS_MAGNETIC_VARIATION, 12, 0);
    o = at(&ear, 0);
    assert_int_equal(o.heading_source, LM_BUS_MAGNETIC_HEADING);
    assert_true(!o.is_heading_magnetic && fabs(hs_degrees(o.heading) - 2) < 1e-5);
    hear_float(&ear, LM_BUS_MAGNETIC_VARIATION, -12, 0);
    assert_true(fabs(hs_degrees(at(&ear, 0).heading) + 22) < 1e-5);

    /* A minute without a variation, and the heading is what the compass says. */
    hear_float(&ear, LM_BUS_MAGNETIC_HEADING, 350, 60000000);
    o = at(&ear, 60000000);
    assert_true(!o.is_heading_magnetic && o.heading_quality == LM_NAV_GOOD);
    o = at(&ear, 60000001);
    assert_true(o.is_heading_magnetic && fabs(hs_degrees(o.heading) + 10) < 1e-5);

    hear_float(&ear, LM_BUS_TRUE_HEADING, 5, 60000001);
    o = at(&ear, 60000001);
    assert_true(o.heading_source == LM_BUS_TRUE_HEADING && !o.is_heading_magnetic);
}

TEST(heading_321_is_what_the_board_says)
{
    for (int is_magnetic = 0; is_magnetic < 2; is_magnetic++) {
        struct ear ear;
        open_ear(&ear);
        ear.nav.is_heading_magnetic = is_magnetic;
        hear_float(&ear, LM_BUS_HEADING, 90, 0);
        assert_int_equal(at(&ear, 0).is_heading_magnetic, is_magnetic);
        hear_float(&ear, LM_BUS_MAGNETIC_VARIATION, 3, 0);
        struct lm_ownship o = at(&ear, 0);
        assert_true(!o.is_heading_magnetic && o.heading_source == LM_BUS_HEADING);
        assert_true(fabs(hs_degrees(o.heading) - (is_magnetic ? 93 : 90)) < 1e-5);
        /* A compass that can be corrected is surer than a heading of either kind. */
        hear_float(&ear, LM_BUS_MAGNETIC_HEADING, 88, 0);
        o = at(&ear, 0);
        assert_true(o.heading_source == LM_BUS_MAGNETIC_HEADING);
        assert_true(fabs(hs_degrees(o.heading) - 91) < 1e-5);
    }
    struct ear ear;
    open_ear(&ear);
    hear_float(&ear, LM_BUS_HEADING, 90, 0);
    hear_float(&ear, LM_BUS_MAGNETIC_HEADING, 88, 0);
    assert_int_equal(at(&ear, 0).heading_source, LM_BUS_HEADING); /* true, so the board says */
}

TEST(true_heading_is_preferred_while_it_lives)
{
    struct ear ear;
    open_ear(&ear);
    hear_float(&ear, LM_BUS_HEADING, -90, 0);
    struct lm_ownship o = at(&ear, 0);
    assert_int_equal(o.heading, 0xc0000000u);
    assert_int_equal(o.heading_source, LM_BUS_HEADING);
    hear_float(&ear, LM_BUS_TRUE_HEADING, 272, 0);
    assert_true(fabs(hs_degrees(at(&ear, 0).heading) + 88) < 1e-6);
    hear_float(&ear, LM_BUS_HEADING, -90, 1000001);
    assert_int_equal(at(&ear, 1000000).heading_source, LM_BUS_TRUE_HEADING);
    assert_int_equal(at(&ear, 1000001).heading_source, LM_BUS_HEADING);
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

TEST(heading_turns_as_the_body_does)
{
    const double radian = 0.017453292519943295;
    double worst = 0;
    for (int pitch = -60; pitch <= 60; pitch += 20) {
        for (int roll = -180; roll < 180; roll += 30) {
            struct ear ear;
            open_ear(&ear);
            hear_float(&ear, LM_BUS_TRUE_HEADING, 350, 0);
            hear_float(&ear, LM_BUS_PITCH, pitch, 50000);
            hear_float(&ear, LM_BUS_ROLL, roll, 50000);
            hear_float(&ear, LM_BUS_PITCH_RATE, 12, 50000);
            hear_float(&ear, LM_BUS_YAW_RATE, -7, 50000);
            const double got = hs_degrees(at(&ear, 100000).heading) * radian;
            const double wanted = heading_by_rotation(350 * radian, pitch * radian, roll * radian,
                                                      12 * radian, -7 * radian, 0.1);
            worst = fmax(worst, fabs(remainder(got - wanted, 360 * radian)) / radian);
            /* Too old a rate is no rate. */
            assert_true(fabs(hs_degrees(at(&ear, 150001).heading) + 10) < 1e-6);
        }
    }
    /* The rates also change the attitude, which the firmware holds still for these 100 ms. */
    print_message("# worst error of heading after 100 ms: %.4f degree\n", worst);
    assert_true(worst < 0.06);
}

TEST(heading_stands_still_where_it_means_nothing)
{
    struct ear ear;
    open_ear(&ear);
    hear_float(&ear, LM_BUS_TRUE_HEADING, 10, 0);
    hear_float(&ear, LM_BUS_PITCH, 85, 0);
    hear_float(&ear, LM_BUS_ROLL, 0, 0);
    hear_float(&ear, LM_BUS_PITCH_RATE, 0, 0);
    hear_float(&ear, LM_BUS_YAW_RATE, 100, 0);
    assert_true(fabs(hs_degrees(at(&ear, 100000).heading) - 10) < 1e-6);
}

/* ---- several senders ---- */

/* A frame on redundancy channel n. */
static struct lm_can_frame on_channel(struct lm_can_frame frame, uint32_t channel)
{
    frame.id += channel << 16;
    frame.is_extended = channel > 0;
    return frame;
}

/* A position of one place from row `row` (0 GPS latitude; 20 INS latitude; 25 auxiliary) and
 * channel, as FLOAT, and a velocity of 0. */
static void hear_place(struct ear *ear, uint32_t row, uint32_t channel, double degrees,
                       uint64_t time_us)
{
    const struct lm_bus_row *rows = lm_bus_canas17.rows;
    const uint32_t bits = bus_float_bits(degrees);
    hear(ear, on_channel(bus_frame(rows[row].id, LM_CANAS_FLOAT, 0, bits, time_us), channel));
    hear(ear, on_channel(bus_frame(rows[row + 1].id, LM_CANAS_FLOAT, 0, bits, time_us), channel));
    hear_float(ear, LM_BUS_NORTH_VELOCITY, 0, time_us);
    hear_float(ear, LM_BUS_EAST_VELOCITY, 0, time_us);
}

enum { GPS = 0, INS = LM_BUS_NAV_FIELDS, AUXILIARY = INS + 5 };

static void assert_place(const struct ear *ear, uint64_t now_us, int degrees,
                         enum lm_nav_quality quality)
{
    const struct lm_ownship o = at(ear, now_us);
    assert_int_equal(o.position_quality, quality);
    assert_true(fabs(hs_degrees(o.latitude) - degrees) < 1e-5);
    assert_true(fabs(hs_degrees(o.longitude) - degrees) < 1e-5);
}

TEST(a_redundant_sender_takes_over_and_the_better_one_only_when_it_is_steady)
{
    struct ear ear;
    open_ear(&ear);
    /* GPS on channels 0 and 1 and INS, each 10 Hz, at 10, 11 and 12 degrees. Channel 0 is silent
     * from 3.0 to 3.5 s; both GPS are silent from 6 s on; INS from 8 s on. */
    for (uint64_t t = 0; t <= 11000000; t += 100000) {
        if (t < 6000000 && (t <= 3000000 || t >= 3500000)) {
            hear_place(&ear, GPS, 0, 10, t);
        }
        if (t < 6000000) {
            hear_place(&ear, GPS, 1, 11, t);
        }
        if (t <= 8000000) {
            hear_place(&ear, INS, 0, 12, t);
        }
        hear_float(&ear, LM_BUS_NORTH_VELOCITY, 0, t);
        hear_float(&ear, LM_BUS_EAST_VELOCITY, 0, t);
        if (t < 3300000 || (t >= 4500000 && t < 6200000)) {
            assert_place(&ear, t, 10, LM_NAV_GOOD);
        } else if (t >= 3400000 && t < 4500000) {
            assert_place(&ear, t, 11, LM_NAV_GOOD);
        } else if (t >= 6400000 && t <= 8300000) {
            assert_place(&ear, t, 12, LM_NAV_GOOD);
        } else if (t >= 8400000 && t <= 10000000) {
            assert_place(&ear, t, 12, LM_NAV_STALE);
        } else if (t >= 10100000) {
            assert_place(&ear, t, 0, LM_NAV_DEAD);
        }
    }
    assert_int_equal(ear.nav.position_jumps,
                     0); /* another sender's position is no jump of this one */
}

TEST(a_second_node_on_an_identifier_waits_until_the_first_is_stale)
{
    struct ear ear;
    open_ear(&ear);
    for (uint64_t t = 0; t <= 3000000; t += 100000) {
        for (uint8_t node = 8; node <= 9; node++) {
            for (uint32_t row = 0; row < 2 && (node == 9 || t > 0) && (node == 8 || t < 1000000);
                 row++) {
                struct lm_can_frame f =
                    bus_frame(1036 + row, LM_CANAS_FLOAT, 0, bus_float_bits(10 * node), t);
                f.data[0] = node;
                hear(&ear, f);
            }
        }
        const struct lm_ownship o = at(&ear, t);
        assert_true(fabs(hs_degrees(o.longitude) - (t <= 1200000 ? 90 : 80)) < 1e-5);
        assert_int_equal(o.position_origin.node, t <= 1200000 ? 9 : 8);
    }
    assert_int_equal(ear.nav.rivals, 2 * 12);
    assert_int_equal(ear.nav.position_jumps, 2); /* at the change, and no other */
}

TEST(both_coordinates_come_from_one_sender)
{
    struct ear ear;
    open_ear(&ear);
    hear_place(&ear, INS, 0, 12, 0);
    hear(&ear, bus_frame(1036, LM_CANAS_FLOAT, 0, bus_float_bits(10), 0));
    assert_place(&ear, 1000, 12, LM_NAV_GOOD); /* GPS has no longitude */
    hear(&ear, bus_frame(1037, LM_CANAS_FLOAT, 0, bus_float_bits(10), 2000));
    assert_place(&ear, 2000, 10, LM_NAV_GOOD);
}

TEST(of_too_many_senders_the_best_are_followed)
{
    struct ear ear;
    open_ear(&ear);
    /* The least wanted first, so that each better one has to find a place. */
    for (uint32_t channel = LM_BUS_CHANNELS; channel-- > 0;) {
        hear_place(&ear, AUXILIARY, channel, 20 + (int)channel, 0);
    }
    for (uint32_t channel = LM_BUS_CHANNELS; channel-- > 0;) {
        hear_place(&ear, GPS, channel, 10 + (int)channel, 1000);
    }
    hear_place(&ear, INS, 0, 30, 2000);
    assert_int_equal(ear.nav.crowded, 2);
    assert_place(&ear, 2000, 10, LM_NAV_GOOD);
    /* Without the better three the last is still there. */
    for (uint64_t t = 100000; t <= 3000000; t += 100000) {
        hear_place(&ear, GPS, LM_BUS_CHANNELS - 1, 13, t);
    }
    assert_place(&ear, 3000000, 13, LM_NAV_GOOD);
    /* Dead ones make place for any other. */
    hear_place(&ear, INS, 0, 30, 3000000);
    hear_place(&ear, INS, 0, 30, 8000000);
    assert_place(&ear, 8000000, 30, LM_NAV_GOOD);
    assert_int_equal(ear.nav.crowded, 2);
}

/* The list of longitudes is full, and that of the one sender with a latitude is not on it. */
TEST(a_latitude_finds_no_mate_among_the_longitudes_of_others)
{
    struct ear ear;
    open_ear(&ear);
    const struct lm_bus_row *rows = lm_bus_canas17.rows;
    const uint32_t bits = bus_float_bits(10);
    for (uint32_t channel = 0; channel < LM_NAV_SOURCES; channel++) {
        const uint32_t id = rows[channel < LM_BUS_CHANNELS ? GPS + 1 : INS + 1].id;
        hear(&ear,
             on_channel(bus_frame(id, LM_CANAS_FLOAT, 0, bits, 0), channel % LM_BUS_CHANNELS));
    }
    assert_true(ear.nav.item[LM_BUS_LONGITUDE][LM_NAV_SOURCES - 1].has_value);
    hear(&ear, bus_frame(rows[AUXILIARY].id, LM_CANAS_FLOAT, 0, bits, 0));
    assert_int_equal(at(&ear, 1000).position_quality, LM_NAV_DEAD);
    assert_int_equal(ear.nav.crowded, 0);
}

TEST(every_group_tells_who_said_it_and_how_long_ago)
{
    struct ear ear;
    open_ear(&ear);
    const struct lm_bus_row *rows = lm_bus_canas17.rows;
    hear_place(&ear, INS, 2, 12, 1000000);
    hear(&ear, bus_frame(rows[INS + 2].id, LM_CANAS_FLOAT, 0, bus_float_bits(900), 1010000));
    struct lm_can_frame heading = bus_float(LM_BUS_TRUE_HEADING, 33, 1020000);
    heading.data[0] = 77;
    hear(&ear, heading);
    hear_float(&ear, LM_BUS_PITCH, 3, 1000000);
    hear_float(&ear, LM_BUS_ROLL, 3, 1030000);
    const struct lm_ownship o = at(&ear, 1050000);
    assert_true(o.position_origin.row == INS && o.position_origin.rank == 0x102 &&
                o.position_origin.node == 9 && o.position_origin.age_us == 50000);
    assert_true(o.height_origin.row == INS + 2 && o.height_origin.age_us == 40000);
    assert_true(o.heading_origin.row == LM_BUS_TRUE_HEADING && o.heading_origin.node == 77);
    assert_int_equal(o.attitude_origin.age_us, 50000); /* of the older member */
    assert_int_equal(o.velocity_origin.age_us, 50000);
    const struct lm_ownship dead = at(&ear, 9000000);
    assert_true(dead.position_origin.age_us == 0 && dead.position_origin.node == 0);
}

/* ---- positions of coarse steps ---- */

struct ride {
    double worst_hop_m;       /* of the ownship, at the moment that a fix comes */
    double worst_raw_hop_m;   /* the same, were each fix taken as it came */
    double worst_error_steps; /* against the truth, in half steps of the FLOAT */
};

/* A minute at constant velocity from 179.9 degrees eastwards or westwards, position as FLOAT at
 * 10 Hz; `bias_m_s` is added to the velocity that is told. */
static struct ride fly_on_floats(double latitude, double north_m_s, double east_m_s,
                                 double bias_m_s)
{
    struct ride ride = {0};
    struct ear ear;
    open_ear(&ear);
    const struct course c = {
        .latitude = latitude, .longitude = 179.9, .north_m_s = north_m_s, .east_m_s = east_m_s};
    double told_latitude = 0, told_longitude = 0;
    for (uint64_t t = 0; t <= 60000000; t += 100000) {
        double true_latitude, true_longitude;
        fly_in_doubles(&c, (double)t * 1e-6, &true_latitude, &true_longitude);
        true_longitude = remainder(true_longitude, 360);
        hear_float(&ear, LM_BUS_NORTH_VELOCITY, north_m_s + bias_m_s, t);
        hear_float(&ear, LM_BUS_EAST_VELOCITY, east_m_s, t);
        const struct lm_ownship before = at(&ear, t);
        hear_float(&ear, LM_BUS_LATITUDE, true_latitude, t);
        hear_float(&ear, LM_BUS_LONGITUDE, true_longitude, t);
        const struct lm_ownship now = at(&ear, t);
        if (t >= 1000000) {
            ride.worst_hop_m =
                fmax(ride.worst_hop_m,
                     wgs84_metres(hs_degrees(before.latitude), hs_degrees(before.longitude),
                                  hs_degrees(now.latitude), hs_degrees(now.longitude)));
            /* What the last fix, carried on for 100 ms, would have been. */
            const struct course leg = {told_latitude, told_longitude, 0, north_m_s, east_m_s};
            double carried_latitude, carried_longitude;
            fly_in_doubles(&leg, 0.1, &carried_latitude, &carried_longitude);
            ride.worst_raw_hop_m = fmax(ride.worst_raw_hop_m,
                                        wgs84_metres(carried_latitude, carried_longitude,
                                                     (float)true_latitude, (float)true_longitude));
        }
        told_latitude = (float)true_latitude;
        told_longitude = (float)true_longitude;
        const float size = (float)fabs(true_latitude);
        const double metres = 111300, cosine = cos(true_latitude * 0.017453292519943295);
        const double latitude_half_m = (nextafterf(size, 90) - size) * metres / 2;
        const double longitude_half_m = 0x1p-17 * metres * cosine; /* from 128 to 256 degrees */
        /* 2 cm are left for the velocity, which the bus rounds too. */
        ride.worst_error_steps = fmax(
            ride.worst_error_steps,
            fmax(fabs(hs_degrees(now.latitude) - true_latitude) * metres / (latitude_half_m + 0.02),
                 fabs(remainder(hs_degrees(now.longitude) - true_longitude, 360)) * metres *
                     cosine / (longitude_half_m + 0.02)));
    }
    assert_int_equal(ear.nav.position_jumps, 0);
    return ride;
}

TEST(a_float_position_moves_evenly_and_stays_within_its_step)
{
    struct ride worst = {0};
    for (int heading = 0; heading < 360; heading += 40) {
        const double radian = heading * 0.017453292519943295;
        const struct ride r =
            fly_on_floats(heading % 3 * 20 - 20.3, 180 * cos(radian), 180 * sin(radian), 0);
        worst.worst_hop_m = fmax(worst.worst_hop_m, r.worst_hop_m);
        worst.worst_raw_hop_m = fmax(worst.worst_raw_hop_m, r.worst_raw_hop_m);
        worst.worst_error_steps = fmax(worst.worst_error_steps, r.worst_error_steps);
    }
    print_message("# worst hop %.3f m (%.3f m without smoothing), worst error %.2f half steps\n",
                  worst.worst_hop_m, worst.worst_raw_hop_m, worst.worst_error_steps);
    assert_true(worst.worst_raw_hop_m > 0.8);
    assert_true(worst.worst_hop_m < 0.25);
    /* Within half a step of the fix, which is within half a step of the truth. */
    assert_true(worst.worst_error_steps < 2.01);
}

TEST(a_wrong_velocity_moves_a_float_position_no_further_than_its_step)
{
    const struct ride r = fly_on_floats(47.3, 120, -90, 3);
    print_message("# 3 m/s too fast: worst hop %.3f m, worst error %.2f half steps\n",
                  r.worst_hop_m, r.worst_error_steps);
    assert_true(r.worst_error_steps < 2.01);
    assert_true(r.worst_hop_m < 0.3 + 0.43); /* its way in 100 ms, and a step of latitude */
}

TEST(a_float_position_without_velocity_is_taken_as_it_comes)
{
    struct ear ear;
    open_ear(&ear);
    for (int i = 0; i < 20; i++) {
        const double degrees = 179.5 + i * 1e-5;
        hear_float(&ear, LM_BUS_LATITUDE, 60, (uint64_t)i * 100000);
        hear_float(&ear, LM_BUS_LONGITUDE, degrees, (uint64_t)i * 100000);
        const struct lm_ownship o = at(&ear, (uint64_t)i * 100000);
        assert_true(fabs(hs_degrees(o.longitude) - (double)(float)degrees) < 1e-7);
    }
}

TEST(steps_of_short2_are_no_jumps)
{
    struct ear ear;
    open_ear(&ear);
    for (uint32_t i = 0; i < 100; i++) {
        const uint64_t t = i * 100000;
        const uint32_t word = (8000 + i / 3) << 16 | 180; /* 612 m now and then */
        hear(&ear, bus_frame(1036, LM_CANAS_SHORT2, 0, word, t));
        hear(&ear, bus_frame(1037, LM_CANAS_SHORT2, 0, word, t));
    }
    assert_int_equal(ear.nav.position_jumps, 0);
}

/* ---- ages ---- */

struct ages {
    enum lm_nav_quality position, height, heading, attitude, velocity, utc;
};

static void hear_everything(struct ear *ear, uint64_t time_us)
{
    for (int i = 0; i < LM_BUS_UTC; i++) {
        hear_float(ear, (enum lm_bus_field)i, 1, time_us);
    }
    hear(ear, bus_frame(1200, LM_CANAS_CHAR4, 0, 0x173b3b00, time_us));
}

static void assert_ages(const struct ear *ear, uint64_t now_us, struct ages expected)
{
    const struct lm_ownship o = at(ear, now_us);
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

TEST(every_quality_changes_at_the_microsecond_the_table_says)
{
    struct ear ear;
    open_ear(&ear);
    assert_ages(&ear, 0, (struct ages){D, D, D, D, D, D});
    const uint64_t t = 7000000;
    hear_everything(&ear, t);
    assert_ages(&ear, t, (struct ages){G, G, G, G, G, G});
    assert_ages(&ear, t + 100000, (struct ages){G, G, G, G, G, G});
    assert_ages(&ear, t + 100001, (struct ages){G, G, G, S, G, G});
    assert_ages(&ear, t + 300000, (struct ages){G, G, G, S, G, G});
    assert_ages(&ear, t + 300001, (struct ages){S, G, S, S, S, G});
    assert_ages(&ear, t + 500000, (struct ages){S, G, S, S, S, G});
    assert_ages(&ear, t + 500001, (struct ages){S, S, S, S, S, G});
    assert_ages(&ear, t + 1000000, (struct ages){S, S, S, S, S, G});
    assert_ages(&ear, t + 1000001, (struct ages){S, S, D, D, S, G});
    assert_ages(&ear, t + 2000000, (struct ages){S, S, D, D, S, G});
    assert_ages(&ear, t + 2000001, (struct ages){D, S, D, D, D, G});
    assert_ages(&ear, t + 3000001, (struct ages){D, S, D, D, D, S});
    assert_ages(&ear, t + 5000000, (struct ages){D, S, D, D, D, S});
    assert_ages(&ear, t + 5000001, (struct ages){D, D, D, D, D, S});
    assert_ages(&ear, t + 10000001, (struct ages){D, D, D, D, D, D});
    const struct lm_ownship o = at(&ear, t + 10000001);
    assert_true(o.latitude == 0 && o.longitude == 0 && o.height_m_q6 == 0 && o.heading == 0 &&
                o.pitch == 0 && o.roll == 0 && o.ground_speed_mm_s == 0 && o.utc_s == 0);
}

TEST(one_dead_coordinate_or_angle_kills_its_group)
{
    struct ear ear;
    open_ear(&ear);
    hear_everything(&ear, 0);
    hear_float(&ear, LM_BUS_LATITUDE, 1, 2000000);
    hear_float(&ear, LM_BUS_PITCH, 1, 2000000);
    hear_float(&ear, LM_BUS_NORTH_VELOCITY, 1, 2000000);
    assert_ages(&ear, 2000001, (struct ages){D, S, D, D, D, G});
}

TEST(a_position_that_cannot_be_moved_on_or_is_coarse_is_stale_at_best)
{
    struct ear ear;
    open_ear(&ear);
    hear_double(&ear, LM_BUS_LATITUDE, 47, 0);
    hear_double(&ear, LM_BUS_LONGITUDE, 11, 0);
    assert_int_equal(at(&ear, 100).position_quality, LM_NAV_STALE);
    assert_true(fabs(hs_degrees(at(&ear, 100000).latitude) - 47) < 1e-7);
    hear_float(&ear, LM_BUS_NORTH_VELOCITY, 0, 0);
    hear_float(&ear, LM_BUS_EAST_VELOCITY, 0, 0);
    assert_int_equal(at(&ear, 100).position_quality, LM_NAV_GOOD);
    hear(&ear, bus_frame(1037, LM_CANAS_SHORT2, 0, 0x08000000u | 180, 100));
    assert_int_equal(at(&ear, 100).position_quality, LM_NAV_STALE);
    hear_double(&ear, LM_BUS_LONGITUDE, 11, 200);
    assert_int_equal(at(&ear, 200).position_quality, LM_NAV_GOOD);
}

TEST(a_lone_half_never_moves_the_position)
{
    struct ear ear;
    open_ear(&ear);
    hear_everything(&ear, 0);
    hear_double(&ear, LM_BUS_LATITUDE, 47, 0);
    const struct lm_ownship before = at(&ear, 1000);
    for (uint8_t i = 0; i < 100; i++) {
        hear(&ear, bus_frame(1036, i & 1 ? LM_CANAS_DOUBLEH : LM_CANAS_DOUBLEL, (uint8_t)(3 * i),
                             0x40500000u + i, 500));
        const struct lm_ownship after = at(&ear, 1000);
        assert_memory_equal(&before, &after, sizeof before);
    }
}

TEST(time_going_backwards_is_survived)
{
    struct ear ear;
    open_ear(&ear);
    hear_everything(&ear, 9000000);
    /* A little ahead is the order of reading two clocks; far ahead is another clock. */
    assert_ages(&ear, 8900000, (struct ages){G, G, G, G, G, G});
    assert_ages(&ear, 8899999, (struct ages){G, G, G, D, G, G});
    assert_ages(&ear, 8499999, (struct ages){D, D, D, D, D, G});
    assert_ages(&ear, 0, (struct ages){D, D, D, D, D, D});
    /* The recording starts over: what is heard now is believed now. */
    hear_everything(&ear, 10);
    assert_ages(&ear, 10, (struct ages){G, G, G, G, G, G});
    assert_int_equal(ear.nav.position_jumps, 0);
    assert_ages(&ear, UINT64_MAX, (struct ages){D, D, D, D, D, D});
}

TEST(a_jump_is_believed_and_counted)
{
    struct ear ear;
    open_ear(&ear);
    hear_double(&ear, LM_BUS_LATITUDE, 60, 0);
    hear_double(&ear, LM_BUS_LONGITUDE, 179.999, 0);
    assert_int_equal(ear.nav.position_jumps, 0);
    /* 149 m of latitude and, across the antimeridian, 149 m of longitude in 100 ms. */
    hear_double(&ear, LM_BUS_LATITUDE, 60 + 149 / 111400.0, 100000);
    hear_double(&ear, LM_BUS_LONGITUDE, 179.999 + 149 / 55800.0 - 360, 100000);
    assert_int_equal(ear.nav.position_jumps, 0);
    hear_double(&ear, LM_BUS_LATITUDE, 60 + (149 + 152) / 111400.0, 200000);
    assert_int_equal(ear.nav.position_jumps, 1);
    hear_double(&ear, LM_BUS_LONGITUDE, 179.999 + (149 + 152) / 55800.0 - 360, 200000);
    assert_int_equal(ear.nav.position_jumps, 2);
    hear_double(&ear, LM_BUS_LATITUDE, -45, 300000);
    assert_int_equal(ear.nav.position_jumps, 3);
    hear_double(&ear, LM_BUS_LONGITUDE, -100, 300000);
    assert_int_equal(ear.nav.position_jumps, 4);
    assert_true(fabs(hs_degrees(at(&ear, 300000).latitude) + 45) < 1e-7);
    /* Two fixes in one millisecond: what jitters is the bus. */
    hear_double(&ear, LM_BUS_LATITUDE, -45.001, 301000);
    assert_int_equal(ear.nav.position_jumps, 4);
    /* 20 km in 14 s is an aircraft; a twin of an earlier time stamp is not. */
    hear_double(&ear, LM_BUS_LATITUDE, -45.18, 14300000);
    assert_int_equal(ear.nav.position_jumps, 4);
    hear_double(&ear, LM_BUS_LATITUDE, -45, 0);
    assert_int_equal(ear.nav.position_jumps, 5);
    /* A quarter round the world, but after the time that times 1500 just passes 2^64. */
    hear_double(&ear, LM_BUS_LATITUDE, 45, 12297829382473035u);
    assert_int_equal(ear.nav.position_jumps, 5);
}

TEST(the_clock_runs_on_between_its_messages)
{
    struct ear ear;
    open_ear(&ear);
    hear(&ear, bus_frame(1200, LM_CANAS_CHAR4, 0, 0x173b3b00, 0)); /* 23:59:59 */
    assert_int_equal(at(&ear, 999999).utc_s, 86399);
    assert_int_equal(at(&ear, 1000000).utc_s, 0);
    assert_int_equal(at(&ear, 2500000).utc_s, 1);
}

TEST(the_same_frames_give_the_same_ownship_to_the_last_bit)
{
    struct ear a, b;
    memset(&a, 0x55, sizeof a);
    memset(&b, 0xaa, sizeof b);
    open_ear(&a);
    open_ear(&b);
    struct hs_rng rng;
    hs_rng_seed(&rng, 31);
    for (uint64_t t = 0; t < 10000000; t += 12500) {
        const enum lm_bus_field field = (enum lm_bus_field)hs_rng_below(&rng, LM_BUS_UTC);
        const struct lm_can_frame frame = bus_float(field, 50 * hs_rng_uniform(&rng), t);
        hear(&a, frame);
        hear(&b, frame);
        struct lm_ownship at_a, at_b;
        memset(&at_a, 1, sizeof at_a);
        memset(&at_b, 2, sizeof at_b);
        lm_nav_at(&a.nav, t + 6000, &at_a);
        lm_nav_at(&b.nav, t + 6000, &at_b);
        assert_memory_equal(&at_a, &at_b, sizeof at_a);
    }
}

/* ---- values that the built-in table never tells ---- */

static struct lm_bus_event coordinate(enum lm_bus_field field, int32_t value, uint32_t step,
                                      uint64_t time_us)
{
    return (struct lm_bus_event){.field = (uint8_t)field,
                                 .value = value,
                                 .step = step,
                                 .time_us = time_us,
                                 .period_us = 100000,
                                 .stale_ms = 300,
                                 .dead_ms = 5000};
}

TEST(either_coordinate_that_is_coarse_makes_the_position_stale)
{
    for (int coarse = 0; coarse < 3; coarse++) {
        struct ear ear;
        open_ear(&ear);
        hear_float(&ear, LM_BUS_NORTH_VELOCITY, 0, 0);
        hear_float(&ear, LM_BUS_EAST_VELOCITY, 0, 0);
        const struct lm_bus_event events[] = {
            coordinate(LM_BUS_LATITUDE, 1 << 28, LM_NAV_COARSE_BAM + (coarse == 1), 0),
            coordinate(LM_BUS_LONGITUDE, 1 << 28, LM_NAV_COARSE_BAM + (coarse == 2), 0)};
        lm_nav_take(&ear.nav, &events[0]);
        lm_nav_take(&ear.nav, &events[1]);
        assert_int_equal(at(&ear, 0).position_quality, coarse ? LM_NAV_STALE : LM_NAV_GOOD);
    }
}

TEST(a_coordinate_known_to_no_more_than_the_globe_is_held_within_half_of_it)
{
    struct ear ear;
    open_ear(&ear);
    hear_float(&ear, LM_BUS_NORTH_VELOCITY, 100, 0);
    hear_float(&ear, LM_BUS_EAST_VELOCITY, 100, 0);
    for (uint64_t i = 0; i < 10; i++) {
        const struct lm_bus_event events[] = {
            coordinate(LM_BUS_LATITUDE, 1 << 28, UINT32_MAX, i * 100000),
            coordinate(LM_BUS_LONGITUDE, 1 << 28, UINT32_MAX, i * 100000)};
        lm_nav_take(&ear.nav, &events[0]);
        lm_nav_take(&ear.nav, &events[1]);
    }
    /* 90 m on by the velocity alone: the fixes do not contradict it. */
    const double moved_m = (at(&ear, 900000).latitude - (1 << 28)) * 40007863.0 / 4294967296.0;
    assert_true(moved_m > 80 && moved_m < 100);
}

TEST(a_longitude_before_any_latitude_is_taken_as_it_comes)
{
    struct ear ear;
    open_ear(&ear);
    hear_float(&ear, LM_BUS_NORTH_VELOCITY, 100, 0);
    hear_float(&ear, LM_BUS_EAST_VELOCITY, 100, 0);
    for (int i = 0; i < 3; i++) {
        const struct lm_bus_event event =
            coordinate(LM_BUS_LONGITUDE, 1000 * i, 4000, (uint64_t)i * 100000);
        lm_nav_take(&ear.nav, &event);
        assert_int_equal(ear.nav.item[LM_BUS_LONGITUDE][0].value, 1000 * i);
    }
    assert_int_equal(at(&ear, 200000).position_quality, LM_NAV_DEAD);
}

TEST(what_is_no_navigation_is_not_taken)
{
    struct ear ear;
    open_ear(&ear);
    const struct lm_nav before = ear.nav;
    for (int field = LM_BUS_NAV_FIELDS; field < 256; field++) {
        struct lm_bus_event event = coordinate(LM_BUS_LATITUDE, 5, 0, 0);
        event.field = (uint8_t)field;
        lm_nav_take(&ear.nav, &event);
        assert_memory_equal(&ear.nav, &before, sizeof before);
    }
}

/* Without a variation, 321 serves where the board says that it is true; where it is magnetic too,
 * the compass does. */
TEST(without_a_variation_a_magnetic_321_gives_way_to_the_compass)
{
    for (int is_magnetic = 0; is_magnetic < 2; is_magnetic++) {
        struct ear ear;
        open_ear(&ear);
        ear.nav.is_heading_magnetic = is_magnetic;
        hear_float(&ear, LM_BUS_HEADING, 90, 0);
        hear_float(&ear, LM_BUS_MAGNETIC_HEADING, 88, 0);
        assert_int_equal(at(&ear, 0).heading_source,
                         is_magnetic ? LM_BUS_MAGNETIC_HEADING : LM_BUS_HEADING);
    }
}
