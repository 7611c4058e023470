#include "schedule.h"

#include <math.h>
#include <stddef.h>
#include <time.h>

enum {
    NODE_AHRS = 1, /* node numbers of the specification's example aircraft */
    NODE_GPS = 9,
    SLOT_US = 125 /* one frame at 1 Mbit/s */
};

enum item_kind { VALUE, MAGNETIC, HEIGHT, LATITUDE, LONGITUDE, CLOCK, CALENDAR };

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
    {CANAS_MAGNETIC_HEADING, NODE_AHRS, 8, MAGNETIC, STATE(magnetic_deg)},
    {CANAS_MAGNETIC_VARIATION, NODE_AHRS, 8, MAGNETIC, STATE(variation_deg)},
    {CANAS_EAST_VELOCITY, NODE_GPS, 8, VALUE, STATE(east_ms)},
    {CANAS_NORTH_VELOCITY, NODE_GPS, 8, VALUE, STATE(north_ms)},
    {CANAS_UP_VELOCITY, NODE_GPS, 8, VALUE, STATE(climb_ms)},
    {CANAS_TRUE_HEADING, NODE_AHRS, 1, VALUE, STATE(heading_deg)},
    {CANAS_UTC, NODE_GPS, 80, CLOCK, 0},
    {CANAS_DATE, NODE_GPS, 80, CALENDAR, 0},
};

static int put(struct nav_schedule *s, const struct canas_frame *f)
{
    const int64_t time_us = s->slot_us;
    s->slot_us += SLOT_US;
    s->frames++;
    return s->sink.put(s->sink.context, f, time_us);
}

static int put_angle(struct nav_schedule *s, const struct item *item, double deg)
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

static int put_time(struct nav_schedule *s, const struct item *item, int64_t time_us)
{
    const time_t seconds = (time_t)((time_us + s->utc_ahead_us) / 1000000);
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

static int put_item(struct nav_schedule *s, const struct item *item, int64_t tick_us)
{
    const double *value = (const double *)(const void *)((const char *)&s->state + item->offset);
    const int frames = s->options->position == NAV_POSITION_DOUBLE ? 4 : 2;
    switch (item->kind) {
    case LATITUDE:
        s->source.position(s->source.context, s->slot_us + (frames - 1) * SLOT_US, &s->state);
        return put_angle(s, item, *value);
    case LONGITUDE:
        return put_angle(s, item, *value);
    case CLOCK:
    case CALENDAR:
        return put_time(s, item, tick_us);
    case HEIGHT:
        if (item->id != height_item(s->datum)) {
            return 0;
        }
        if (item->id != CANAS_GPS_HEIGHT) { /* that one belongs to the position before it */
            s->source.position(s->source.context, s->slot_us, &s->state);
        }
        break;
    case MAGNETIC: /* of a source that has none, NAN */
        s->source.kinematics(s->source.context, s->slot_us, &s->state);
        if (isnan(*value)) {
            return 0;
        }
        break;
    case VALUE:
        s->source.kinematics(s->source.context, s->slot_us, &s->state);
        break;
    }
    const struct canas_frame f = canas_float(&s->codes, item->id, item->node, *value);
    return put(s, &f);
}

static int put_weather(struct nav_schedule *s, double now_s)
{
    struct canas_frame frames[2 * NAV_WEATHER_EACH * NAV_WEATHER_FRAMES + 1];
    const double period_s = NAV_MINOR_US * 1e-6 / s->options->rate_scale;
    const int count = nav_weather_frames(&s->options->weather, &s->codes, now_s, period_s, frames);
    for (int i = 0; i < count; i++) {
        if (put(s, &frames[i]) != 0) {
            return -1;
        }
    }
    return 0;
}

static int put_live(struct nav_schedule *s, double now_s, int64_t first_us)
{
    const double period_s = NAV_MINOR_US * 1e-6 / s->options->rate_scale;
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

static int put_exercise(struct nav_schedule *s, double now_s, int64_t first_us)
{
    struct canas_frame frames[NAV_EXERCISE_FRAMES + 2 * NAV_MALFUNCTIONS];
    const double period_s = NAV_MINOR_US * 1e-6 / s->options->rate_scale;
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

static int put_items(struct nav_schedule *s, uint64_t number, int64_t tick_us)
{
    for (size_t i = 0; i < sizeof schedule / sizeof *schedule; i++) {
        if (number % schedule[i].every == 0 && put_item(s, &schedule[i], tick_us) != 0) {
            return -1;
        }
    }
    return 0;
}

void nav_schedule_begin(struct nav_schedule *s)
{
    s->utc_ahead_us = 0;
    s->state = (struct nav_state){.magnetic_deg = NAN, .variation_deg = NAN};
    s->codes = (struct canas_codes){{0}};
    s->slot_us = 0;
    s->frames = 0;
}

int nav_schedule_put(struct nav_schedule *s, uint64_t number, int64_t tick_us, int64_t first_us)
{
    const double now_s = (double)(tick_us - first_us) * 1e-6;
    s->slot_us = tick_us;
    return put_items(s, number, tick_us) != 0 || put_weather(s, now_s) != 0 ||
                   put_live(s, now_s, first_us) != 0 || put_exercise(s, now_s, first_us) != 0
               ? -1
               : 0;
}
