#include "nav/track.h"

#include "hs/error.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

struct nav_fix nav_fix_blank(void)
{
    return (struct nav_fix){.latitude_deg = NAN,
                            .longitude_deg = NAN,
                            .height_m = NAN,
                            .geoid_m = NAN,
                            .speed_ms = NAN,
                            .track_deg = NAN,
                            .climb_ms = NAN,
                            .heading_deg = NAN,
                            .pitch_deg = NAN,
                            .roll_deg = NAN};
}

int nav_track_add(struct nav_track *t, const struct nav_fix *fix)
{
    if (t->count == t->capacity) {
        const size_t capacity = t->capacity ? 2 * t->capacity : 1024;
        struct nav_fix *grown = realloc(t->fix, capacity * sizeof *grown);
        if (!grown) {
            return hs_error("track", "cut it into parts", "out of memory after %zu fixes",
                            t->count);
        }
        t->fix = grown;
        t->capacity = capacity;
    }
    t->fix[t->count++] = *fix;
    return 0;
}

void nav_track_free(struct nav_track *t)
{
    free(t->fix);
    *t = (struct nav_track){0};
}

double nav_wrap_180(double deg)
{
    const double wrapped = fmod(deg + 180.0, 360.0);
    return wrapped < 0 ? wrapped + 180.0 : wrapped - 180.0;
}

static double seconds_between(const struct nav_fix *a, const struct nav_fix *b)
{
    return (double)(b->time_us - a->time_us) * 1e-6;
}

size_t nav_track_settle_heights(struct nav_track *t)
{
    size_t barometric = 0, others = 0, with_geoid = 0, left_out = 0;
    for (size_t i = 0; i < t->count; i++) {
        const struct nav_fix *f = &t->fix[i];
        const bool is_other = !isnan(f->height_m) && !f->is_barometric;
        barometric += !isnan(f->height_m) && f->is_barometric;
        others += is_other;
        with_geoid += is_other && !isnan(f->geoid_m);
    }
    const bool has_geoid = others > 0 && with_geoid == others;
    t->datum = others == 0 && barometric > 0 ? NAV_DATUM_BAROMETRIC
               : has_geoid || others == 0    ? NAV_DATUM_ELLIPSOID
                                             : NAV_DATUM_SEA_LEVEL;
    for (size_t i = 0; i < t->count && t->datum != NAV_DATUM_BAROMETRIC; i++) {
        struct nav_fix *f = &t->fix[i];
        left_out += !isnan(f->height_m) && f->is_barometric;
        f->height_m = f->is_barometric ? NAN : f->height_m + (has_geoid ? f->geoid_m : 0);
    }
    return left_out;
}

static bool is_same_place(const struct nav_fix *a, const struct nav_fix *b)
{
    return a->latitude_deg == b->latitude_deg && a->longitude_deg == b->longitude_deg;
}

static double speed_between(const struct geod_geodesic *earth, const struct nav_fix *a,
                            const struct nav_fix *b)
{
    double distance_m;
    geod_inverse(earth, a->latitude_deg, a->longitude_deg, b->latitude_deg, b->longitude_deg,
                 &distance_m, NULL, NULL);
    return distance_m / seconds_between(a, b);
}

size_t nav_track_drop_repeats(struct nav_track *t)
{
    const double moving_ms = 5;
    struct geod_geodesic earth;
    geod_init(&earth, 6378137.0, 1 / 298.257223563);
    size_t kept = 0, dropped = 0;
    for (size_t i = 0, end; i < t->count; i = end) {
        for (end = i + 1; end < t->count && is_same_place(&t->fix[i], &t->fix[end]) &&
                          !t->fix[end].starts_leg;) {
            end++;
        }
        const struct nav_fix *before = kept > 0 ? &t->fix[kept - 1] : NULL;
        const bool is_stale = end > i + 1 && before && end < t->count &&
                              speed_between(&earth, before, &t->fix[i]) > moving_ms &&
                              speed_between(&earth, &t->fix[end - 1], &t->fix[end]) > moving_ms;
        const size_t count = is_stale ? 1 : end - i;
        memmove(&t->fix[kept], &t->fix[i], count * sizeof *t->fix);
        kept += count;
        dropped += end - i - count;
    }
    t->count = kept;
    return dropped;
}

static int compare_doubles(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double median_interval(const struct nav_track *t)
{
    const size_t n = t->count - 1;
    double *interval = n > 0 ? malloc(n * sizeof *interval) : NULL;
    if (!interval) {
        return 0;
    }
    for (size_t i = 0; i < n; i++) {
        interval[i] = seconds_between(&t->fix[i], &t->fix[i + 1]);
    }
    qsort(interval, n, sizeof *interval, compare_doubles);
    const double median = interval[n / 2];
    free(interval);
    return median;
}

static void mark_breaks(struct nav_track *t, const struct nav_limits *limits,
                        const struct geod_geodesic *earth, struct nav_findings *found)
{
    t->fix[0].starts_leg = true;
    for (size_t i = 1; i < t->count; i++) {
        const struct nav_fix *a = &t->fix[i - 1];
        struct nav_fix *b = &t->fix[i];
        const double dt = seconds_between(a, b);
        double distance_m;
        geod_inverse(earth, a->latitude_deg, a->longitude_deg, b->latitude_deg, b->longitude_deg,
                     &distance_m, NULL, NULL);
        b->starts_leg = b->starts_leg || dt > found->max_gap_s;
        b->is_jump = !b->starts_leg && distance_m > limits->max_speed_ms * dt;
        found->gaps += b->starts_leg;
        found->jumps += b->is_jump;
        found->holds += is_same_place(a, b);
    }
    for (size_t i = 0; i < t->count; i++) {
        found->isolated += t->fix[i].starts_leg && (i + 1 == t->count || t->fix[i + 1].starts_leg);
    }
}

/* Was the way from fix i to fix i + 1 flown, so that speeds may be taken from it? */
static bool is_flown(const struct nav_track *t, size_t i)
{
    return i + 1 < t->count && !t->fix[i + 1].starts_leg && !t->fix[i + 1].is_jump;
}

/* The fixes on either side of i that were reached by flying, or i itself. */
static void neighbours(const struct nav_track *t, size_t i, const struct nav_fix **before,
                       const struct nav_fix **after)
{
    *before = &t->fix[i > 0 && is_flown(t, i - 1) ? i - 1 : i];
    *after = &t->fix[is_flown(t, i) ? i + 1 : i];
}

static void fill_heights(struct nav_track *t)
{
    double last = 0;
    for (size_t i = 0; i < t->count; i++) {
        t->has_height = t->has_height || !isnan(t->fix[i].height_m);
        last = isnan(t->fix[i].height_m) ? last : t->fix[i].height_m;
        t->fix[i].height_m = last;
    }
}

/* A standing aircraft has no track of its own, so it keeps the one it stopped with. */
static void fill_velocity(struct nav_track *t, const struct geod_geodesic *earth)
{
    double last_track = 0;
    for (size_t i = 0; i < t->count; i++) {
        struct nav_fix *f = &t->fix[i];
        const struct nav_fix *a, *b;
        neighbours(t, i, &a, &b);
        const double dt = seconds_between(a, b);
        double distance_m = 0, azimuth = last_track, azimuth_end;
        if (dt > 0) {
            geod_inverse(earth, a->latitude_deg, a->longitude_deg, b->latitude_deg,
                         b->longitude_deg, &distance_m, &azimuth, &azimuth_end);
            const double at_fix = f == a ? 0 : f == b ? 1 : 0.5;
            azimuth += at_fix * nav_wrap_180(azimuth_end - azimuth);
        }
        if (isnan(f->speed_ms)) {
            f->speed_ms = dt > 0 ? distance_m / dt : 0;
        }
        if (isnan(f->climb_ms)) {
            f->climb_ms = dt > 0 ? (b->height_m - a->height_m) / dt : 0;
        }
        if (isnan(f->track_deg)) {
            f->track_deg = distance_m > 0 ? azimuth : last_track;
        }
        last_track = f->track_deg;
    }
}

enum { STEEPEST_BANK_DEG = 75 };

static void fill_attitude(struct nav_track *t)
{
    const double degree = 3.14159265358979323846 / 180.0;
    const double gravity = 9.80665;
    for (size_t i = 0; i < t->count; i++) {
        struct nav_fix *f = &t->fix[i];
        const struct nav_fix *a, *b;
        neighbours(t, i, &a, &b);
        if (isnan(f->heading_deg)) {
            f->heading_deg = f->track_deg;
        }
        if (isnan(f->pitch_deg)) {
            f->pitch_deg = f->speed_ms > 0 ? atan2(f->climb_ms, f->speed_ms) / degree : 0;
        }
        if (isnan(f->roll_deg)) {
            const double dt = seconds_between(a, b);
            const double turn =
                dt > 0 ? nav_wrap_180(b->track_deg - a->track_deg) * degree / dt : 0;
            const double bank = atan(f->speed_ms * turn / gravity) / degree;
            f->roll_deg = fmax(-STEEPEST_BANK_DEG, fmin(STEEPEST_BANK_DEG, bank));
        }
    }
}

void nav_track_complete(struct nav_track *t, const struct nav_limits *limits,
                        struct nav_findings *found)
{
    struct geod_geodesic earth;
    geod_init(&earth, 6378137.0, 1 / 298.257223563);
    *found = (struct nav_findings){0};
    found->span_s = seconds_between(&t->fix[0], &t->fix[t->count - 1]);
    found->median_interval_s = median_interval(t);
    found->max_gap_s =
        limits->max_gap_s > 0 ? limits->max_gap_s : fmax(30.0, 3.0 * found->median_interval_s);
    mark_breaks(t, limits, &earth, found);
    fill_heights(t);
    fill_velocity(t, &earth);
    fill_attitude(t);
}

void nav_motion_init(struct nav_motion *m, const struct nav_track *track)
{
    m->track = track;
    m->segment = 0;
    m->line_segment = SIZE_MAX;
    geod_init(&m->earth, 6378137.0, 1 / 298.257223563);
}

/* Put the finger on the last fix not after the instant. */
static void move_to(struct nav_motion *m, int64_t time_us)
{
    const struct nav_track *t = m->track;
    while (m->segment > 0 && time_us < t->fix[m->segment].time_us) {
        m->segment--;
    }
    while (m->segment + 1 < t->count && time_us >= t->fix[m->segment + 1].time_us) {
        m->segment++;
    }
}

bool nav_motion_covers(struct nav_motion *m, int64_t time_us)
{
    move_to(m, time_us);
    const struct nav_track *t = m->track;
    const size_t i = m->segment;
    return time_us == t->fix[i].time_us ||
           (time_us > t->fix[i].time_us && i + 1 < t->count && !t->fix[i + 1].starts_leg);
}

/* How far the instant is from fix[segment] to the next, 0..1; 0 where nothing was flown. */
static double fraction_at(const struct nav_motion *m, int64_t time_us)
{
    const struct nav_fix *a = &m->track->fix[m->segment];
    if (!is_flown(m->track, m->segment) || time_us <= a->time_us) {
        return 0;
    }
    return (double)(time_us - a->time_us) / (double)(a[1].time_us - a->time_us);
}

static double between(double a, double b, double fraction)
{
    return a + (b - a) * fraction;
}

static double between_angles(double a, double b, double fraction)
{
    return nav_wrap_180(a + nav_wrap_180(b - a) * fraction);
}

/* Body rates from the rates of the Euler angles (heading, pitch, roll), e.g. Etkin, "Dynamics of
 * Atmospheric Flight", 1972, eq. 4.4.7. */
static void body_rates(const struct nav_fix *a, const struct nav_fix *b, struct nav_state *s)
{
    const double degree = 3.14159265358979323846 / 180.0;
    const double dt = seconds_between(a, b);
    const double roll = nav_wrap_180(b->roll_deg - a->roll_deg) / dt;
    const double pitch = (b->pitch_deg - a->pitch_deg) / dt;
    const double heading = nav_wrap_180(b->heading_deg - a->heading_deg) / dt;
    const double sin_roll = sin(s->roll_deg * degree), cos_roll = cos(s->roll_deg * degree);
    const double sin_pitch = sin(s->pitch_deg * degree), cos_pitch = cos(s->pitch_deg * degree);
    s->roll_rate = roll - heading * sin_pitch;
    s->pitch_rate = pitch * cos_roll + heading * cos_pitch * sin_roll;
    s->yaw_rate = heading * cos_pitch * cos_roll - pitch * sin_roll;
}

void nav_motion_kinematics(struct nav_motion *m, int64_t time_us, struct nav_state *s)
{
    move_to(m, time_us);
    const double degree = 3.14159265358979323846 / 180.0;
    const double fraction = fraction_at(m, time_us);
    const struct nav_fix *a = &m->track->fix[m->segment];
    const struct nav_fix *b = is_flown(m->track, m->segment) ? a + 1 : a;
    s->speed_ms = between(a->speed_ms, b->speed_ms, fraction);
    s->climb_ms = between(a->climb_ms, b->climb_ms, fraction);
    const double track = between_angles(a->track_deg, b->track_deg, fraction);
    s->track_deg = track < 0 ? track + 360.0 : track;
    s->east_ms = s->speed_ms * sin(track * degree);
    s->north_ms = s->speed_ms * cos(track * degree);
    s->heading_deg = between_angles(a->heading_deg, b->heading_deg, fraction);
    s->pitch_deg = between(a->pitch_deg, b->pitch_deg, fraction);
    s->roll_deg = between_angles(a->roll_deg, b->roll_deg, fraction);
    s->roll_rate = s->pitch_rate = s->yaw_rate = 0;
    if (b != a) {
        body_rates(a, b, s);
    }
}

void nav_motion_position(struct nav_motion *m, int64_t time_us, struct nav_state *s)
{
    move_to(m, time_us);
    const double fraction = fraction_at(m, time_us);
    const struct nav_fix *a = &m->track->fix[m->segment];
    s->latitude_deg = a->latitude_deg;
    s->longitude_deg = a->longitude_deg;
    s->height_m = a->height_m;
    if (fraction <= 0) {
        return;
    }
    if (m->line_segment != m->segment) {
        geod_inverseline(&m->line, &m->earth, a->latitude_deg, a->longitude_deg, a[1].latitude_deg,
                         a[1].longitude_deg, GEOD_LATITUDE | GEOD_LONGITUDE | GEOD_DISTANCE_IN);
        m->line_segment = m->segment;
    }
    geod_position(&m->line, fraction * m->line.s13, &s->latitude_deg, &s->longitude_deg, NULL);
    s->height_m = between(a->height_m, a[1].height_m, fraction);
}
