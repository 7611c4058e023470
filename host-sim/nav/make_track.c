#include "nav/make_track.h"

#include <math.h>

enum { INTERVAL_US = 100000 };

static struct nav_fix level_fix(int64_t time_us, double height_m, double speed_ms)
{
    struct nav_fix f = nav_fix_blank();
    f.time_us = time_us;
    f.height_m = height_m;
    f.speed_ms = speed_ms;
    f.climb_ms = 0;
    f.pitch_deg = 0;
    return f;
}

int nav_make_circle(const struct nav_circle *c, int64_t begin_us, double seconds,
                    struct nav_track *t)
{
    const double degree = 3.14159265358979323846 / 180.0;
    const double gravity = 9.80665;
    const double turn_deg_s = c->speed_ms / c->radius_m / degree;
    struct geod_geodesic earth;
    geod_init(&earth, 6378137.0, 1 / 298.257223563);
    for (int64_t at_us = 0; (double)at_us <= seconds * 1e6; at_us += INTERVAL_US) {
        struct nav_fix f = level_fix(begin_us + at_us, c->height_m, c->speed_ms);
        const double bearing = c->start_deg + turn_deg_s * (double)at_us * 1e-6;
        double outward; /* the bearing away from the centre, at the aircraft */
        geod_direct(&earth, c->latitude_deg, c->longitude_deg, nav_wrap_180(bearing),
                    fabs(c->radius_m), &f.latitude_deg, &f.longitude_deg, &outward);
        f.track_deg = nav_wrap_180(outward + (c->radius_m > 0 ? 90.0 : -90.0));
        f.heading_deg = f.track_deg;
        f.roll_deg = atan(c->speed_ms * c->speed_ms / (gravity * c->radius_m)) / degree;
        if (nav_track_add(t, &f) != 0) {
            return -1;
        }
    }
    return 0;
}

int nav_make_straight(const struct nav_straight *s, int64_t begin_us, double seconds,
                      struct nav_track *t)
{
    struct geod_geodesic earth;
    geod_init(&earth, 6378137.0, 1 / 298.257223563);
    for (int64_t at_us = 0; (double)at_us <= seconds * 1e6; at_us += INTERVAL_US) {
        struct nav_fix f = level_fix(begin_us + at_us, s->height_m, s->speed_ms);
        geod_direct(&earth, s->latitude_deg, s->longitude_deg, s->heading_deg,
                    s->speed_ms * (double)at_us * 1e-6, &f.latitude_deg, &f.longitude_deg,
                    &f.track_deg);
        f.heading_deg = f.track_deg;
        f.roll_deg = 0;
        if (nav_track_add(t, &f) != 0) {
            return -1;
        }
    }
    return 0;
}
