/* Live targets on the bus: their frames as docs/bus.md, "Live targets", defines them. */
#ifndef NAV_LIVE_H
#define NAV_LIVE_H

#include "nav/canas.h"

#include <stdbool.h>

enum {
    NAV_LIVE_MAX = 256,
    NAV_LIVE_FRAMES = 6,
    NAV_LIVE_KINDS = 18,
    NAV_LIVE_BEACON = 17,
    NAV_LIVE_POINTS = 4096, /* of all routes */
    NAV_LIVE_SPEED_MOST_MS = 1000
};

/* Place of a route, and when the target is there. */
struct nav_live_point {
    double at_s, latitude_deg, longitude_deg;
    double height_m; /* as below, minus infinity: on the ground; alike in all points of a route */
};

/* A target that goes straight on or turns evenly, or follows a route; told once a second from
 * `from_s` until before `until_s`, seconds from the log's beginning, and then removed. */
struct nav_live_item {
    int number, kind;
    int reply; /* of a beacon: its code, and 16 times its delay in microseconds; else 0 */
    double latitude_deg, longitude_deg; /* at from_s */
    double course_deg, speed_ms;
    double height_m; /* above mean sea level; below -1000: on the ground */
    double turn_deg_s;
    double from_s, until_s;
    int first_point, points; /* of its route; 0 points: it has none */
};

struct nav_live {
    struct nav_live_item item[NAV_LIVE_MAX];
    int count;
    struct nav_live_point point[NAV_LIVE_POINTS]; /* route behind route */
    int point_count;
};

/* Take the numbers of --live NUMBER,KIND,LAT,LON,COURSE_DEG,SPEED_MS[,HEIGHT_M[,TURN_DEG_S
 * [,FROM_S[,UNTIL_S]]]]. False, with *l unchanged, when they are out of range, or the number is
 * taken. */
bool nav_live_add(struct nav_live *l, const double *value, int count);

/* Take the numbers of --beacon NUMBER,CODE,LAT,LON[,HEIGHT_M[,LATE_US]] likewise. */
bool nav_live_add_beacon(struct nav_live *l, const double *value, int count);

/* Add the targets of a file of routes. Times ascend, and no leg is faster than
 * NAV_LIVE_SPEED_MOST_MS. Returns 0, or -1 with the mistake reported. */
int nav_live_read(struct nav_live *l, const char *path);

/* The frames of target `index` to send in the minor frame that begins `now_s` after the log's
 * beginning and lasts `period_s`; returns how many. Its numbers are those of `sent_s`. Targets are
 * spread over the second by their index. One with a route is told at each of its points as well. */
int nav_live_frames(const struct nav_live *l, int index, struct canas_codes *codes, double now_s,
                    double period_s, double sent_s, struct canas_frame frames[NAV_LIVE_FRAMES]);

#endif
