/* Live targets that landmass-nav sends, taken by the firmware. */
#include "check.h"
#include "drv/can_log.h"
#include "hs/angle.h"
#include "lm/bus.h"
#include "lm/live_bus.h"
#include "nav/make_track.h"
#include "nav/send.h"
#include "wgs84.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { S = 1000000 };

/* Where a target is by the law of a circle, or on the geodesic. */
static double miss_m(const struct nav_live_item *t, double seconds, struct lm_position found)
{
    const double x = t->turn_deg_s * seconds / 2 * M_PI / 180;
    const double way_m = t->speed_ms * seconds * (x == 0 ? 1 : sin(x) / x);
    double latitude, longitude;
    wgs84_direct(t->latitude_deg, t->longitude_deg, t->course_deg + x * 180 / M_PI, way_m,
                 &latitude, &longitude);
    return wgs84_metres(latitude, longitude, hs_degrees(found.latitude),
                        hs_degrees(found.longitude));
}

struct ear {
    struct lm_bus bus;
    struct lm_live_bus live;
    uint64_t begin_us, now_us;
    double worst_m;
};

static void compare(struct ear *ear, const struct nav_live *l)
{
    const double now_s = (double)(ear->now_us - ear->begin_us) * 1e-6;
    for (int i = 0; i < l->count; i++) {
        const struct nav_live_item *t = &l->item[i];
        const struct lm_live_target *heard = &ear->live.live.target[t->number];
        if (heard->is_there) {
            const struct lm_live_state s = lm_live_at(heard, ear->now_us);
            ear->worst_m = fmax(ear->worst_m, miss_m(t, now_s - t->from_s, s.position));
        }
    }
}

static void send(const struct nav_live *l, double seconds, struct ear *ear,
                 void (*each)(struct ear *, const struct nav_live *))
{
    struct nav_track track = {0};
    const struct nav_straight straight = {46, 11, 0, 3000, 150};
    assert_int_equal(nav_make_straight(&straight, 1000 * (int64_t)S, seconds, &track), 0);
    struct nav_send_options *options = calloc(1, sizeof *options);
    options->interface = "can0";
    options->rate_scale = 1;
    options->until_us = INT64_MAX;
    options->live = *l;
    FILE *log_file = tmpfile();
    struct nav_sent sent;
    assert_int_equal(nav_send(&track, options, log_file, &sent), 0);
    rewind(log_file);
    struct drv_can_log log;
    drv_can_log_init(&log, log_file, NULL, NULL);
    drv_can_log_set_now(&log, UINT64_MAX);
    const struct lm_can port = drv_can_log_port(&log);
    struct lm_can_frame f;
    struct lm_bus_event events[LM_BUS_EVENTS];
    lm_bus_init(&ear->bus, &lm_bus_canas17);
    while (port.receive(port.ctx, &f) == 1) {
        ear->begin_us = ear->begin_us == 0 ? f.time_us : ear->begin_us;
        ear->now_us = f.time_us;
        const uint32_t count = lm_bus_take(&ear->bus, &f, events);
        for (uint32_t i = 0; i < count; i++) {
            lm_live_bus_take(&ear->live, &events[i], f.time_us);
        }
        each(ear, l);
    }
    fclose(log_file);
    free(options);
    nav_track_free(&track);
}

TEST(targets_are_told_where_they_are)
{
    static const double told[][10] = {{1, 3, 46.1, 11, 90, 15},
                                      {255, 7, 46.2, 11.1, 200, 220, 4000, 3},
                                      {0, 13, 46.05, 11.1, 180, 8, -9999, 0, 5, 12}};
    struct nav_live *l = calloc(1, sizeof *l);
    struct ear *ear = calloc(1, sizeof *ear);
    assert_true(nav_live_add(l, told[0], 6));
    assert_true(nav_live_add(l, told[1], 8));
    assert_true(nav_live_add(l, told[2], 10));
    send(l, 20, ear, compare);
    print_message("# %u sets, within %.2f m\n", ear->live.count.sets, ear->worst_m);
    assert_in_range(ear->live.count.sets, 20 + 20 + 7 - 2, 20 + 20 + 7 + 2);
    assert_true(ear->worst_m < 0.5);
    assert_int_equal(ear->live.count.torn + ear->live.count.refused, 0);
    assert_int_equal(ear->live.count.removed, 1);
    assert_int_equal(ear->live.live.count, 2);
    assert_true(ear->live.live.target[255].has_height && !ear->live.live.target[1].has_height);
    assert_int_equal(ear->live.live.target[255].kind, LM_LIVE_FIGHTER);
    free(ear);
    free(l);
}

static void listen(struct ear *ear, const struct nav_live *l)
{
    (void)ear;
    (void)l;
}

TEST(all_256_are_told_once_a_second)
{
    struct nav_live *l = calloc(1, sizeof *l);
    struct ear *ear = calloc(1, sizeof *ear);
    for (int i = 0; i < NAV_LIVE_MAX; i++) {
        const double told[] = {i, i % NAV_LIVE_KINDS, 46, 11, i, i, 100};
        assert_true(nav_live_add(l, told, 7));
    }
    send(l, 10, ear, listen);
    assert_int_equal(ear->live.live.count, NAV_LIVE_MAX);
    assert_in_range(ear->live.count.sets, 10 * NAV_LIVE_MAX - 4, 10 * NAV_LIVE_MAX + 4);
    assert_int_equal(ear->live.count.torn + ear->live.count.refused, 0);
    free(ear);
    free(l);
}

TEST(a_beacon_is_told_with_its_reply)
{
    static const double good[] = {7, 5, 46.1, 11, 120, 10};
    static const struct {
        int place;
        double value;
    } bad[] = {{0, 256}, {1, 16}, {1, 1.5}, {1, -1}, {2, 91}, {4, 16001}, {5, 16}, {5, 0.5}};
    struct nav_live *l = calloc(1, sizeof *l);
    struct ear *ear = calloc(1, sizeof *ear);
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        double v[6];
        memcpy(v, good, sizeof v);
        v[bad[i].place] = bad[i].value;
        assert_false(nav_live_add_beacon(l, v, 6));
    }
    assert_false(nav_live_add_beacon(l, good, 3));
    assert_int_equal(l->count, 0);
    assert_true(nav_live_add_beacon(l, good, 6));
    assert_false(nav_live_add_beacon(l, good, 4)); /* the number is taken */
    send(l, 5, ear, listen);
    const struct lm_live_target *t = &ear->live.live.target[7];
    assert_true(t->is_there && t->has_height);
    assert_int_equal(t->kind, LM_LIVE_BEACON);
    assert_int_equal(t->signature, 0xa5);
    free(ear);
    free(l);
}

TEST(what_is_out_of_range_is_not_taken)
{
    static const double good[] = {1, 3, 46, 11, 90, 15, 100, 2, 3, 9};
    static const struct {
        int place;
        double value;
    } bad[] = {{0, 256},  {0, -1}, {0, 1.5},   {1, 18}, {2, 91}, {3, 181}, {4, 361},
               {5, 1001}, {5, -1}, {6, 16001}, {7, 61}, {8, -1}, {9, 3}};
    struct nav_live *l = calloc(1, sizeof *l);
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        double v[10];
        memcpy(v, good, sizeof v);
        v[bad[i].place] = bad[i].value;
        assert_false(nav_live_add(l, v, 10));
    }
    assert_false(nav_live_add(l, good, 5));
    assert_false(nav_live_add(l, good, -1));
    assert_true(nav_live_add(l, good, 10));
    assert_false(nav_live_add(l, good, 10)); /* the number is taken */
    assert_int_equal(l->count, 1);
    free(l);
}

/* ---- routes ---- */

static int read_text(struct nav_live *l, const char *text)
{
    char path[] = "/tmp/routes-XXXXXX";
    const int fd = mkstemp(path);
    assert_true(fd >= 0);
    FILE *out = fdopen(fd, "w");
    fputs(text, out);
    fclose(out);
    const int status = nav_live_read(l, path);
    remove(path);
    return status;
}

static const char convoy[] =
    "# a convoy, a fighter, and one that stands\n"
    "target 1 3\n"
    "  at 0 46.1 11\n"
    "  speed 20 46.1 11.001 # some 77 m: four seconds\n"
    "  at 10 46.1 11.001    # stands there\n"
    "  at 14 46.1005 11.001\n"
    "  gone\n"
    "target 2 7\n"
    "  at 2 46.2 11.1 4000\n"
    "  speed 200 46.3 11.1 5000\n"
    "target 9 13\n"
    "  at 5 46.05 11.1\n";

/* Where the first target is by its file. */
static void place_of_convoy(double seconds, double *latitude, double *longitude)
{
    const double first_s = wgs84_metres(46.1, 11, 46.1, 11.001) / 20;
    const double part = fmin(1, seconds / first_s), up = fmax(0, (seconds - 10) / 4);
    *latitude = 46.1 + 0.0005 * up;
    *longitude = 11 + 0.001 * part;
}

static void compare_convoy(struct ear *ear, const struct nav_live *l)
{
    (void)l;
    const double now_s = (double)(ear->now_us - ear->begin_us) * 1e-6;
    const struct lm_live_target *first = &ear->live.live.target[1];
    if (first->is_there) {
        double latitude, longitude;
        place_of_convoy(now_s, &latitude, &longitude);
        const struct lm_position at = lm_live_at(first, ear->now_us).position;
        ear->worst_m = fmax(ear->worst_m, wgs84_metres(latitude, longitude, hs_degrees(at.latitude),
                                                       hs_degrees(at.longitude)));
    }
}

/* Told at each place as well as once a second, it never overshoots by more than the way of a minor
 * frame and a set. */
TEST(targets_follow_their_routes)
{
    struct nav_live *l = calloc(1, sizeof *l);
    struct ear *ear = calloc(1, sizeof *ear);
    assert_int_equal(read_text(l, convoy), 0);
    assert_int_equal(l->count, 3);
    send(l, 20, ear, compare_convoy);
    print_message("# %u sets, within %.2f m\n", ear->live.count.sets, ear->worst_m);
    assert_true(ear->worst_m < 0.6);
    assert_int_equal(ear->live.count.torn + ear->live.count.refused, 0);
    const struct lm_live_target *t = ear->live.live.target;
    assert_false(t[1].is_there); /* gone at 14 s */
    assert_int_equal(ear->live.count.removed, 1);
    assert_true(t[2].is_there && t[2].has_height);
    const struct lm_live_state s = lm_live_at(&t[2], ear->now_us);
    assert_in_range(s.speed_mm_s, 199900, 200100);
    const double way_m =
        wgs84_metres(46.2, 11.1, hs_degrees(s.position.latitude), hs_degrees(s.position.longitude));
    assert_true(fabs(way_m - 18 * 200) < 5);
    assert_true(fabs(t[2].height_m_q6 / 64.0 - 4000 - 1000 * 17.5 / 55.6) < 20);
    assert_true(t[9].is_there && !t[9].has_height);
    assert_int_equal(lm_live_at(&t[9], ear->now_us).speed_mm_s, 0);
    free(ear);
    free(l);
}

TEST(mistakes_in_a_file_of_routes_are_refused)
{
    static const char *const bad[] = {"",
                                      "at 0 46 11\n",
                                      "gone\n",
                                      "target 256 3\n at 0 46 11\n",
                                      "target 1 18\n at 0 46 11\n",
                                      "target 1 17 256\n at 0 46 11\n",
                                      "target 1 16 5\n at 0 46 11\n",
                                      "target 1\n at 0 46 11\n",
                                      "target 1 3\n",
                                      "target 1 3\ntarget 2 3\n at 0 46 11\n",
                                      "target 1 3\n at 0 46 11\ntarget 1 3\n at 0 46 11\n",
                                      "target 1 3\n at 0 91 11\n",
                                      "target 1 3\n at 0 46 181\n",
                                      "target 1 3\n at 0 46 11 16001\n",
                                      "target 1 3\n at -1 46 11\n",
                                      "target 1 3\n at 0 46\n",
                                      "target 1 3\n at 0 46 11 1 2\n",
                                      "target 1 3\n speed 3 46 11\n",
                                      "target 1 3\n at 5 46 11\n at 5 46.01 11\n",
                                      "target 1 3\n at 0 46 11\n speed 0 46.1 11\n",
                                      "target 1 3\n at 0 46 11\n speed 3 46 11\n",
                                      "target 1 3\n at 0 46 11\n at 1 46.1 11\n",
                                      "target 1 3\n at 0 46 11 9\n at 9 46.001 11\n",
                                      "target 1 3\n at 0 46 11\n gone\n",
                                      "target 1 3\n at 0 46 11\n at 9 46 11\n gone\n gone\n",
                                      "target 1 3\n at 0 46 11\n at 9 46 11\n gone\n at 10 46 11\n",
                                      "target 1 3\n at 0 46 11\n stay 9\n",
                                      "target 1 3\n at nan 46 11\n"};
    struct nav_live *l = calloc(1, sizeof *l);
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        memset(l, 0, sizeof *l);
        print_message("# %zu\n", i);
        assert_int_equal(read_text(l, bad[i]), -1);
    }
    free(l);
}
