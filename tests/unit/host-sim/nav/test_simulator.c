/* Datagrams of FlightGear and X-Plane as frames of the bus: their readers, and the bridge as the
 * display would hear it. flightgear.txt was recorded from FlightGear; its head says how. */
#include "check.h"
#include "decode.h"
#include "nav/bridge.h"
#include "read_text.h"

#include <geodesic.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST = 60000, TICK_US = 12500 };
static const int64_t begin_us = INT64_C(1700000000000000);

/* ---- FlightGear's reader ---- */

static const char line[] =
    "landmass1 12.5,0,9.5,0.25,2026-11-23T11:04:13,46.5,-11.25,3048,-12.5,2.5,350,345,60,-80,1.5,"
    "1,-2,3\n";

static enum nav_told_fault read_line(const char *text, struct nav_told *t)
{
    return nav_flightgear_read((const uint8_t *)text, strlen(text), t);
}

TEST(a_line_of_flightgear_has_its_values_in_their_units)
{
    struct nav_told t;
    assert_int_equal(read_line(line, &t), NAV_TOLD_OK);
    assert_near(t.latitude_deg, 46.5, 0);
    assert_near(t.longitude_deg, -11.25, 0);
    assert_near(t.height_m, 3048, 0);
    assert_near(t.roll_deg, -12.5, 0);
    assert_near(t.pitch_deg, 2.5, 0);
    assert_near(t.heading_deg, -10, 0);
    assert_near(t.magnetic_deg, -15, 0);
    assert_near(t.north_ms, 60, 0);
    assert_near(t.east_ms, -80, 0);
    assert_near(t.up_ms, -1.5, 0);
    assert_near(t.roll_rate, 1, 0);
    assert_near(t.pitch_rate, -2, 0);
    assert_near(t.yaw_rate, 3, 0);
    assert_near(t.elapsed_s, 9.25, 0);
    assert_int_equal(t.order, 125000);
    assert_int_equal(t.paused, 0);
    assert_int_equal(t.utc_us, INT64_C(1795431853000000)); /* date -u -d 2026-11-23T11:04:13 +%s */
}

TEST(every_shortened_line_is_refused)
{
    struct nav_told t;
    for (size_t length = 0; length < sizeof line - 1; length++) {
        uint8_t *alone = malloc(length + 1); /* reading beyond it is seen by the sanitizers */
        memcpy(alone, line, length);
        assert_int_not_equal(nav_flightgear_read(alone, length, &t), NAV_TOLD_OK);
        free(alone);
    }
}

TEST(a_line_with_a_wrong_value_is_refused_and_told_why)
{
    static const struct {
        const char *text;
        enum nav_told_fault fault;
    } rows[] = {
        {"hello\n", NAV_TOLD_FOREIGN},
        {"landmass2 12.5,0,9.25,0,x,46.5,-11,3048,0,0,0,0,0,0,0,0,0,0\n", NAV_TOLD_FOREIGN},
        {"landmass1 12.5,0,9.25,0,x,46.5,-11,3048,0,0,0,0,0,0,0,0,0\n", NAV_TOLD_MALFORMED},
        {"landmass1 12.5,0,9.25,0,x,46.5,-11,3048,0,0,0,0,0,0,0,0,0,0,0\n", NAV_TOLD_MALFORMED},
        {"landmass1 12.5,0,9.25,0,x,nan,-11,3048,0,0,0,0,0,0,0,0,0,0\n", NAV_TOLD_MALFORMED},
        {"landmass1 12.5,0,9.25,0,x,46,5,-11,3048,0,0,0,0,0,0,0,0,0,0\n", NAV_TOLD_MALFORMED},
        {"landmass1 12.5,2,9.25,0,x,46.5,-11,3048,0,0,0,0,0,0,0,0,0,0\n", NAV_TOLD_RANGE},
        {"landmass1 12.5,0,9.25,0,x,90.1,-11,3048,0,0,0,0,0,0,0,0,0,0\n", NAV_TOLD_RANGE},
        {"landmass1 12.5,0,9.25,0,x,46.5,-181,3048,0,0,0,0,0,0,0,0,0,0\n", NAV_TOLD_RANGE},
        {"landmass1 12.5,0,9.25,0,x,46.5,-11,30001,0,0,0,0,0,0,0,0,0,0\n", NAV_TOLD_RANGE},
        {"landmass1 12.5,0,9.25,0,x,46.5,-11,3048,0,91,0,0,0,0,0,0,0,0\n", NAV_TOLD_RANGE},
        {"landmass1 12.5,0,9.25,0,x,46.5,-11,3048,0,0,0,0,1200,1200,0,0,0,0\n", NAV_TOLD_RANGE},
        {"landmass1 12.5,0,9.25,0,x,46.5,-11,3048,0,0,0,0,0,0,0,0,0,0\n", NAV_TOLD_OK},
    };
    struct nav_told t;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        assert_int_equal(read_line(rows[i].text, &t), rows[i].fault);
    }
}

/* ---- X-Plane's reader ---- */

/* One row that X-Plane sent, published with what its receiver read of it: pitch 0.993604, roll
 * -0.241524, true heading 25.4843, magnetic heading 28.423 (alex-leung.blogspot.com). */
static const uint8_t published[] = {
    'D',  'A',  'T',  'A',  '*',  0x11, 0,    0,    0,    0xDC, 0x5C, 0x7E, 0x3F, 0x28,
    0x52, 0x77, 0xBE, 0xD1, 0xDF, 0xCB, 0x41, 0x58, 0x62, 0xE3, 0x41, 0x00, 0xC0, 0x79,
    0xC4, 0x00, 0xC0, 0x79, 0xC4, 0x00, 0xC0, 0x79, 0xC4, 0x00, 0xC0, 0x79, 0xC4};

static void put_float(uint8_t *p, double value)
{
    const float narrow = (float)value; /* this machine's floats are X-Plane's */
    memcpy(p, &narrow, sizeof narrow);
}

static size_t put_row(uint8_t *p, uint8_t row, double a, double b, double c, double d, double e,
                      double f)
{
    const double v[8] = {a, b, c, d, e, f, 0, 0};
    memset(p, 0, 4);
    p[0] = row;
    for (int i = 0; i < 8; i++) {
        put_float(p + 4 + 4 * i, v[i]);
    }
    return 36;
}

static size_t make_data(uint8_t *p, double latitude_deg)
{
    size_t n = sizeof published;
    memcpy(p, published, n);
    n += put_row(p + n, 3, 200, 0, 0, 0, 0, 0); /* another row, which is passed over */
    n += put_row(p + n, 20, latitude_deg, 11.25, 10000, 0, 0, 0);
    n += put_row(p + n, 21, 1e5, 2e3, -3e4, 80, 2, -60);
    return n;
}

TEST(a_published_row_of_xplane_is_read_as_its_publisher_did)
{
    struct nav_told t;
    uint8_t bytes[512];
    assert_int_equal(nav_xplane_read(bytes, make_data(bytes, 46.5), &t), NAV_TOLD_OK);
    assert_near(t.pitch_deg, 0.993604, 1e-6);
    assert_near(t.roll_deg, -0.241524, 1e-6);
    assert_near(t.heading_deg, 25.4843, 1e-4);
    assert_near(t.magnetic_deg, 28.423, 1e-3);
    assert_near(t.latitude_deg, 46.5, 0);
    assert_near(t.longitude_deg, 11.25, 0);
    assert_near(t.height_m, 3048, 1e-9);
    assert_near(t.east_ms, 80, 0);
    assert_near(t.up_ms, 2, 0);
    assert_near(t.north_ms, 60, 0);
    assert_int_equal(t.paused, -1);
}

TEST(data_of_xplane_without_a_row_is_incomplete_and_cut_short_malformed)
{
    struct nav_told t;
    uint8_t bytes[512];
    assert_int_equal(nav_xplane_read(published, sizeof published, &t), NAV_TOLD_INCOMPLETE);
    const size_t whole = make_data(bytes, 46.5);
    for (size_t length = 0; length < whole; length++) {
        uint8_t *alone = malloc(length + 1);
        memcpy(alone, bytes, length);
        const enum nav_told_fault fault = nav_xplane_read(alone, length, &t);
        free(alone);
        assert_int_equal(fault, length < 5                       ? NAV_TOLD_FOREIGN
                                : length > 5 && length % 36 == 5 ? NAV_TOLD_INCOMPLETE
                                                                 : NAV_TOLD_MALFORMED);
    }
    make_data(bytes, 91);
    assert_int_equal(nav_xplane_read(bytes, whole, &t), NAV_TOLD_RANGE);
    make_data(bytes, NAN);
    assert_int_equal(nav_xplane_read(bytes, whole, &t), NAV_TOLD_RANGE);
}

TEST(rpos_of_xplane_has_doubles_before_floats)
{
    uint8_t bytes[69] = "RPOS4";
    const double place[3] = {-11.123456789, 46.987654321, 3000.5};
    const double rest[10] = {1200, 2.5, 350, -20, 80, 2, -60, 0.1, -0.05, 0.025};
    struct nav_told t;
    memcpy(bytes + 5, place, sizeof place);
    for (int i = 0; i < 10; i++) {
        put_float(bytes + 29 + 4 * i, rest[i]);
    }
    assert_int_equal(nav_xplane_read(bytes, sizeof bytes, &t), NAV_TOLD_OK);
    assert_near(t.longitude_deg, place[0], 0);
    assert_near(t.latitude_deg, place[1], 0);
    assert_near(t.height_m, place[2], 0);
    assert_near(t.pitch_deg, 2.5, 0);
    assert_near(t.heading_deg, -10, 0);
    assert_near(t.roll_deg, -20, 0);
    assert_near(t.east_ms, 80, 0);
    assert_near(t.up_ms, 2, 0);
    assert_near(t.north_ms, 60, 0);
    assert_near(t.roll_rate, 5.7296, 1e-4);
    assert_near(t.pitch_rate, -2.8648, 1e-4);
    assert_near(t.yaw_rate, 1.4324, 1e-4);
    assert_int_equal(nav_xplane_read(bytes, sizeof bytes - 1, &t), NAV_TOLD_MALFORMED);
}

/* What clients of X-Plane send: 413 bytes, "RREF" and a zero, frequency, number, name. */
TEST(what_is_asked_of_xplane_is_what_its_clients_ask)
{
    uint8_t bytes[NAV_TOLD_BYTES];
    assert_int_equal(nav_xplane_ask(0, false, bytes), 8);
    assert_memory_equal(bytes,
                        "RPOS\0"
                        "60",
                        8);
    assert_int_equal(nav_xplane_ask(0, true, bytes), 7);
    assert_memory_equal(bytes,
                        "RPOS\0"
                        "0",
                        7);
    assert_int_equal(nav_xplane_ask(1, false, bytes), 413);
    assert_memory_equal(bytes, "RREF\0\x0a\0\0\0\x01\0MLsim/time/paused", 28);
    assert_int_equal(nav_xplane_ask(2, true, bytes), 413);
    assert_memory_equal(bytes, "RREF\0\0\0\0\0\x02\0MLsim/flightmodel/position/mag_psi", 40);
    assert_int_equal(nav_xplane_ask(3, false, bytes), 0);
}

static size_t make_rref(uint8_t *bytes, uint8_t which, double value)
{
    memcpy(bytes, "RREF,", 5);
    memcpy(bytes + 5, (const uint8_t[]){which, 0, 'M', 'L'}, 4);
    put_float(bytes + 9, value);
    return 13;
}

TEST(only_what_was_asked_for_is_taken_of_rref)
{
    uint8_t bytes[64];
    struct nav_told t;
    assert_int_equal(nav_xplane_read(bytes, make_rref(bytes, 1, 1), &t), NAV_TOLD_OK);
    assert_int_equal(t.paused, 1);
    assert_true(isnan(t.latitude_deg));
    assert_int_equal(nav_xplane_read(bytes, make_rref(bytes, 2, 350), &t), NAV_TOLD_OK);
    assert_near(t.magnetic_deg, -10, 0);
    assert_int_equal(nav_xplane_read(bytes, make_rref(bytes, 9, 1), &t), NAV_TOLD_FOREIGN);
    assert_int_equal(nav_xplane_read(bytes, make_rref(bytes, 2, NAN), &t), NAV_TOLD_RANGE);
    assert_int_equal(nav_xplane_read(bytes, 12, &t), NAV_TOLD_MALFORMED);
}

/* ---- the bridge ---- */

struct rig {
    struct nav_bridge *bridge;
    struct decoded_frame *frame;
    int count;
    int64_t now_us;
};

static int take_frame(void *context, const struct canas_frame *f, int64_t time_us)
{
    struct rig *r = context;
    assert_true(r->count < MOST && time_us <= r->now_us);
    assert_true(r->count == 0 || time_us > r->frame[r->count - 1].time_us);
    struct decoded_frame *d = &r->frame[r->count++];
    *d = (struct decoded_frame){.time_us = time_us, .id = f->id, .length = f->length};
    memcpy(d->data, f->data, sizeof d->data);
    return 0;
}

static struct nav_bridge_settings usual(bool is_xplane)
{
    return (struct nav_bridge_settings){
        .is_xplane = is_xplane,
        .send = {.interface = "can0", .position = NAV_POSITION_LONG, .rate_scale = 1},
        .datum = NAV_DATUM_SEA_LEVEL};
}

static void begin(struct rig *r, const struct nav_bridge_settings *settings)
{
    *r = (struct rig){.now_us = begin_us};
    r->frame = calloc(MOST, sizeof *r->frame);
    r->bridge = nav_bridge_new(settings, take_frame, r);
    assert_non_null(r->frame);
    assert_non_null(r->bridge);
}

static void end(struct rig *r)
{
    nav_bridge_free(r->bridge);
    free(r->frame);
}

/* Steps of 2 ms, as the program makes them. */
static void run_until(struct rig *r, int64_t until_us)
{
    while (r->now_us < until_us) {
        r->now_us = r->now_us + 2000 < until_us ? r->now_us + 2000 : until_us;
        assert_int_equal(nav_bridge_step(r->bridge, r->now_us), 0);
    }
}

static void tell(struct rig *r, const char *text, uint64_t sender)
{
    nav_bridge_take(r->bridge, (const uint8_t *)text, strlen(text), sender, r->now_us);
}

struct plane {
    double latitude_deg, longitude_deg, height_m;
    double heading_deg, north_ms, east_ms, down_ms, yaw_rate;
};

/* Tell where it is `elapsed_s` after the beginning: a geodesic at constant velocity. */
static void tell_plane(struct rig *r, double elapsed_s, const struct plane *p, int paused)
{
    char text[400];
    snprintf(
        text, sizeof text,
        "landmass1 %.4f,%d,%.4f,0,2026-11-23T11:04:13,%.9f,%.9f,%.3f,0,0,%.4f,%.4f,%.4f,%.4f,%.4f,"
        "0,0,%.4f\n",
        1 + (double)(r->now_us - begin_us) * 1e-6, paused, elapsed_s, p->latitude_deg,
        p->longitude_deg, p->height_m, p->heading_deg, p->heading_deg - 4, p->north_ms, p->east_ms,
        p->down_ms, p->yaw_rate);
    tell(r, text, 1);
}

static struct plane plane_at(double seconds)
{
    struct geod_geodesic earth;
    struct plane p = {.height_m = 3000 + 2 * seconds, .north_ms = 60, .east_ms = 80, .down_ms = -2};
    geod_init(&earth, 6378137, 1 / 298.257223563);
    geod_direct(&earth, 46, 11, 53.13010235415598, 100 * seconds, &p.latitude_deg, &p.longitude_deg,
                NULL);
    p.heading_deg = 50;
    return p;
}

/* Flies from `from_s` to before `until_s`, a datagram each 25 ms that comes up to 8 ms late. */
static void fly(struct rig *r, double from_s, double until_s)
{
    for (int i = 0; from_s + 0.025 * i < until_s - 1e-9; i++) {
        const double seconds = from_s + 0.025 * i;
        run_until(r, begin_us + llround(seconds * 1e6) + (i * 7 % 5) * 2000);
        const struct plane p = plane_at(seconds);
        tell_plane(r, seconds, &p, 0);
    }
    run_until(r, begin_us + llround(until_s * 1e6));
}

static int count_of(const struct rig *r, uint32_t id, int64_t from_us, int64_t until_us)
{
    int count = 0;
    for (int i = 0; i < r->count; i++) {
        count += r->frame[i].id == id && r->frame[i].time_us >= from_us &&
                 r->frame[i].time_us < until_us;
    }
    return count;
}

static double last_float(const struct rig *r, uint32_t id)
{
    double value = NAN;
    for (int i = 0; i < r->count; i++) {
        if (r->frame[i].id == id) {
            assert_true(decode_float(&r->frame[i], &value));
        }
    }
    return value;
}

static int32_t last_long(const struct rig *r, uint32_t id)
{
    int32_t value = INT32_MIN;
    for (int i = 0; i < r->count; i++) {
        if (r->frame[i].id == id) {
            assert_true(decode_long(&r->frame[i], &value));
        }
    }
    return value;
}

TEST(the_bridge_keeps_the_rates_of_a_track)
{
    struct rig r;
    const struct nav_bridge_settings s = usual(false);
    begin(&r, &s);
    fly(&r, 0, 6);
    const int64_t from = begin_us + 1000000, until = begin_us + 5000000;
    static const uint32_t fast[] = {303, 304, 305, 311, 312, 321, 1133};
    static const uint32_t slow[] = {314, 332, 1036, 1037, 1039, 1040, 1069, 1121, 1130, 1131, 1132};
    for (size_t i = 0; i < sizeof fast / sizeof *fast; i++) {
        assert_int_equal(count_of(&r, fast[i], from, until), 320);
    }
    for (size_t i = 0; i < sizeof slow / sizeof *slow; i++) {
        assert_int_equal(count_of(&r, slow[i], from, until), 40);
    }
    assert_int_equal(count_of(&r, 1200, from, until), 4);
    assert_int_equal(count_of(&r, 1038, from, until) + count_of(&r, 320, from, until), 0);
    assert_near(last_float(&r, 1039), 100, 1e-4);
    assert_near(last_float(&r, 1040), 53.1301, 1e-4);
    assert_near(last_float(&r, 1133), 50, 1e-4);
    assert_near(last_float(&r, 1069), 46, 1e-4);
    assert_near(last_float(&r, 1121), 4, 1e-4);
    assert_near(last_float(&r, 1132), 2, 1e-6);
    end(&r);
}

/* Positions lie on the geodesic of PROJ at the instant of their frame, but for the least delay that
 * datagrams had (none here), although each was up to 8 ms late: 0.8 m of flight. */
TEST(positions_are_those_of_their_instant_however_late_datagrams_come)
{
    struct rig r;
    struct geod_geodesic earth;
    int seen = 0;
    const struct nav_bridge_settings s = usual(false);
    begin(&r, &s);
    geod_init(&earth, 6378137, 1 / 298.257223563);
    fly(&r, 0, 10);
    for (int i = 0; i + 1 < r.count; i++) {
        int32_t latitude, longitude = 0;
        double off_m;
        if (r.frame[i].id != 1036 || r.frame[i].time_us < begin_us + 500000) {
            continue;
        }
        assert_true(decode_long(&r.frame[i], &latitude) && r.frame[i + 1].id == 1037 &&
                    decode_long(&r.frame[i + 1], &longitude));
        const struct plane p = plane_at((double)(r.frame[i + 1].time_us - begin_us) * 1e-6);
        geod_inverse(&earth, p.latitude_deg, p.longitude_deg, latitude * 1e-7, longitude * 1e-7,
                     &off_m, NULL, NULL);
        assert_true(off_m < 0.15); /* 1 ms for the leak of the least delay, and 1e-7 degree */
        seen++;
    }
    assert_true(seen > 90);
    end(&r);
}

TEST(attitude_turns_on_between_datagrams)
{
    struct rig r;
    const struct nav_bridge_settings s = usual(false);
    begin(&r, &s);
    for (int i = 0; i < 20; i++) {
        struct plane p = plane_at(0.1 * i);
        p.heading_deg = 10 + 3.0 * i;
        p.yaw_rate = 30;
        run_until(&r, begin_us + i * 100000);
        tell_plane(&r, 0.1 * i, &p, 0);
    }
    for (int i = 0; i < r.count; i++) {
        double heading;
        if (r.frame[i].id == 1133 && r.frame[i].time_us > begin_us + 500000) {
            assert_true(decode_float(&r.frame[i], &heading));
            assert_near(heading, 10 + 30 * (double)(r.frame[i].time_us - begin_us) * 1e-6, 0.3);
        }
    }
    end(&r);
}

TEST(without_datagrams_the_bus_falls_silent_and_comes_back)
{
    struct rig r;
    const struct nav_bridge_settings s = usual(false);
    begin(&r, &s);
    run_until(&r, begin_us + 500000);
    assert_int_equal(nav_bridge_mood(r.bridge), NAV_BRIDGE_WAITING);
    assert_int_equal(r.count, 0);
    fly(&r, 0.5, 2);
    assert_int_equal(nav_bridge_mood(r.bridge), NAV_BRIDGE_FLYING);
    run_until(&r, begin_us + 5000000);
    assert_int_equal(nav_bridge_mood(r.bridge), NAV_BRIDGE_SILENT);
    assert_true(r.frame[r.count - 1].time_us < begin_us + 2000000 + 250000 + 2 * TICK_US);
    assert_true(r.frame[r.count - 1].time_us > begin_us + 2000000);
    const int before = r.count;
    fly(&r, 5, 6);
    assert_int_equal(nav_bridge_mood(r.bridge), NAV_BRIDGE_FLYING);
    assert_true(r.count > before + 600);
    assert_int_equal(nav_bridge_counts(r.bridge)->silences, 1);
    assert_near(nav_bridge_counts(r.bridge)->longest_wait_s, 3.02, 0.05);
    end(&r);
}

/* One datagram over and over, as a receiver's neighbour that is stuck would send it. */
TEST(a_repeated_datagram_keeps_nothing_alive)
{
    struct rig r;
    const struct nav_bridge_settings s = usual(false);
    begin(&r, &s);
    fly(&r, 0, 1);
    for (int i = 0; i < 100; i++) {
        tell(&r, "landmass1 1.9,0,0.9,0,x,46,11,3000,0,0,50,46,60,80,-2,0,0,0\n", 1);
        run_until(&r, r.now_us + 10000);
    }
    assert_int_equal(nav_bridge_mood(r.bridge), NAV_BRIDGE_SILENT);
    assert_int_equal(nav_bridge_counts(r.bridge)->disordered, 100);
    end(&r);
}

TEST(in_a_pause_the_aircraft_stands_and_so_does_the_exercise)
{
    struct rig r;
    struct nav_bridge_settings s = usual(false);
    s.send.exercise = (struct nav_exercise){.has_clock = true, .start_s = 100};
    begin(&r, &s);
    fly(&r, 0, 2);
    assert_near(last_float(&r, 1821), 1, 0);
    const struct plane p = plane_at(2);
    for (int i = 0; i < 120; i++) {
        run_until(&r, begin_us + 2000000 + i * 25000);
        tell_plane(&r, 2, &p, 1);
    }
    assert_int_equal(nav_bridge_mood(r.bridge), NAV_BRIDGE_PAUSED);
    assert_near(last_float(&r, 1039), 0, 0);
    assert_near(last_float(&r, 1130), 0, 0);
    assert_near(last_float(&r, 1132), 0, 0);
    assert_near(last_float(&r, 1040), 53.1301, 1e-4);
    assert_near(last_float(&r, 1821), 0, 0);
    assert_near(last_long(&r, 1036) * 1e-7, p.latitude_deg, 1e-7);
    assert_near(last_long(&r, 1037) * 1e-7, p.longitude_deg, 1e-7);
    assert_near(last_long(&r, 1820), 102000, 30);
    for (int i = 0; i < 80; i++) {
        run_until(&r, begin_us + 5000000 + i * 25000);
        const struct plane on = plane_at(2 + 0.025 * i);
        tell_plane(&r, 2 + 0.025 * i, &on, 0);
    }
    assert_int_equal(nav_bridge_mood(r.bridge), NAV_BRIDGE_FLYING);
    assert_near(last_float(&r, 1821), 1, 0);
    assert_near(last_float(&r, 1039), 100, 1e-4);
    assert_true(last_long(&r, 1820) > 102900 && last_long(&r, 1820) < 104000);
    assert_int_equal(nav_bridge_counts(r.bridge)->pauses, 1);
    assert_int_equal(nav_bridge_counts(r.bridge)->silences, 0);
    end(&r);
}

static void tell_xplane(struct rig *r, double latitude_deg)
{
    uint8_t bytes[512];
    nav_bridge_take(r->bridge, bytes, make_data(bytes, latitude_deg), 7, r->now_us);
}

TEST(numbers_that_stand_in_flight_are_a_pause_of_xplane)
{
    struct rig r;
    const struct nav_bridge_settings s = usual(true);
    begin(&r, &s);
    for (int i = 0; i < 100; i++) {
        run_until(&r, begin_us + i * 20000);
        tell_xplane(&r, i < 40 ? 46 + i * 1e-5 : 46.0005);
    }
    assert_int_equal(nav_bridge_mood(r.bridge), NAV_BRIDGE_PAUSED);
    assert_near(last_float(&r, 1039), 0, 0);
    run_until(&r, r.now_us + 20000);
    tell_xplane(&r, 46.001);
    assert_int_equal(nav_bridge_mood(r.bridge), NAV_BRIDGE_FLYING);
    end(&r);
}

TEST(rref_of_xplane_tells_of_the_pause_and_of_magnetic_north)
{
    struct rig r;
    uint8_t bytes[64];
    const struct nav_bridge_settings s = usual(true);
    begin(&r, &s);
    tell_xplane(&r, 46);
    nav_bridge_take(r.bridge, bytes, make_rref(bytes, 2, 20), 7, r.now_us);
    nav_bridge_take(r.bridge, bytes, make_rref(bytes, 1, 1), 7, r.now_us);
    run_until(&r, r.now_us + 200000);
    assert_int_equal(nav_bridge_mood(r.bridge), NAV_BRIDGE_PAUSED);
    assert_near(last_float(&r, 1069), 20, 1e-4);
    assert_near(last_float(&r, 1121), 5.4843, 1e-4);
    /* It is no sign of life: without a position the bus falls silent. */
    for (int i = 0; i < 50; i++) {
        nav_bridge_take(r.bridge, bytes, make_rref(bytes, 1, 0), 7, r.now_us);
        run_until(&r, r.now_us + 10000);
    }
    assert_int_equal(nav_bridge_mood(r.bridge), NAV_BRIDGE_SILENT);
    end(&r);
}

TEST(while_one_sender_is_heard_no_other_is)
{
    struct rig r;
    const struct nav_bridge_settings s = usual(false);
    const char other[] = "landmass1 1,0,1,0,x,10,20,3000,0,0,50,46,60,80,-2,0,0,0\n";
    begin(&r, &s);
    fly(&r, 0, 1);
    tell(&r, other, 2);
    fly(&r, 1, 2);
    assert_int_equal(nav_bridge_counts(r.bridge)->other_sender, 1);
    assert_true(last_long(&r, 1036) > 450000000);
    run_until(&r, begin_us + 4900000);
    tell(&r, other, 2);
    assert_int_equal(nav_bridge_counts(r.bridge)->other_sender, 2);
    run_until(&r, begin_us + 5100000);
    tell(&r, other, 2);
    run_until(&r, begin_us + 5300000);
    assert_int_equal(nav_bridge_counts(r.bridge)->senders, 2);
    assert_true(last_long(&r, 1036) < 110000000);
    end(&r);
}

/* ---- a recording ---- */

struct recorded {
    int64_t time_us;
    char text[400];
    struct nav_told told;
};

static int read_recording(struct recorded *rows, int most)
{
    FILE *in = fopen("tests/unit/host-sim/nav/flightgear.txt", "r");
    char row[500];
    int count = 0;
    assert_non_null(in);
    while (fgets(row, sizeof row, in) && count < most) {
        double seconds;
        int skipped;
        if (row[0] == '#') {
            continue;
        }
        assert_int_equal(sscanf(row, "%lf %n", &seconds, &skipped), 1);
        rows[count].time_us = begin_us + llround(seconds * 1e6);
        snprintf(rows[count].text, sizeof rows[count].text, "%s", row + skipped);
        assert_int_equal(read_line(rows[count].text, &rows[count].told), NAV_TOLD_OK);
        count++;
    }
    fclose(in);
    return count;
}

static double between(double a, double b, double share)
{
    return a + (b - a) * share;
}

/* Direction and speed over ground that FlightGear tells are those of PROJ's geodesic between the
 * places that it tells, and so are climb and rates: signs and units of the protocol are right. */
TEST(what_flightgear_tells_of_motion_agrees_with_its_places)
{
    static struct recorded rows[400];
    struct geod_geodesic earth;
    int seen = 0;
    const int count = read_recording(rows, 400);
    geod_init(&earth, 6378137, 1 / 298.257223563);
    for (int i = 0; i + 8 < count; i++) {
        const struct nav_told *a = &rows[i].told, *m = &rows[i + 4].told, *b = &rows[i + 8].told;
        const double dt = b->elapsed_s - a->elapsed_s;
        double way_m, bearing_deg;
        if (a->paused || m->paused || b->paused || dt < 0.1 || i == 0) {
            continue;
        }
        geod_inverse(&earth, a->latitude_deg, a->longitude_deg, b->latitude_deg, b->longitude_deg,
                     &way_m, &bearing_deg, NULL);
        assert_near(way_m / dt, hypot(m->north_ms, m->east_ms), 1);
        assert_near(nav_wrap_180(bearing_deg - atan2(m->east_ms, m->north_ms) * 57.29578), 0, 2);
        assert_near((b->height_m - a->height_m) / dt, m->up_ms, 0.25);
        const double roll = m->roll_deg / 57.29578, pitch = m->pitch_deg / 57.29578;
        const double turn = (m->pitch_rate * sin(roll) + m->yaw_rate * cos(roll)) / cos(pitch);
        assert_near(nav_wrap_180(b->heading_deg - a->heading_deg) / dt, turn, 0.5);
        assert_near((b->pitch_deg - a->pitch_deg) / dt,
                    m->pitch_rate * cos(roll) - m->yaw_rate * sin(roll), 0.25);
        assert_near(nav_wrap_180(m->heading_deg - m->magnetic_deg), 5.08, 0.02);
        seen++;
    }
    assert_true(seen > 20);
}

/* The frames of a recorded flight, each at its instant, lie between the places told before and
 * after: within the metre that datagrams were late. In the pause it stands. */
TEST(the_bus_follows_a_recorded_flight_and_its_pause)
{
    static struct recorded rows[400];
    struct rig r;
    int seen = 0, row = 0;
    const struct nav_bridge_settings s = usual(false);
    const int count = read_recording(rows, 400);
    begin(&r, &s);
    for (int i = 0; i < count; i++) {
        run_until(&r, rows[i].time_us);
        tell(&r, rows[i].text, 1);
    }
    for (int i = 0; i + 1 < r.count; i++) {
        int32_t latitude;
        if (r.frame[i].id != 1036 || r.frame[i].time_us < begin_us + 500000) {
            continue;
        }
        while (row + 2 < count && rows[row + 1].time_us <= r.frame[i].time_us) {
            row++;
        }
        const struct recorded *a = &rows[row], *b = &rows[row + 1];
        const double share =
            (double)(r.frame[i].time_us - a->time_us) / (double)(b->time_us - a->time_us);
        assert_true(decode_long(&r.frame[i], &latitude));
        assert_near(latitude * 1e-7, between(a->told.latitude_deg, b->told.latitude_deg, share),
                    4e-5);
        seen++;
    }
    assert_true(seen > 30);
    const struct nav_bridge_counts *n = nav_bridge_counts(r.bridge);
    assert_int_equal(n->used, count);
    assert_int_equal(n->pauses, 1);
    assert_int_equal(n->silences, 0);
    assert_int_equal(n->disordered + n->other_sender, 0);
    end(&r);
}
