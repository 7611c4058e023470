#include "nav/reading.h"

#include "hs/error.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>

int nav_bad_line(struct nav_reading *r, long line, const char *cause, ...)
{
    char place[512], text[256];
    snprintf(place, sizeof place, "%s line %ld", r->name, line);
    va_list arguments;
    va_start(arguments, cause);
    vsnprintf(text, sizeof text, cause, arguments);
    va_end(arguments);
    if (r->is_strict) {
        return hs_error(place, "correct the line, or leave out --strict to pass over it", "%s",
                        text);
    }
    if (r->malformed + r->disordered < NAV_WARNINGS_SHOWN) {
        hs_warn(place, NULL, "left out: %s", text);
    }
    return 0;
}

/* Angles of attitude and velocities are refused beyond what any aircraft does, because such a value
 * is a broken column and not a flight. */
static const char *first_fault(const struct nav_fix *f)
{
    if (!(fabs(f->latitude_deg) <= 90)) {
        return "the latitude is not within -90..90";
    }
    if (!(fabs(f->longitude_deg) <= 360)) {
        return "the longitude is not within -360..360";
    }
    if (fabs(f->height_m) > 100000) {
        return "the altitude is beyond 100 km";
    }
    if (f->speed_ms < 0 || f->speed_ms > 10000) {
        return "the ground speed is negative or beyond 10 km/s";
    }
    if (fabs(f->climb_ms) > 10000) {
        return "the vertical rate is beyond 10 km/s";
    }
    if (fabs(f->track_deg) > 360 || fabs(f->heading_deg) > 360 || fabs(f->roll_deg) > 360) {
        return "an angle is beyond 360 degrees";
    }
    if (fabs(f->pitch_deg) > 90) {
        return "the pitch is beyond 90 degrees";
    }
    return NULL;
}

int nav_accept(struct nav_track *t, struct nav_reading *r, const struct nav_fix *fix, long line)
{
    const char *fault = first_fault(fix);
    if (fault) {
        const int result = nav_bad_line(r, line, "%s", fault);
        r->malformed++;
        return result;
    }
    if (!r->is_route && t->count > 0 && fix->time_us <= t->fix[t->count - 1].time_us) {
        const int result = nav_bad_line(r, line, "its time is not after that of the fix before it");
        r->disordered++;
        return result;
    }
    struct nav_fix f = *fix;
    f.longitude_deg = nav_wrap_180(f.longitude_deg);
    f.time_us = r->is_route ? 0 : f.time_us;
    return nav_track_add(t, &f);
}
