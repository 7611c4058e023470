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

bool nav_live_add_beacon(struct nav_live *l, const double *value, int count)
{
    if (count < 4 || count > 6 || !is_whole(value[1], 16) ||
        (count == 6 && !is_whole(value[5], 16))) {
        return false;
    }
    const double target[] = {
        value[0], NAV_LIVE_BEACON, value[2], value[3], 0, 0, count > 4 ? value[4] : -INFINITY};
    if (!nav_live_add(l, target, 7)) {
        return false;
    }
    l->item[l->count - 1].reply = (int)value[1] | (count == 6 ? (int)value[5] << 4 : 0);
    return true;
}

/* Whether the moment falls into the minor frame. */
static bool is_due(double at_s, double now_s, double period_s)
{
    return at_s >= now_s && at_s < now_s + period_s;
}

/* Where it is and goes. */
struct state {
    double latitude_deg, longitude_deg, height_m, course_deg, speed_ms;
};

/* Along the geodesic, or along the chord of its circle. */
static struct state straight_at(const struct nav_live_item *t, double seconds)
{
    struct geod_geodesic earth;
    struct state s = {.height_m = t->height_m, .speed_ms = t->speed_ms};
    const double half = t->turn_deg_s * seconds / 2, x = half * M_PI / 180;
    const double chord = fabs(x) < 1e-6 ? 1 : sin(x) / x;
    geod_init(&earth, 6378137.0, 1 / 298.257223563);
    geod_direct(&earth, t->latitude_deg, t->longitude_deg, t->course_deg + half,
                t->speed_ms * seconds * chord, &s.latitude_deg, &s.longitude_deg, &s.course_deg);
    s.course_deg += half;
    return s;
}

/* Along the geodesic from point `a` to the one behind it, `seconds` after it left. One that stands
 * has no course: `course_deg` is NAN. */
static struct state leg_at(const struct nav_live_point *a, double seconds)
{
    const struct nav_live_point *b = a + 1;
    struct geod_geodesic earth;
    struct state s;
    double way_m, from_deg;
    geod_init(&earth, 6378137.0, 1 / 298.257223563);
    geod_inverse(&earth, a->latitude_deg, a->longitude_deg, b->latitude_deg, b->longitude_deg,
                 &way_m, &from_deg, NULL);
    const double part = seconds / (b->at_s - a->at_s);
    geod_direct(&earth, a->latitude_deg, a->longitude_deg, from_deg, way_m * part, &s.latitude_deg,
                &s.longitude_deg, &s.course_deg);
    s.speed_ms = way_m / (b->at_s - a->at_s);
    s.height_m =
        isinf(a->height_m) ? a->height_m : a->height_m + (b->height_m - a->height_m) * part;
    s.course_deg = way_m < 0.01 ? (double)NAN : s.course_deg;
    return s;
}

/* On its route at a time. Where it stands, it faces as it came; at first, as it will go. */
static struct state route_at(const struct nav_live *l, const struct nav_live_item *t, double at_s)
{
    const struct nav_live_point *p = &l->point[t->first_point], *last = p + t->points - 1;
    const struct nav_live_point *leg = p;
    while (leg < last && leg[1].at_s <= at_s) {
        leg++;
    }
    struct state s = {leg->latitude_deg, leg->longitude_deg, leg->height_m, (double)NAN, 0};
    if (leg < last) {
        s = leg_at(leg, at_s - leg->at_s);
    }
    for (const struct nav_live_point *q = leg; isnan(s.course_deg) && q > p; q--) {
        s.course_deg = leg_at(q - 1, q->at_s - q[-1].at_s).course_deg;
    }
    for (const struct nav_live_point *q = leg; isnan(s.course_deg) && q < last; q++) {
        s.course_deg = leg_at(q, 0).course_deg;
    }
    s.course_deg = isnan(s.course_deg) ? 0 : s.course_deg;
    return s;
}

/* True in the first minor frame that begins at one of its points or behind it. */
static bool is_at_point(const struct nav_live *l, const struct nav_live_item *t, double now_s,
                        double period_s)
{
    bool is_at = false;
    for (int i = 0; i < t->points; i++) {
        const double at_s = l->point[t->first_point + i].at_s;
        is_at = is_at || (at_s <= now_s && at_s > now_s - period_s);
    }
    return is_at;
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

static int put_set(const struct nav_live_item *t, uint8_t code, const struct state *s,
                   struct canas_frame frames[NAV_LIVE_FRAMES])
{
    const bool has_height = s->height_m >= -1000;
    const int parts = (has_height ? HAS_HEIGHT : 0) | HAS_VELOCITY | HAS_HEADING;
    const float height = (float)s->height_m;
    uint32_t height_bits;
    memcpy(&height_bits, &height, sizeof height_bits);
    const double angle = s->course_deg * M_PI / 180, counts = s->speed_ms / 0.05;
    /* A heading of 180 degrees is 32768, which is -32768 in 16 bits. */
    const double heading = remainder(s->course_deg, 360) / 180 * 32768;
    int n = 0;
    frames[n++] =
        frame_of(CANAS_LIVE_KIND, CANAS_UCHAR4, t->number, code,
                 (uint32_t)t->kind << 24 | RPB << 16 | (uint32_t)t->reply << 8 | (uint32_t)parts);
    frames[n++] = frame_of(CANAS_LIVE_LATITUDE, CANAS_LONG, t->number, code,
                           (uint32_t)(int32_t)lround(s->latitude_deg * 1e7));
    frames[n++] = frame_of(CANAS_LIVE_LONGITUDE, CANAS_LONG, t->number, code,
                           (uint32_t)(int32_t)lround(s->longitude_deg * 1e7));
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
    if (!is_told || (!is_due(ceil(now_s - phase_s) + phase_s, now_s, period_s) &&
                     !is_at_point(l, t, now_s, period_s))) {
        return 0;
    }
    const struct state s =
        t->points > 0 ? route_at(l, t, sent_s) : straight_at(t, sent_s - t->from_s);
    return put_set(t, codes->next[CANAS_LIVE_KIND]++, &s, frames);
}
