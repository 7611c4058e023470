#include "nav/send.h"

#include "hs/progress.h"
#include "nav/canas.h"

#include <math.h>
#include <stddef.h>
#include <time.h>

enum {
    NODE_AHRS = 1, /* node numbers of the specification's example aircraft */
    NODE_GPS = 9,
    MINOR_US = 12500, /* 80 Hz */
    SLOT_US = 125     /* one frame at 1 Mbit/s */
};

enum item_kind { VALUE, HEIGHT, LATITUDE, LONGITUDE, CLOCK, CALENDAR };

struct item {
    uint16_t id;
    uint8_t node;
    uint8_t every; /* in minor frames */
    enum item_kind kind;
    size_t offset; /* of the double in struct nav_state, for VALUE, LATITUDE and LONGITUDE */
};

#define STATE(member) offsetof(struct nav_state, member)

/* In ascending identifier. Rates are those of the specification's example (attitude 80 Hz, position
 * and air data 10 Hz); it gives none for 1130..1133, 1200 and 1206. */
static const struct item schedule[] = {
    {CANAS_PITCH_RATE, NODE_AHRS, 1, VALUE, STATE(pitch_rate)},
    {CANAS_ROLL_RATE, NODE_AHRS, 1, VALUE, STATE(roll_rate)},
    {CANAS_YAW_RATE, NODE_AHRS, 1, VALUE, STATE(yaw_rate)},
    {CANAS_PITCH, NODE_AHRS, 1, VALUE, STATE(pitch_deg)},
    {CANAS_ROLL, NODE_AHRS, 1, VALUE, STATE(roll_deg)},
    {CANAS_ALTITUDE_RATE, NODE_GPS, 8, VALUE, STATE(climb_ms)},
    {CANAS_BARO_ALTITUDE, NODE_GPS, 8, HEIGHT, STATE(height_m)},
    {CANAS_HEADING, NODE_AHRS, 1, VALUE, STATE(heading_deg)},
    {CANAS_TRUE_ALTITUDE, NODE_GPS, 8, HEIGHT, STATE(height_m)},
    {CANAS_GPS_LATITUDE, NODE_GPS, 8, LATITUDE, STATE(latitude_deg)},
    {CANAS_GPS_LONGITUDE, NODE_GPS, 8, LONGITUDE, STATE(longitude_deg)},
    {CANAS_GPS_HEIGHT, NODE_GPS, 8, HEIGHT, STATE(height_m)},
    {CANAS_GPS_GROUND_SPEED, NODE_GPS, 8, VALUE, STATE(speed_ms)},
    {CANAS_GPS_TRUE_TRACK, NODE_GPS, 8, VALUE, STATE(track_deg)},
    {CANAS_EAST_VELOCITY, NODE_GPS, 8, VALUE, STATE(east_ms)},
    {CANAS_NORTH_VELOCITY, NODE_GPS, 8, VALUE, STATE(north_ms)},
    {CANAS_UP_VELOCITY, NODE_GPS, 8, VALUE, STATE(climb_ms)},
    {CANAS_TRUE_HEADING, NODE_AHRS, 1, VALUE, STATE(heading_deg)},
    {CANAS_UTC, NODE_GPS, 80, CLOCK, 0},
    {CANAS_DATE, NODE_GPS, 80, CALENDAR, 0},
};

struct sender {
    const struct nav_send_options *options;
    FILE *out;
    struct nav_motion motion;
    struct nav_state state;
    struct canas_codes codes;
    int64_t slot_us; /* when the next frame goes out */
    uint64_t frames;
};

static int put(struct sender *s, const struct canas_frame *f)
{
    char line[CANAS_LINE_MAX];
    size_t length = canas_candump_line(line, f, s->slot_us, s->options->interface);
    line[length++] = '\n';
    s->slot_us += SLOT_US;
    s->frames++;
    return fwrite(line, 1, length, s->out) == length ? 0 : -1;
}

static int put_angle(struct sender *s, const struct item *item, double deg)
{
    struct canas_frame f[2];
    switch (s->options->position) {
    case NAV_POSITION_DOUBLE:
        canas_double(&s->codes, item->id, item->node, deg, f);
        return put(s, &f[0]) == 0 ? put(s, &f[1]) : -1;
    case NAV_POSITION_FLOAT:
        f[0] = canas_float(&s->codes, item->id, item->node, deg);
        break;
    case NAV_POSITION_LONG:
        f[0] = canas_long(&s->codes, item->id, item->node, (int32_t)lround(deg * 1e7));
        break;
    }
    return put(s, &f[0]);
}

static int put_time(struct sender *s, const struct item *item, int64_t time_us)
{
    const time_t seconds = (time_t)(time_us / 1000000);
    struct tm utc;
    gmtime_r(&seconds, &utc);
    const int year = utc.tm_year + 1900;
    const uint8_t clock[4] = {(uint8_t)utc.tm_hour, (uint8_t)utc.tm_min, (uint8_t)utc.tm_sec, 0};
    const uint8_t calendar[4] = {(uint8_t)utc.tm_mday, (uint8_t)(utc.tm_mon + 1),
                                 (uint8_t)(year / 100), (uint8_t)(year % 100)};
    const struct canas_frame f =
        canas_char4(&s->codes, item->id, item->node, item->kind == CLOCK ? clock : calendar);
    return put(s, &f);
}

/* The identifier under which heights above a datum are sent. */
static uint16_t height_item(enum nav_datum datum)
{
    return datum == NAV_DATUM_SEA_LEVEL    ? CANAS_TRUE_ALTITUDE
           : datum == NAV_DATUM_BAROMETRIC ? CANAS_BARO_ALTITUDE
                                           : CANAS_GPS_HEIGHT;
}

static int put_item(struct sender *s, const struct item *item, int64_t tick_us)
{
    const double *value = (const double *)(const void *)((const char *)&s->state + item->offset);
    const int frames = s->options->position == NAV_POSITION_DOUBLE ? 4 : 2;
    switch (item->kind) {
    case LATITUDE:
        nav_motion_position(&s->motion, s->slot_us + (frames - 1) * SLOT_US, &s->state);
        return put_angle(s, item, *value);
    case LONGITUDE:
        return put_angle(s, item, *value);
    case CLOCK:
    case CALENDAR:
        return put_time(s, item, tick_us);
    case HEIGHT:
        if (item->id != height_item(s->motion.track->datum)) {
            return 0;
        }
        if (item->id != CANAS_GPS_HEIGHT) { /* that one belongs to the position before it */
            nav_motion_position(&s->motion, s->slot_us, &s->state);
        }
        break;
    case VALUE:
        nav_motion_kinematics(&s->motion, s->slot_us, &s->state);
        break;
    }
    const struct canas_frame f = canas_float(&s->codes, item->id, item->node, *value);
    return put(s, &f);
}

static int put_weather(struct sender *s, double now_s)
{
    struct canas_frame frames[2 * NAV_WEATHER_EACH * NAV_WEATHER_FRAMES + 1];
    const double period_s = MINOR_US * 1e-6 / s->options->rate_scale;
    const int count = nav_weather_frames(&s->options->weather, &s->codes, now_s, period_s, frames);
    for (int i = 0; i < count; i++) {
        if (put(s, &frames[i]) != 0) {
            return -1;
        }
    }
    return 0;
}

static int put_live(struct sender *s, double now_s, int64_t first_us)
{
    const double period_s = MINOR_US * 1e-6 / s->options->rate_scale;
    struct canas_frame frames[NAV_LIVE_FRAMES];
    for (int index = 0; index < s->options->live.count; index++) {
        const int count = nav_live_frames(&s->options->live, index, &s->codes, now_s, period_s,
                                          (double)(s->slot_us - first_us) * 1e-6, frames);
        for (int i = 0; i < count; i++) {
            if (put(s, &frames[i]) != 0) {
                return -1;
            }
        }
    }
    return 0;
}

static int put_exercise(struct sender *s, double now_s, int64_t first_us)
{
    struct canas_frame frames[NAV_EXERCISE_FRAMES + 2 * NAV_MALFUNCTIONS];
    const double period_s = MINOR_US * 1e-6 / s->options->rate_scale;
    const int64_t sent_us = s->slot_us + (NAV_EXERCISE_FRAMES - 1) * SLOT_US;
    int count = nav_exercise_frames(&s->options->exercise, &s->codes, now_s, period_s,
                                    (double)(sent_us - first_us) * 1e-6, frames);
    count +=
        nav_malfunction_frames(&s->options->exercise, &s->codes, now_s, period_s, frames + count);
    for (int i = 0; i < count; i++) {
        if (put(s, &frames[i]) != 0) {
            return -1;
        }
    }
    return 0;
}

static int put_minor_frame(struct sender *s, uint64_t number, int64_t tick_us)
{
    s->slot_us = tick_us;
    for (size_t i = 0; i < sizeof schedule / sizeof *schedule; i++) {
        if (number % schedule[i].every == 0 && put_item(s, &schedule[i], tick_us) != 0) {
            return -1;
        }
    }
    return 0;
}

int nav_send(const struct nav_track *track, const struct nav_send_options *options, FILE *out,
             struct nav_sent *sent)
{
    struct sender s = {.options = options, .out = out};
    nav_motion_init(&s.motion, track);
    const double period_us = MINOR_US / options->rate_scale;
    const int64_t last_us = track->fix[track->count - 1].time_us;
    const int64_t first_us =
        options->from_us > track->fix[0].time_us ? options->from_us : track->fix[0].time_us;
    const int64_t end_us = options->until_us < last_us ? options->until_us : last_us;
    uint64_t active = 0;
    int failed = 0;
    struct hs_progress progress;
    hs_progress_begin_beside(&progress, out, "sending",
                             end_us > first_us ? (uint64_t)(end_us - first_us) : 0);
    /* Counted from the epoch rather than summed, so that the grid keeps to whole seconds. */
    for (uint64_t n = (uint64_t)ceil((double)first_us / period_us); !failed; n++) {
        const int64_t tick_us = llround((double)n * period_us);
        if (tick_us > last_us || tick_us >= options->until_us) {
            break;
        }
        if (nav_motion_covers(&s.motion, tick_us)) {
            const double now_s = (double)(tick_us - first_us) * 1e-6;
            failed = put_minor_frame(&s, n, tick_us) != 0 || put_weather(&s, now_s) != 0 ||
                             put_live(&s, now_s, first_us) != 0 ||
                             put_exercise(&s, now_s, first_us) != 0
                         ? -1
                         : 0;
            active++;
        }
        hs_progress_update(&progress, tick_us > first_us ? (uint64_t)(tick_us - first_us) : 0);
    }
    hs_progress_end(&progress);
    *sent = (struct nav_sent){.frames = s.frames, .active_s = (double)active * period_us * 1e-6};
    return failed;
}
