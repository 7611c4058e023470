#include "nav/bridge.h"

#include "hs/error.h"
#include "schedule.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    WAITING_MOST = 4096, /* frames of a minor frame, with all live targets at once */
    BEHIND_MOST_US = 200000,
    STANDS_US = 250000, /* numbers that stand so long in flight are a pause */
    RESTARTS = 20000,   /* an order that falls by 2 s is a simulator that began again */
    STUTTER_US = 100000,
    LEAK_US = 200
};

static const double flies_ms = 5, degree = 3.14159265358979323846 / 180;

struct waiting {
    struct canas_frame frame;
    int64_t time_us;
};

struct nav_bridge {
    struct nav_bridge_settings settings;
    struct nav_bridge_counts counts;
    struct nav_schedule schedule;
    int (*put)(void *context, const struct canas_frame *frame, int64_t time_us);
    void *context;
    struct nav_told told;
    bool has_told, has_sender, is_silent, is_standing;
    int said_paused; /* -1: the simulator never says it */
    double magnetic_deg;
    uint64_t sender;
    int64_t came_us;   /* when `told` did */
    int64_t at_us;     /* the instant that it belongs to */
    int64_t moved_us;  /* when its numbers last differed from those before */
    int64_t offset_us; /* from the simulator's clock to UTC */
    int64_t first_us;
    uint64_t next_tick;
    struct waiting waiting[WAITING_MOST];
    int head, tail;
};

static double period_us(const struct nav_bridge *b)
{
    return NAV_MINOR_US / b->settings.send.rate_scale;
}

static void begin(struct nav_bridge *b, int64_t now_us)
{
    if (b->first_us < 0) {
        b->first_us = now_us;
        b->next_tick = (uint64_t)ceil((double)now_us / period_us(b));
    }
}

/* ---- what comes ---- */

static bool is_from_sender(struct nav_bridge *b, uint64_t sender, int64_t now_us)
{
    const bool is_free =
        !b->has_sender || now_us - b->came_us > (int64_t)NAV_BRIDGE_CHANGE_MS * 1000;
    if (b->has_sender && b->sender == sender) {
        return true;
    }
    if (is_free) {
        b->has_sender = true;
        b->sender = sender;
        b->has_told = false;
        b->said_paused = -1;
        b->magnetic_deg = (double)NAN;
        b->counts.senders++;
        return true;
    }
    b->counts.other_sender++;
    return false;
}

static bool is_in_order(struct nav_bridge *b, const struct nav_told *t)
{
    const bool is_old = b->has_told && t->order >= 0 && b->told.order >= t->order &&
                        b->told.order - t->order < RESTARTS;
    b->counts.disordered += is_old;
    return !is_old;
}

static bool is_same_place(const struct nav_told *a, const struct nav_told *b)
{
    return a->latitude_deg == b->latitude_deg && a->longitude_deg == b->longitude_deg &&
           a->height_m == b->height_m && a->heading_deg == b->heading_deg &&
           a->pitch_deg == b->pitch_deg && a->roll_deg == b->roll_deg;
}

/* Datagrams come late by a time that varies. Where the simulator tells its own clock the least
 * delay of late counts, so that the aircraft does not jump back and forth. */
static int64_t instant(struct nav_bridge *b, const struct nav_told *t, int64_t now_us)
{
    if (isnan(t->elapsed_s)) {
        return now_us;
    }
    const int64_t offset_us = now_us - llround(t->elapsed_s * 1e6);
    if (!b->has_told || offset_us < b->offset_us || offset_us - b->offset_us > STUTTER_US) {
        b->offset_us = offset_us;
    } else {
        b->offset_us += LEAK_US;
    }
    return now_us - (offset_us - b->offset_us);
}

static void note_standing(struct nav_bridge *b, const struct nav_told *t, int64_t now_us)
{
    if (!b->has_told || !is_same_place(&b->told, t)) {
        b->moved_us = now_us;
    }
    b->is_standing = now_us - b->moved_us >= STANDS_US &&
                     hypot(hypot(t->north_ms, t->east_ms), t->up_ms) > flies_ms;
}

static bool is_paused(const struct nav_bridge *b)
{
    return b->said_paused == 1 || b->is_standing;
}

/* The exercise stands while the simulator does: its clock is told with rate 0. */
static void set_exercise(struct nav_bridge *b, bool stands, int64_t now_us)
{
    struct nav_exercise *x = &b->settings.send.exercise;
    const double now_s = (double)(now_us - b->first_us) * 1e-6;
    const double shown_s = nav_exercise_ms(x, now_s) * 1e-3;
    x->start_s = shown_s - now_s; /* the rate is 1 up to now_s, whatever it was */
    x->rate_count = 1;
    x->rate[0].rate = stands ? 0 : 1;
    x->rate[0].from_s = now_s;
}

static void note_pause(struct nav_bridge *b, bool was_paused, int64_t now_us)
{
    if (is_paused(b) != was_paused) {
        b->counts.pauses += !was_paused;
        set_exercise(b, !was_paused, now_us);
    }
}

static void use(struct nav_bridge *b, const struct nav_told *t, int64_t now_us)
{
    if (b->has_told) {
        b->counts.longest_wait_s =
            fmax(b->counts.longest_wait_s, (double)(now_us - b->came_us) * 1e-6);
    }
    b->at_us = instant(b, t, now_us);
    note_standing(b, t, now_us);
    if (b->is_silent) {
        b->moved_us = now_us;
        b->is_standing = false;
    }
    b->told = *t;
    b->has_told = true;
    b->is_silent = false;
    b->came_us = now_us;
    b->counts.used++;
}

void nav_bridge_take(struct nav_bridge *b, const uint8_t *bytes, size_t length, uint64_t sender,
                     int64_t now_us)
{
    struct nav_told t;
    begin(b, now_us);
    b->counts.datagrams++;
    const enum nav_told_fault fault = b->settings.is_xplane
                                          ? nav_xplane_read(bytes, length, &t)
                                          : nav_flightgear_read(bytes, length, &t);
    b->counts.fault[fault]++;
    if (fault != NAV_TOLD_OK || !is_from_sender(b, sender, now_us)) {
        return;
    }
    const bool was_paused = is_paused(b);
    if (!isnan(t.magnetic_deg)) {
        b->magnetic_deg = t.magnetic_deg;
    }
    if (isnan(t.latitude_deg)) { /* it tells of the pause alone */
        b->said_paused = t.paused >= 0 ? t.paused : b->said_paused;
    } else if (is_in_order(b, &t)) {
        b->said_paused = t.paused >= 0 ? t.paused : b->said_paused;
        use(b, &t, now_us);
    }
    note_pause(b, was_paused, now_us);
}

/* ---- what goes ---- */

static double ahead_s(const struct nav_bridge *b, int64_t time_us)
{
    const double ahead = (double)(time_us - b->at_us) * 1e-6;
    return is_paused(b) ? 0 : fmax(0, fmin(ahead, 0.001 * 2 * NAV_BRIDGE_SILENT_MS));
}

/* Rates of roll, pitch and heading from those of the body, e.g. Etkin, "Dynamics of Atmospheric
 * Flight", 1972, eq. 4.4.7 solved for them. Near the vertical, where heading and roll are one,
 * neither is extrapolated. */
static void turn(struct nav_state *s, double ahead)
{
    const double sin_roll = sin(s->roll_deg * degree), cos_roll = cos(s->roll_deg * degree);
    const double cos_pitch = cos(s->pitch_deg * degree);
    if (cos_pitch < 0.1) {
        return;
    }
    const double heading = (s->pitch_rate * sin_roll + s->yaw_rate * cos_roll) / cos_pitch;
    const double pitch = s->pitch_rate * cos_roll - s->yaw_rate * sin_roll;
    const double roll = s->roll_rate + heading * sin(s->pitch_deg * degree);
    s->heading_deg = nav_wrap_180(s->heading_deg + heading * ahead);
    s->pitch_deg = fmax(-90, fmin(90, s->pitch_deg + pitch * ahead));
    s->roll_deg = nav_wrap_180(s->roll_deg + roll * ahead);
}

static double known(double value)
{
    return isnan(value) ? 0 : value;
}

static void kinematics(void *context, int64_t time_us, struct nav_state *s)
{
    const struct nav_bridge *b = context;
    const struct nav_told *t = &b->told;
    const double moves = is_paused(b) ? 0 : 1;
    s->east_ms = t->east_ms * moves;
    s->north_ms = t->north_ms * moves;
    s->climb_ms = t->up_ms * moves;
    s->speed_ms = hypot(s->east_ms, s->north_ms);
    const double track = atan2(t->east_ms, t->north_ms) / degree;
    s->track_deg = track < 0 ? track + 360 : track;
    s->heading_deg = t->heading_deg;
    s->pitch_deg = t->pitch_deg;
    s->roll_deg = t->roll_deg;
    s->roll_rate = known(t->roll_rate) * moves;
    s->pitch_rate = known(t->pitch_rate) * moves;
    s->yaw_rate = known(t->yaw_rate) * moves;
    turn(s, ahead_s(b, time_us));
    s->variation_deg = nav_wrap_180(t->heading_deg - b->magnetic_deg);
    s->magnetic_deg = nav_wrap_180(s->heading_deg - s->variation_deg);
}

/* Along the meridian and the parallel of the ellipsoid WGS 84; within half a second the way is
 * straight to some centimetres. At a pole the aircraft waits for the next datagram. */
static void position(void *context, int64_t time_us, struct nav_state *s)
{
    const struct nav_bridge *b = context;
    const struct nav_told *t = &b->told;
    const double a = 6378137, e2 = 6.69437999014e-3, ahead = ahead_s(b, time_us);
    const double sine = sin(t->latitude_deg * degree), cosine = cos(t->latitude_deg * degree);
    const double w2 = 1 - e2 * sine * sine, across = a / sqrt(w2);
    s->latitude_deg = t->latitude_deg;
    s->longitude_deg = t->longitude_deg;
    s->height_m = t->height_m + b->settings.height_offset_m + t->up_ms * ahead;
    if (cosine > 1e-3) {
        s->latitude_deg += t->north_ms * ahead / (across * (1 - e2) / w2) / degree;
        s->longitude_deg =
            nav_wrap_180(t->longitude_deg + t->east_ms * ahead / (across * cosine) / degree);
    }
}

static int queue(void *context, const struct canas_frame *frame, int64_t time_us)
{
    struct nav_bridge *b = context;
    if (b->tail == WAITING_MOST) {
        b->counts.frames_without_room++;
        return 0;
    }
    b->waiting[b->tail++] = (struct waiting){*frame, time_us};
    return 0;
}

static int send_due(struct nav_bridge *b, int64_t now_us)
{
    while (b->head < b->tail && b->waiting[b->head].time_us <= now_us) {
        const struct waiting *w = &b->waiting[b->head++];
        b->counts.frames++;
        if (b->put(b->context, &w->frame, w->time_us) != 0) {
            return -1;
        }
    }
    if (b->head == b->tail) {
        b->head = b->tail = 0;
    }
    return 0;
}

static int64_t tick_us(const struct nav_bridge *b)
{
    return llround((double)b->next_tick * period_us(b));
}

static void note_silence(struct nav_bridge *b, int64_t now_us)
{
    if (b->has_told && !b->is_silent &&
        now_us - b->came_us > (int64_t)NAV_BRIDGE_SILENT_MS * 1000) {
        b->is_silent = true;
        b->counts.silences++;
    }
}

static void set_clock(struct nav_bridge *b)
{
    const struct nav_told *t = &b->told;
    b->schedule.utc_ahead_us = t->utc_us >= 0 ? t->utc_us - b->at_us : 0;
}

int nav_bridge_step(struct nav_bridge *b, int64_t now_us)
{
    begin(b, now_us);
    note_silence(b, now_us);
    while (tick_us(b) <= now_us) {
        const int64_t at_us = tick_us(b);
        if (now_us - at_us > BEHIND_MOST_US) {
            b->counts.skipped_ticks++;
        } else if (b->has_told && !b->is_silent) {
            if (send_due(b, at_us) != 0) {
                return -1;
            }
            set_clock(b);
            (void)nav_schedule_put(&b->schedule, b->next_tick, at_us, b->first_us);
        }
        b->next_tick++;
    }
    return send_due(b, now_us);
}

enum nav_bridge_mood nav_bridge_mood(const struct nav_bridge *b)
{
    return !b->has_told   ? NAV_BRIDGE_WAITING
           : b->is_silent ? NAV_BRIDGE_SILENT
           : is_paused(b) ? NAV_BRIDGE_PAUSED
                          : NAV_BRIDGE_FLYING;
}

const struct nav_bridge_counts *nav_bridge_counts(const struct nav_bridge *b)
{
    return &b->counts;
}

struct nav_bridge *nav_bridge_new(const struct nav_bridge_settings *settings,
                                  int (*put)(void *context, const struct canas_frame *frame,
                                             int64_t time_us),
                                  void *context)
{
    struct nav_bridge *b = calloc(1, sizeof *b);
    if (!b) {
        (void)hs_error("memory", NULL, "is short");
        return NULL;
    }
    b->settings = *settings;
    b->put = put;
    b->context = context;
    b->said_paused = -1;
    b->magnetic_deg = (double)NAN;
    b->first_us = -1;
    b->schedule.options = &b->settings.send;
    b->schedule.datum = settings->datum;
    b->schedule.source = (struct nav_source){kinematics, position, b};
    b->schedule.sink = (struct nav_sink){queue, b};
    nav_schedule_begin(&b->schedule);
    return b;
}

void nav_bridge_free(struct nav_bridge *b)
{
    free(b);
}
