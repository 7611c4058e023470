#include "nav/live.h"

#include <geodesic.h>
#include <math.h>
#include <string.h>

enum { NODE_INSTRUCTOR = 30, HAS_HEIGHT = 1, HAS_VELOCITY = 2, HAS_HEADING = 4, RPB = 7 };

static bool is_whole(double value, int end)
{
    return value >= 0 && value < end && value == floor(value);
}

static bool is_sound(const struct nav_live_item *t)
{
    return fabs(t->latitude_deg) <= 90 && fabs(t->longitude_deg) <= 180 &&
           fabs(t->course_deg) <= 360 && t->speed_ms >= 0 && t->speed_ms <= 1000 &&
           t->height_m <= 16000 && fabs(t->turn_deg_s) <= 60 && t->from_s >= 0 &&
           t->until_s > t->from_s;
}

bool nav_live_add(struct nav_live *l, const double *value, int count)
{
    if (l->count == NAV_LIVE_MAX || count < 6 || count > 10 || !is_whole(value[0], NAV_LIVE_MAX) ||
        !is_whole(value[1], NAV_LIVE_KINDS)) {
        return false;
    }
    const struct nav_live_item t = {
        .number = (int)value[0],
        .kind = (int)value[1],
        .latitude_deg = value[2],
        .longitude_deg = value[3],
        .course_deg = value[4],
        .speed_ms = value[5],
        .height_m = count > 6 ? value[6] : -INFINITY,
        .turn_deg_s = count > 7 ? value[7] : 0,
        .from_s = count > 8 ? value[8] : 0,
        .until_s = count > 9 ? value[9] : INFINITY,
    };
    bool is_taken = false;
    for (int i = 0; i < l->count; i++) {
        is_taken = is_taken || l->item[i].number == t.number;
    }
    if (is_taken || !is_sound(&t)) {
        return false;
    }
    l->item[l->count++] = t;
    return true;
}

/* Whether the moment falls into the minor frame. */
static bool is_due(double at_s, double now_s, double period_s)
{
    return at_s >= now_s && at_s < now_s + period_s;
}

/* Where it is and goes: along the geodesic, or along the chord of its circle. */
static void place_at(const struct nav_live_item *t, double seconds, double *latitude_deg,
                     double *longitude_deg, double *course_deg)
{
    struct geod_geodesic earth;
    const double half = t->turn_deg_s * seconds / 2, x = half * M_PI / 180;
    const double chord = fabs(x) < 1e-6 ? 1 : sin(x) / x;
    geod_init(&earth, 6378137.0, 1 / 298.257223563);
    geod_direct(&earth, t->latitude_deg, t->longitude_deg, t->course_deg + half,
                t->speed_ms * seconds * chord, latitude_deg, longitude_deg, course_deg);
    *course_deg += half;
}

static uint32_t pair(double first, double second)
{
    return (uint32_t)(uint16_t)lround(first) << 16 | (uint16_t)lround(second);
}

static struct canas_frame frame_of(uint16_t id, enum canas_type type, int number, uint8_t code,
                                   uint32_t word)
{
    return (struct canas_frame){.id = id,
                                .length = 8,
                                .data = {NODE_INSTRUCTOR, (uint8_t)type, (uint8_t)number, code,
                                         (uint8_t)(word >> 24), (uint8_t)(word >> 16),
                                         (uint8_t)(word >> 8), (uint8_t)word}};
}

static int put_set(const struct nav_live_item *t, uint8_t code, double seconds,
                   struct canas_frame frames[NAV_LIVE_FRAMES])
{
    double latitude, longitude, course;
    place_at(t, seconds, &latitude, &longitude, &course);
    const bool has_height = t->height_m >= -1000;
    const int parts = (has_height ? HAS_HEIGHT : 0) | HAS_VELOCITY | HAS_HEADING;
    const float height = (float)t->height_m;
    uint32_t height_bits;
    memcpy(&height_bits, &height, sizeof height_bits);
    const double angle = course * M_PI / 180, counts = t->speed_ms / 0.05;
    /* A heading of 180 degrees is 32768, which is -32768 in 16 bits. */
    const double heading = remainder(course, 360) / 180 * 32768;
    int n = 0;
    frames[n++] = frame_of(CANAS_LIVE_KIND, CANAS_UCHAR4, t->number, code,
                           (uint32_t)t->kind << 24 | RPB << 16 | (uint32_t)parts);
    frames[n++] = frame_of(CANAS_LIVE_LATITUDE, CANAS_LONG, t->number, code,
                           (uint32_t)(int32_t)lround(latitude * 1e7));
    frames[n++] = frame_of(CANAS_LIVE_LONGITUDE, CANAS_LONG, t->number, code,
                           (uint32_t)(int32_t)lround(longitude * 1e7));
    if (has_height) {
        frames[n++] = frame_of(CANAS_LIVE_HEIGHT, CANAS_FLOAT, t->number, code, height_bits);
    }
    frames[n++] = frame_of(CANAS_LIVE_VELOCITY, CANAS_SHORT2, t->number, code,
                           pair(counts * sin(angle), counts * cos(angle)));
    frames[n++] = frame_of(CANAS_LIVE_HEADING, CANAS_SHORT2, t->number, code,
                           pair(heading, t->turn_deg_s * 100));
    return n;
}

int nav_live_frames(const struct nav_live *l, int index, struct canas_codes *codes, double now_s,
                    double period_s, double sent_s, struct canas_frame frames[NAV_LIVE_FRAMES])
{
    const struct nav_live_item *t = &l->item[index];
    if (is_due(t->until_s, now_s, period_s)) {
        frames[0] = canas_uchar(codes, CANAS_LIVE_REMOVE, NODE_INSTRUCTOR, 0);
        frames[0].data[2] = (uint8_t)t->number;
        return 1;
    }
    const double phase_s = (double)index / NAV_LIVE_MAX;
    const bool is_told = now_s >= t->from_s && now_s < t->until_s;
    if (!is_told || !is_due(ceil(now_s - phase_s) + phase_s, now_s, period_s)) {
        return 0;
    }
    return put_set(t, codes->next[CANAS_LIVE_KIND]++, sent_s - t->from_s, frames);
}
