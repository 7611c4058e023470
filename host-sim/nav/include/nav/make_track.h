/* Synthetic tracks: a circle and a straight line, with the attitude that flies them. */
#ifndef NAV_MAKE_TRACK_H
#define NAV_MAKE_TRACK_H

#include "nav/track.h"

struct nav_circle {
    double latitude_deg, longitude_deg; /* of the centre */
    double radius_m;                    /* positive: clockwise, right turn; negative: left turn */
    double height_m, speed_ms;          /* speed > 0 */
    double start_deg;                   /* bearing of the starting point from the centre */
};

struct nav_straight {
    double latitude_deg, longitude_deg; /* where it starts */
    double heading_deg;                 /* there; the line is a geodesic */
    double height_m, speed_ms;
};

/* Append fixes every 0.1 s over `seconds`, beginning at `begin_us`. On a circle of 1 km radius at
 * 100 m/s the straight way between two of them is within 13 mm of the circle. Return 0, or -1 when
 * memory is short (reported). */
int nav_make_circle(const struct nav_circle *c, int64_t begin_us, double seconds,
                    struct nav_track *t);
int nav_make_straight(const struct nav_straight *s, int64_t begin_us, double seconds,
                      struct nav_track *t);

#endif
