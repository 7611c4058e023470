/* The log as a display would receive it: rates, order, sequence, and values true to the track. */
#include "check.h"
#include "decode.h"
#include "nav/read_track.h"
#include "nav/send.h"
#include "support.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const double degree = 3.14159265358979323846 / 180.0;

struct flight {
    struct nav_track track;
    struct nav_findings found;
    struct decoded_log log;
    struct nav_sent sent;
};

static void send_track(struct flight *f, const struct nav_send_options *options)
{
    FILE *file = tmpfile();
    assert_non_null(file);
    nav_track_complete(&f->track, &(struct nav_limits){0, 411}, &f->found);
    assert_int_equal(nav_send(&f->track, options, file, &f->sent), 0);
    rewind(file);
    assert_true(decode_log(file, &f->log));
    fclose(file);
    assert_int_equal(f->log.count, f->sent.frames);
}

static void forget(struct flight *f)
{
    nav_track_free(&f->track);
    decode_free(&f->log);
}

static const struct nav_send_options usual = {
    .interface = "can0", .position = NAV_POSITION_DOUBLE, .rate_scale = 1, .until_us = INT64_MAX};

/* Twenty seconds of a flight that turns, climbs and rolls, a fix each second on odd milliseconds.
 */
static void make_flight(struct flight *f)
{
    *f = (struct flight){0};
    for (int i = 0; i <= 20; i++) {
        struct nav_fix x = nav_fix_blank();
        x.time_us = INT64_C(1700000000000000) + i * 1000000 + 3000;
        x.latitude_deg = 42 + 0.0011 * i;
        x.longitude_deg = -29 + 0.0013 * i + 0.00002 * i * i;
        x.height_m = 2000 + 7.5 * i;
        x.speed_ms = 150 + i;
        x.track_deg = 40 + 2 * i;
        x.climb_ms = 7.5;
        x.heading_deg = 38 + 2 * i;
        x.pitch_deg = 3 + 0.1 * i;
        x.roll_deg = -10 + i;
        assert_int_equal(nav_track_add(&f->track, &x), 0);
    }
}

static int count_id(const struct decoded_log *log, uint32_t id)
{
    int n = 0;
    for (int i = 0; i < log->count; i++) {
        n += log->frame[i].id == id;
    }
    return n;
}

TEST(rates_are_those_of_the_specification)
{
    static const struct {
        uint32_t id;
        int per_second, frames;
        uint8_t node;
    } wanted[] = {{303, 80, 1, 1},  {304, 80, 1, 1},  {305, 80, 1, 1},  {311, 80, 1, 1},
                  {312, 80, 1, 1},  {321, 80, 1, 1},  {1133, 80, 1, 1}, {314, 10, 1, 9},
                  {1036, 10, 2, 9}, {1037, 10, 2, 9}, {1038, 10, 1, 9}, {1039, 10, 1, 9},
                  {1040, 10, 1, 9}, {1130, 10, 1, 9}, {1131, 10, 1, 9}, {1132, 10, 1, 9},
                  {1200, 1, 1, 9},  {1206, 1, 1, 9}};
    struct flight f;
    make_flight(&f);
    struct nav_send_options cut = usual;
    cut.from_us = INT64_C(1700000005000000);
    cut.until_us = INT64_C(1700000015000000);
    send_track(&f, &cut);
    int sum = 0;
    for (size_t i = 0; i < sizeof wanted / sizeof *wanted; i++) {
        const int n = count_id(&f.log, wanted[i].id);
        assert_int_equal(n, 10 * wanted[i].per_second * wanted[i].frames);
        sum += n;
    }
    assert_int_equal(sum, f.log.count);
    for (int i = 0; i < f.log.count; i++) {
        const struct decoded_frame *x = &f.log.frame[i];
        for (size_t k = 0; k < sizeof wanted / sizeof *wanted; k++) {
            assert_true(x->id != wanted[k].id || x->data[0] == wanted[k].node);
        }
        assert_true(x->time_us >= cut.from_us && x->time_us < cut.until_us + 2500);
    }
    assert_true(fabs(f.sent.active_s - 10) < 1e-9);
    forget(&f);
}

TEST(heights_go_out_under_the_identifier_of_what_they_are_measured_from)
{
    static const uint32_t ids[] = {
        [NAV_DATUM_ELLIPSOID] = 1038, [NAV_DATUM_SEA_LEVEL] = 332, [NAV_DATUM_BAROMETRIC] = 320};
    for (int datum = NAV_DATUM_ELLIPSOID; datum <= NAV_DATUM_BAROMETRIC; datum++) {
        struct flight f;
        make_flight(&f);
        f.track.datum = (enum nav_datum)datum;
        struct nav_send_options cut = usual;
        cut.from_us = INT64_C(1700000005000000);
        cut.until_us = INT64_C(1700000006000000);
        send_track(&f, &cut);
        for (int i = 0; i < 3; i++) {
            assert_int_equal(count_id(&f.log, ids[i]), i == datum ? 10 : 0);
        }
        forget(&f);
    }
}

TEST(time_codes_and_intervals_run_without_a_break)
{
    struct flight f;
    make_flight(&f);
    send_track(&f, &usual);
    int64_t last_time[2048] = {0};
    int next_code[2048] = {0};
    for (int i = 0; i < f.log.count; i++) {
        const struct decoded_frame *x = &f.log.frame[i];
        assert_false(x->is_extended);
        assert_string_equal(x->interface, "can0");
        assert_true(i == 0 || x->time_us >= x[-1].time_us + 125);
        assert_int_equal(x->data[2], 0);
        assert_int_equal(x->data[3], next_code[x->id] % 256);
        next_code[x->id]++;
        if (last_time[x->id] != 0 && x->id < 314) {
            assert_in_range(x->time_us - last_time[x->id], 12500, 12500);
        }
        last_time[x->id] = x->time_us;
    }
    forget(&f);
}

TEST(a_rate_scale_changes_every_rate)
{
    struct flight f;
    make_flight(&f);
    struct nav_send_options scaled = usual;
    scaled.from_us = INT64_C(1700000005000000);
    scaled.until_us = INT64_C(1700000013000000);
    scaled.rate_scale = 2.5;
    send_track(&f, &scaled);
    assert_int_equal(count_id(&f.log, 311), 8 * 200);
    assert_int_equal(count_id(&f.log, 1036), 8 * 25 * 2);
    decode_free(&f.log);
    scaled.rate_scale = 0.25;
    send_track(&f, &scaled);
    assert_int_equal(count_id(&f.log, 311), 8 * 20);
    assert_int_equal(count_id(&f.log, 1036), 8 * 5);
    forget(&f);
}

/* Rain from 2 s to 6 s, a jammer all along, and everything cleared at 10 s. */
TEST(weather_is_told_once_a_second_in_whole_sets)
{
    const double rain[] = {46, 11, 5000, 30, 2, 6}, jammer[] = {46.5, 11.5, 25};
    for (double scale = 0.25; scale <= 4; scale *= 4) {
        struct flight f;
        make_flight(&f);
        struct nav_send_options options = usual;
        options.rate_scale = scale;
        assert_true(nav_weather_add(&options.weather, false, rain, 6));
        assert_true(nav_weather_add(&options.weather, false, rain, 6));
        assert_true(nav_weather_add(&options.weather, true, jammer, 3));
        options.weather.has_clear = true;
        options.weather.clear_s = 10;
        send_track(&f, &options);
        assert_int_equal(count_id(&f.log, 1807), 1);
        for (uint32_t id = 1800; id < 1807; id++) {
            assert_int_equal(count_id(&f.log, id), id < 1804 ? 2 * 4 : 20);
        }
        for (int i = 0; i < f.log.count; i++) {
            const struct decoded_frame *x = &f.log.frame[i];
            double value;
            assert_true(i == 0 || x->time_us > x[-1].time_us);
            if (x->id >= 1800 && x->id < 1807) {
                const uint32_t part = x->id < 1804 ? x->id - 1800 : x->id - 1804;
                assert_true(decode_float(x, &value));
                assert_int_equal(value * 10, (x->id < 1804 ? rain : jammer)[part] * 10);
                /* Beside the others of its set. */
                assert_int_equal(x->data[2], (x - part)->data[2]);
                assert_int_equal(x->data[3], (x - part)->data[3]);
                assert_int_equal((x - part)->id, x->id - part);
            }
        }
        forget(&f);
    }
}

/* From 100 s on, twice as fast from 3 s, standing from 7.3 s: each time is that of its frame. */
TEST(the_exercise_clock_is_told_once_a_second_and_when_its_rate_changes)
{
    const double rates[][2] = {{2, 3}, {0, 7.3}};
    for (double scale = 0.25; scale <= 4; scale *= 4) {
        struct flight f;
        make_flight(&f);
        struct nav_send_options options = usual;
        options.rate_scale = scale;
        options.exercise.has_clock = options.exercise.has_seed = true;
        options.exercise.start_s = 100;
        options.exercise.seed = 4711;
        assert_true(nav_exercise_add_rate(&options.exercise, rates[0], 2));
        assert_false(nav_exercise_add_rate(&options.exercise, rates[0], 2)); /* not after it */
        assert_true(nav_exercise_add_rate(&options.exercise, rates[1], 2));
        send_track(&f, &options);
        assert_in_range(count_id(&f.log, 1820), 20, 22);
        assert_int_equal(count_id(&f.log, 1821), count_id(&f.log, 1820));
        assert_int_equal(count_id(&f.log, 1822), count_id(&f.log, 1820));
        const double first_s = (double)f.track.fix[0].time_us * 1e-6;
        for (int i = 0; i < f.log.count; i++) {
            const struct decoded_frame *x = &f.log.frame[i];
            if (x->id == 1820) {
                const double t = (double)x->time_us * 1e-6 - first_s;
                const double wanted = t < 3 ? 100 + t : t < 7.3 ? 103 + 2 * (t - 3) : 111.6;
                const int32_t ms =
                    x->data[4] << 24 | x->data[5] << 16 | x->data[6] << 8 | x->data[7];
                assert_true(fabs(ms - wanted * 1000) < 1.5);
                double rate;
                assert_true(decode_float(x - 2, &rate)); /* rate, seed, time */
                assert_true(rate == (t < 3 ? 1 : t < 7.3 ? 2 : 0));
                assert_int_equal(x[-1].data[6] << 8 | x[-1].data[7], 4711);
            }
        }
        forget(&f);
    }
}

/* The number of a kind's first frame and of its last one, by type, and how many there are. */
struct told {
    int set, cleared;
    double first_s, last_s, clear_s, value;
};

static struct told told_of(const struct flight *f, int number)
{
    struct told t = {.first_s = -1};
    const double zero_s = (double)f->track.fix[0].time_us * 1e-6;
    for (int i = 0; i < f->log.count; i++) {
        const struct decoded_frame *x = &f->log.frame[i];
        const double at_s = (double)x->time_us * 1e-6 - zero_s;
        if (x->id == 1825 && x->data[2] == number) {
            assert_int_equal(x->data[0], 30);
            assert_true(decode_float(x, &t.value));
            t.first_s = t.set++ == 0 ? at_s : t.first_s;
            t.last_s = at_s;
        } else if (x->id == 1826 && x->data[4] == number) {
            assert_int_equal(x->data[0], 30);
            assert_int_equal(x->data[1], 10); /* UCHAR */
            t.clear_s = at_s;
            t.cleared++;
        }
    }
    return t;
}

/* By docs/bus.md, "Malfunctions": the number is the service code, each once a second, and cleared
 * by one frame. The beginning is told at once, although seconds of today, as a double holds them,
 * are not exact. */
TEST(malfunctions_are_told_once_a_second_and_then_cleared)
{
    const char *const words[] = {"weak-transmit=20.5@3.4,7.4", "lost-sector=-30,10@5,9",
                                 "antenna-drift=-60@10", "no-transmit", "dead-key=28@2,3"};
    struct flight f;
    make_flight(&f);
    struct nav_send_options options = usual;
    for (size_t i = 0; i < sizeof words / sizeof *words; i++) {
        assert_null(nav_exercise_add_malfunction(&options.exercise, words[i]));
    }
    send_track(&f, &options);
    struct told t = told_of(&f, 1);
    assert_true(fabs(t.first_s - 3.41) < 0.03 && t.value == 20.5);
    assert_int_equal(t.set, 5); /* at 3.4, 4, 5, 6 and 7 s */
    assert_int_equal(t.cleared, 1);
    assert_true(fabs(t.clear_s - 7.41) < 0.03);
    t = told_of(&f, 5);
    assert_true(t.set >= 4 && t.set <= 5 && t.cleared == 1 && t.value == -30);
    assert_true(t.first_s > 4.98 && t.last_s < 9);
    t = told_of(&f, 6);
    assert_true(t.set >= 4 && t.set <= 5 && t.cleared == 1 && t.value == 10);
    t = told_of(&f, 4); /* it grows by a degree a second */
    assert_true(t.cleared == 0 && fabs(t.value + (t.last_s - 10)) < 0.05);
    t = told_of(&f, 0);
    assert_true(t.set >= 20 && t.set <= 22 && t.cleared == 0 && t.value == 0);
    t = told_of(&f, 9);
    assert_true(t.set >= 1 && t.cleared == 1 && t.value == 28);
    assert_int_equal(told_of(&f, 2).set + told_of(&f, 3).set + told_of(&f, 7).set, 0);
    forget(&f);
}

TEST(malfunctions_that_no_set_has_are_not_taken)
{
    static const char *const bad[] = {"",
                                      "heart",
                                      "noise",
                                      "noise=",
                                      "noise=-1",
                                      "noise=61",
                                      "noise=6,6",
                                      "noise=nan",
                                      "noise=6@",
                                      "noise=6@-1",
                                      "noise=6@x",
                                      "noise=6@5,5",
                                      "no-transmit=1",
                                      "tilt=31",
                                      "dead-key=0",
                                      "dead-key=29",
                                      "lost-sector=1",
                                      "lost-sector=2,1",
                                      "antenna-drift=61"};
    struct nav_exercise x = {0};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        if (!nav_exercise_add_malfunction(&x, bad[i])) {
            fail_msg("taken: %s", bad[i]);
        }
    }
    assert_int_equal(x.malfunction_count, 0);
    for (int i = 0; i <= NAV_MALFUNCTIONS; i++) {
        assert_int_equal(nav_exercise_add_malfunction(&x, "noise=6") == NULL, i < NAV_MALFUNCTIONS);
    }
}

TEST(weather_out_of_range_is_not_taken)
{
    static const double bad[][6] = {
        {91, 0, 5000, 30, 0, 9}, {0, 181, 5000, 30, 0, 9}, {0, 0, 99, 30, 0, 9},
        {0, 0, 5000, 0, 0, 9},   {0, 0, 5000, 151, 0, 9},  {0, 0, 5000, 30, -1, 9},
        {0, 0, 5000, 30, 9, 9},  {0, 0, 100001, 30, 0, 9},
    };
    struct nav_weather w = {0};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        assert_false(nav_weather_add(&w, false, bad[i], 6));
    }
    const double jammer[] = {0, 0, 81}, rain[] = {0, 0, 5000, 30};
    assert_false(nav_weather_add(&w, true, jammer, 3));
    assert_false(nav_weather_add(&w, false, rain, 3));
    assert_false(nav_weather_add(&w, false, rain, -1));
    for (int i = 0; i < 5; i++) {
        assert_int_equal(nav_weather_add(&w, false, rain, 4), i < 4);
    }
}

/* Where the aircraft is at an instant: the fixes on both sides and PROJ's geodesic between them. */
static void place_at(const struct nav_track *t, int64_t time_us, double *latitude,
                     double *longitude)
{
    struct geod_geodesic earth;
    double distance, azimuth, unused;
    size_t i = 0;
    geod_init(&earth, 6378137.0, 1 / 298.257223563);
    while (i + 2 < t->count && t->fix[i + 1].time_us <= time_us) {
        i++;
    }
    const struct nav_fix *a = &t->fix[i], *b = a + 1;
    const double share =
        fmin(1, (double)(time_us - a->time_us) / (double)(b->time_us - a->time_us));
    geod_inverse(&earth, a->latitude_deg, a->longitude_deg, b->latitude_deg, b->longitude_deg,
                 &distance, &azimuth, &unused);
    geod_direct(&earth, a->latitude_deg, a->longitude_deg, azimuth, share * distance, latitude,
                longitude, &unused);
}

TEST(pairs_are_adjacent_and_true_to_a_tenth_of_a_millimetre)
{
    struct flight f;
    make_flight(&f);
    send_track(&f, &usual);
    int pairs = 0;
    for (int i = 0; i + 3 < f.log.count; i++) {
        const struct decoded_frame *x = &f.log.frame[i];
        double latitude, longitude, wanted_latitude, wanted_longitude;
        if (x->id != 1036 || x->data[1] != 30) {
            continue;
        }
        assert_true(decode_pair(x, x + 1, &latitude));
        assert_int_equal(x[2].id, 1037);
        assert_true(decode_pair(x + 2, x + 3, &longitude));
        assert_true(x[3].time_us - x->time_us == 375);
        place_at(&f.track, x[3].time_us, &wanted_latitude, &wanted_longitude);
        assert_true(fabs(latitude - wanted_latitude) < 1e-9);
        assert_true(fabs(longitude - wanted_longitude) < 1e-9);
        pairs++;
    }
    assert_in_range(pairs, 199, 201);
    forget(&f);
}

/* Every other value, at the time its own frame was sent, to the precision of FLOAT. */
TEST(values_are_those_of_the_track_when_each_frame_is_sent)
{
    struct flight f;
    make_flight(&f);
    send_track(&f, &usual);
    int checked = 0;
    for (int i = 0; i < f.log.count; i++) {
        const struct decoded_frame *x = &f.log.frame[i];
        const double s = fmin(20, (double)(x->time_us - f.track.fix[0].time_us) * 1e-6);
        const double speed = 150 + s, track = 40 + 2 * s;
        const double wanted = x->id == 311    ? 3 + 0.1 * s
                              : x->id == 312  ? -10 + s
                              : x->id == 314  ? 7.5
                              : x->id == 321  ? 38 + 2 * s
                              : x->id == 1133 ? 38 + 2 * s
                              : x->id == 1038 ? 2000 + 7.5 * s
                              : x->id == 1039 ? speed
                              : x->id == 1040 ? track
                              : x->id == 1130 ? speed * sin(track * degree)
                              : x->id == 1131 ? speed * cos(track * degree)
                              : x->id == 1132 ? 7.5
                                              : NAN;
        double value;
        if (isnan(wanted)) {
            continue;
        }
        assert_true(decode_float(x, &value));
        /* The height belongs to the instant of the position, one frame before. */
        const double tolerance = x->id == 1038 ? 7.5 * 125e-6 + 1.3e-4 : 1e-4;
        assert_true(fabs(value - wanted) <= tolerance);
        checked++;
    }
    assert_true(checked > 7000);
    forget(&f);
}

TEST(float_and_long_positions_are_true_to_their_precision)
{
    for (int kind = NAV_POSITION_FLOAT; kind <= NAV_POSITION_LONG; kind++) {
        struct flight f;
        make_flight(&f);
        struct nav_send_options options = usual;
        options.position = (enum nav_position)kind;
        send_track(&f, &options);
        int checked = 0;
        for (int i = 0; i + 1 < f.log.count; i++) {
            const struct decoded_frame *x = &f.log.frame[i];
            if (x->id != 1036) {
                continue;
            }
            double value[2], wanted[2];
            int32_t count;
            for (int k = 0; k < 2; k++) {
                if (kind == NAV_POSITION_FLOAT) {
                    assert_true(decode_float(x + k, &value[k]));
                } else {
                    assert_true(decode_long(x + k, &count));
                    value[k] = count * 1e-7;
                }
            }
            assert_int_equal(x[1].id, 1037);
            place_at(&f.track, x[1].time_us, &wanted[0], &wanted[1]);
            /* Half a step: 2^-19 degree of a FLOAT from 32 to 64, 2^-20 from 16 to 32. */
            assert_true(fabs(value[0] - wanted[0]) <=
                        (kind == NAV_POSITION_FLOAT ? 0x1p-19 : 0.51e-7));
            assert_true(fabs(value[1] - wanted[1]) <=
                        (kind == NAV_POSITION_FLOAT ? 0x1p-20 : 0.51e-7));
            checked++;
        }
        assert_in_range(checked, 199, 201);
        forget(&f);
    }
}

/* 1700000000 is 2023-11-14T22:13:20Z. */
TEST(clock_and_date_are_sent_on_the_second)
{
    struct flight f;
    make_flight(&f);
    send_track(&f, &usual);
    int second = 21, checked = 0;
    for (int i = 0; i < f.log.count; i++) {
        const struct decoded_frame *x = &f.log.frame[i];
        if (x->id == 1200) {
            const uint8_t wanted[4] = {22, 13, (uint8_t)second++, 0};
            assert_int_equal(x->data[1], 15);
            assert_memory_equal(x->data + 4, wanted, 4);
            assert_true(x->time_us % 1000000 < 2500);
            checked++;
        } else if (x->id == 1206) {
            const uint8_t wanted[4] = {14, 11, 20, 23};
            assert_int_equal(x->data[1], 15);
            assert_memory_equal(x->data + 4, wanted, 4);
        }
    }
    assert_int_equal(checked, 20);
    forget(&f);
}

TEST(the_bus_is_silent_in_a_gap_and_true_on_both_sides)
{
    struct flight f;
    make_flight(&f);
    for (size_t i = 11; i < f.track.count; i++) {
        f.track.fix[i].time_us += 40 * 1000000;
    }
    send_track(&f, &usual);
    assert_int_equal(f.found.gaps, 1);
    const int64_t from = f.track.fix[10].time_us, until = f.track.fix[11].time_us;
    int before = 0, after = 0;
    for (int i = 0; i < f.log.count; i++) {
        const int64_t at = f.log.frame[i].time_us;
        assert_true(at <= from + 2500 || at >= until);
        before += at <= from + 2500;
        after += at >= until;
    }
    assert_true(before > 6000 && after > 5500);
    forget(&f);
}

static int load(struct flight *f, const char *name)
{
    char path[512];
    struct nav_reading r = {0};
    *f = (struct flight){0};
    if (!support_data_path(name, path, sizeof path)) {
        return -1;
    }
    return nav_read_track(path, NAV_FORMAT_BY_NAME, &f->track, &r);
}

/* The real flight with its hold-then-jump blemishes, about ten minutes of it with 60 s cut out:
 * every position sent lies on the way between its fixes, or, where that way is a jump, on the fix
 * before it. */
TEST(the_real_flight_is_sent_with_its_blemishes)
{
    struct flight f;
    if (load(&f, "nav_tracks/zero_gravity.csv.gz") != 0) {
        skip();
        return; /* skip() does not come back, but its declaration does not say so */
    }
    const size_t first = 4000, count = 600, hole = 60;
    memmove(f.track.fix, f.track.fix + first, count * sizeof *f.track.fix);
    memmove(f.track.fix + 300, f.track.fix + 300 + hole,
            (count - 300 - hole) * sizeof *f.track.fix);
    f.track.count = count - hole;
    send_track(&f, &usual);
    assert_int_equal(f.found.gaps, 1);
    int checked = 0, at_jumps = 0;
    size_t k = 0;
    for (int i = 0; i + 3 < f.log.count; i++) {
        const struct decoded_frame *x = &f.log.frame[i];
        double latitude, longitude, wanted_latitude, wanted_longitude;
        if (x->id != 1036 || !decode_pair(x, x + 1, &latitude) ||
            !decode_pair(x + 2, x + 3, &longitude)) {
            continue;
        }
        while (k + 1 < f.track.count && f.track.fix[k + 1].time_us <= x[3].time_us) {
            k++;
        }
        const struct nav_fix *a = &f.track.fix[k], *b = a + 1;
        place_at(&f.track, x[3].time_us, &wanted_latitude, &wanted_longitude);
        double metres;
        struct geod_geodesic earth;
        geod_init(&earth, 6378137.0, 1 / 298.257223563);
        if (k + 1 < f.track.count) {
            geod_inverse(&earth, a->latitude_deg, a->longitude_deg, b->latitude_deg,
                         b->longitude_deg, &metres, NULL, NULL);
            if (metres > 411 || b->time_us - a->time_us > 1500000) {
                wanted_latitude = a->latitude_deg;
                wanted_longitude = a->longitude_deg;
                at_jumps++;
            }
        }
        assert_true(fabs(latitude - wanted_latitude) < 1e-9);
        assert_true(fabs(longitude - wanted_longitude) < 1e-9);
        checked++;
    }
    assert_true(checked > 5300);
    assert_int_equal(at_jumps >= 10 * (int)f.found.jumps, 1);
    const int64_t from = f.track.fix[299].time_us, until = f.track.fix[300].time_us;
    assert_true(until - from == 61 * 1000000);
    for (int i = 0; i < f.log.count; i++) {
        const int64_t at = f.log.frame[i].time_us;
        assert_true(at <= from + 2500 || at >= until);
    }
    forget(&f);
}

TEST(the_real_calibration_flight_is_banked_where_it_turns)
{
    struct flight f;
    if (load(&f, "nav_tracks/nice.csv.gz") != 0) {
        skip();
        return;
    }
    struct nav_send_options cut = usual;
    cut.until_us = f.track.fix[0].time_us + 600 * INT64_C(1000000);
    send_track(&f, &cut);
    double least = 0, most = 0, value;
    for (int i = 0; i < f.log.count; i++) {
        if (f.log.frame[i].id == 312 && decode_float(&f.log.frame[i], &value)) {
            least = fmin(least, value);
            most = fmax(most, value);
        }
    }
    assert_true(least > -60 && most < 60 && most - least > 10);
    forget(&f);
}

TEST(the_program_writes_whole_files_or_none)
{
    const char *b = support_build_dir();
    char log[300];
    snprintf(log, sizeof log, "%s/tmp/nav.log", b);
    support_run("mkdir -p %s/tmp; rm -f %s", b, log);
    assert_int_equal(support_run("%s/bin/landmass-nav --circle 42,-29,5000,3000,150 --seconds 2 "
                                 "--out %s --iface vcan7 --quiet",
                                 b, log),
                     0);
    FILE *in = fopen(log, "r");
    struct decoded_log read;
    assert_non_null(in);
    assert_true(decode_log(in, &read));
    fclose(in);
    assert_int_equal(read.count, 2 * 672);
    assert_string_equal(read.frame[0].interface, "vcan7");
    assert_true(read.frame[0].time_us == INT64_C(946728000000000));
    decode_free(&read);
    unlink(log);
    assert_int_equal(
        support_run("printf 'time,lat,lon\\n1,43,7\\n99,43,7\\n' | %s/bin/landmass-nav "
                    "--format csv --out %s --start 500 - 2>/dev/null",
                    b, log),
        1);
    assert_int_not_equal(access(log, F_OK), 0);
    assert_int_equal(support_run("%s/bin/landmass-nav --circle 1,2 2>/dev/null", b), 2);
    assert_int_equal(support_run("%s/bin/landmass-nav --rate-scale 9 x.csv 2>/dev/null", b), 2);
    assert_int_equal(support_run("%s/bin/landmass-nav --rain 46,11,50,30 x.csv 2>/dev/null", b), 2);
    assert_int_equal(support_run("%s/bin/landmass-nav 2>/dev/null", b), 2);
    assert_int_equal(support_run("%s/bin/landmass-nav --help >/dev/null", b), 0);
}
