/* What the display does with the jumps, pauses and restarts of two flights that were recorded
 * (../shared/data/nav_tracks): the states that docs/bus.md, "What the glass does", promises. */
#include "check.h"
#include "drv/can_log.h"
#include "lm/overlay.h"
#include "nav/read_track.h"
#include "nav/send.h"
#include "support.h"
#include "unit_rig.h"
#include "wgs84.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { SECOND = 1000000, NAV_FLAGS = LM_FLAG_NAV_STALE | LM_FLAG_NAV_DEAD };

/* A part of a recorded flight on the bus of a unit. Time 0 is its first frame. */
struct replay {
    struct nav_track track;
    struct rig *rig;
    struct drv_can_log log;
    FILE *lines;
    int64_t from_us; /* of the record */
    bool is_silent;  /* what comes meanwhile is lost */
    uint64_t now_us;
};

static int receive(void *ctx, struct lm_can_frame *frame)
{
    struct replay *r = ctx;
    const struct lm_can log = drv_can_log_port(&r->log);
    int status;
    do {
        status = log.receive(log.ctx, frame);
    } while (status == 1 && r->is_silent);
    return status;
}

/* False when the data is not there. */
static bool load(struct replay *r, const char *name)
{
    char path[512];
    struct nav_reading reading = {0};
    struct nav_findings found;
    *r = (struct replay){0};
    if (!support_data_path(name, path, sizeof path) ||
        nav_read_track(path, NAV_FORMAT_BY_NAME, &r->track, &reading) != 0) {
        return false;
    }
    nav_track_complete(&r->track, &(struct nav_limits){0, 411}, &found);
    return true;
}

/* Put the record from `from_us` on, for `seconds`, on the bus, beginning now. */
static void send_part(struct replay *r, int64_t from_us, double seconds)
{
    struct nav_sent sent;
    const struct nav_send_options options = {.interface = "can0",
                                             .position = NAV_POSITION_DOUBLE,
                                             .rate_scale = 1,
                                             .from_us = from_us,
                                             .until_us = from_us + (int64_t)(seconds * SECOND)};
    if (r->lines != NULL) {
        fclose(r->lines);
    }
    r->lines = tmpfile();
    assert_int_equal(nav_send(&r->track, &options, r->lines, &sent), 0);
    assert_true(sent.frames > 0);
    rewind(r->lines);
    drv_can_log_init(&r->log, r->lines, NULL, NULL);
    /* The log's clock begins with its first frame; the unit's goes on. */
    r->from_us = from_us;
    r->log.origin_us = (uint64_t)from_us - r->now_us;
    r->log.has_origin = true;
    r->log.next.time_us = r->now_us;
}

static void start(struct replay *r, int64_t from_us, double seconds)
{
    r->now_us = 0;
    r->is_silent = false;
    r->rig = make_rig();
    r->rig->board.can = (struct lm_can){.ctx = r, .receive = receive};
    assert_int_equal(lm_unit_init(&r->rig->unit, &r->rig->board.lent), LM_OK);
    send_part(r, from_us, seconds);
}

static void stop(struct replay *r)
{
    fclose(r->lines);
    r->lines = NULL;
    free_rig(r->rig);
}

static void fly(struct replay *r, double seconds)
{
    const uint64_t until_us = r->now_us + (uint64_t)llround(seconds * SECOND);
    for (; r->now_us < until_us; r->now_us += STEP_US) {
        drv_can_log_set_now(&r->log, r->now_us);
        lm_unit_step(&r->rig->unit, r->now_us);
    }
}

static uint32_t nav_flags(const struct replay *r)
{
    return r->rig->unit.flags & NAV_FLAGS;
}

static double metres_to(const struct replay *r, const struct nav_fix *fix)
{
    const struct lm_ownship *o = &r->rig->unit.ownship;
    return wgs84_metres((int32_t)o->latitude * (360 / 0x1p32),
                        (int32_t)o->longitude * (360 / 0x1p32), fix->latitude_deg,
                        fix->longitude_deg);
}

/* Each fifth of the flight's jumps, from two seconds before it. */
TEST(at_every_jump_the_new_place_is_shown_at_once_and_the_picture_starts_anew)
{
    struct replay r;
    if (!load(&r, "nav_tracks/zero_gravity.csv.gz")) {
        skip();
        return; /* skip() does not come back, but its declaration does not say so */
    }
    int jumps = 0, tried = 0;
    for (size_t i = 3; i + 2 < r.track.count; i++) {
        const struct nav_fix *fix = &r.track.fix[i];
        if (!fix->is_jump || jumps++ % 5 != 0) {
            continue;
        }
        start(&r, fix->time_us - 2 * SECOND, 3);
        fly(&r, 1.9);
        const struct lm_unit *u = &r.rig->unit;
        const uint32_t before = u->nav.position_jumps;
        assert_int_equal(nav_flags(&r), 0);
        assert_true(metres_to(&r, fix) > 350);
        fly(&r, 0.2);
        assert_true(u->nav.position_jumps > before);
        assert_int_equal(nav_flags(&r), 0);
        /* It has flown on for 0.1 s since; the record is good for a metre. */
        assert_true(metres_to(&r, fix) < fix->speed_ms * 0.11 + 1);
        assert_int_equal(u->position_seen.jumps,
                         u->nav.position_jumps); /* the picture was begun anew */
        stop(&r);
        tried++;
    }
    nav_track_free(&r.track);
    print_message("# %d of %d jumps\n", tried, jumps);
    assert_true(jumps > 140 && tried > 25);
}

/* Silence of `seconds` that begins at `from_us`; the states during and after it. */
static void fall_silent(struct replay *r, int64_t from_us, double seconds)
{
    start(r, from_us, seconds + 3);
    const struct lm_unit *u = &r->rig->unit;
    fly(r, 1.5);
    assert_int_equal(nav_flags(r), 0);
    const uint32_t jumps = u->nav.position_jumps;
    /* Ages count from the last frame, up to 0.1 s before the silence: hence the margins. */
    r->is_silent = true;
    fly(r, 0.19);
    assert_int_equal(nav_flags(r), 0);
    fly(r, 0.22);
    assert_int_equal(nav_flags(r), LM_FLAG_NAV_STALE);
    fly(r, 0.48); /* 0.89 s */
    assert_int_equal(nav_flags(r), LM_FLAG_NAV_STALE);
    assert_int_equal(u->flags & LM_FLAG_BUS, 0);
    fly(r, 0.14); /* 1.03 s: heading is dead, and no frame came for a second */
    assert_int_equal(nav_flags(r), LM_FLAG_NAV_DEAD);
    assert_true((u->flags & LM_FLAG_BUS) != 0);
    assert_int_not_equal(u->ownship.position_quality, LM_NAV_DEAD);
    fly(r, 0.06);
    assert_int_equal(lit_pixels(r->rig), 0); /* the picture is removed */
    if (seconds > 2.5) {
        fly(r, 1.0); /* 2.1 s */
        assert_int_equal(u->ownship.position_quality, LM_NAV_DEAD);
        assert_int_equal(u->ownship.latitude, 0);
    }
    if (seconds > 5.5) {
        fly(r, 3.0);
        assert_int_equal(u->ownship.height_quality, LM_NAV_DEAD);
        fly(r, seconds - 5.1);
    }
    r->is_silent = false;
    fly(r, 1.5);
    assert_int_equal(nav_flags(r), 0);
    assert_int_equal(u->flags & LM_FLAG_BUS, 0);
    assert_int_equal(u->nav.position_jumps, jumps); /* it has flown there */
    stop(r);
}

TEST(a_silent_bus_is_flagged_then_the_picture_removed_and_both_end_with_it)
{
    struct replay r;
    const double lengths[] = {1.2, 3, 40};
    if (!load(&r, "nav_tracks/nice.csv.gz")) {
        skip();
        return; /* skip() does not come back, but its declaration does not say so */
    }
    for (size_t i = 0; i < sizeof lengths / sizeof *lengths; i++) {
        fall_silent(&r, r.track.fix[100 + 300 * i].time_us + 3 * SECOND, lengths[i]);
    }
    nav_track_free(&r.track);
}

TEST(single_lost_frames_change_nothing)
{
    struct replay r;
    if (!load(&r, "nav_tracks/nice.csv.gz")) {
        skip();
        return; /* skip() does not come back, but its declaration does not say so */
    }
    start(&r, r.track.fix[500].time_us, 10);
    fly(&r, 1);
    for (int i = 0; i < 80; i++) {
        r.is_silent = i % 3 == 1;
        fly(&r, 0.1);
        assert_int_equal(nav_flags(&r), 0);
    }
    stop(&r);
    nav_track_free(&r.track);
}

/* The replay starts over: another place, another time of day, and message codes from 0. */
TEST(a_flight_that_starts_over_is_followed_from_its_first_fix)
{
    struct replay r;
    if (!load(&r, "nav_tracks/zero_gravity.csv.gz")) {
        skip();
        return; /* skip() does not come back, but its declaration does not say so */
    }
    start(&r, r.track.fix[3000].time_us, 5);
    fly(&r, 2);
    assert_int_equal(nav_flags(&r), 0);
    const struct lm_unit *u = &r.rig->unit;
    const uint32_t jumps = u->nav.position_jumps;
    send_part(&r, r.track.fix[0].time_us, 5);
    fly(&r, 0.2);
    assert_int_equal(nav_flags(&r), 0);
    assert_true(u->nav.position_jumps > jumps);
    assert_true(metres_to(&r, &r.track.fix[0]) < 50);
    assert_true(u->bus.canas.count.sequence_breaks > 0);
    stop(&r);
    nav_track_free(&r.track);
}

/* ---- what it says ---- */

struct talk {
    struct lm_can_frame asked, said;
    bool is_asked;
    int answers;
};

static int hear_request(void *ctx, struct lm_can_frame *frame)
{
    struct talk *t = ctx;
    *frame = t->asked;
    const bool is_asked = t->is_asked;
    t->is_asked = false;
    return is_asked;
}

static int keep_answer(void *ctx, const struct lm_can_frame *frame)
{
    struct talk *t = ctx;
    t->said = *frame;
    t->answers++;
    return LM_OK;
}

TEST(the_unit_answers_in_the_step_that_hears_the_request)
{
    struct rig *rig = make_rig();
    struct talk talk = {.asked = {.id = 128, .length = 4}};
    rig->board.can = (struct lm_can){.ctx = &talk, .receive = hear_request, .send = keep_answer};
    rig->board.lent.bus_node = 33;
    rig->board.lent.hardware_revision = 2;
    assert_int_equal(lm_unit_init(&rig->unit, &rig->board.lent), LM_OK);
    lm_unit_step(&rig->unit, 0);
    assert_int_equal(talk.answers, 0);
    talk.is_asked = true;
    talk.asked.time_us = 1000;
    lm_unit_step(&rig->unit, 2000);
    assert_int_equal(talk.answers, 1);
    assert_true(talk.said.id == 129 && talk.said.data[0] == 33 && talk.said.data[4] == 2);
    /* A bus of another framing has no such services. */
    rig->board.lent.bus_profile = &lm_bus_generic;
    assert_int_equal(lm_unit_init(&rig->unit, &rig->board.lent), LM_OK);
    talk.is_asked = true;
    lm_unit_step(&rig->unit, 2000);
    assert_int_equal(talk.answers, 1);
    rig->board.lent.bus_profile = &lm_bus_canas17;
    assert_int_equal(lm_unit_init(&rig->unit, &rig->board.lent), LM_OK);
    lm_unit_step(&rig->unit, 2900000); /* the state is that of the step before */
    talk.is_asked = true;
    talk.asked.data[2] = LM_CANAS_STS;
    talk.asked.time_us = 3000000;
    lm_unit_step(&rig->unit, 3000000);
    assert_int_equal(talk.answers, 2);
    assert_int_equal(talk.said.id, 1500);
    /* Nothing is known of the aircraft: flag 1 of the state. */
    assert_int_equal(talk.said.data[7] & NAV_FLAGS, LM_FLAG_NAV_DEAD);
    free_rig(rig);
}
