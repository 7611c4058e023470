/* Sender of a track: a completed track turned into the lines of a candump log. */
#ifndef NAV_SEND_H
#define NAV_SEND_H

#include "nav/exercise.h"
#include "nav/live.h"
#include "nav/track.h"
#include "nav/weather.h"

#include <stdint.h>
#include <stdio.h>

enum nav_position { NAV_POSITION_DOUBLE, NAV_POSITION_FLOAT, NAV_POSITION_LONG };

struct nav_send_options {
    const char *interface;      /* name in the log, at most 15 characters */
    enum nav_position position; /* how 1036 and 1037 carry degrees; LONG is 1e-7 degree */
    double rate_scale;          /* multiplies every rate; NAV_RATE_SCALE_MIN..MAX */
    int64_t from_us, until_us;  /* only frames of instants in [from, until) */
    struct nav_weather weather;
    struct nav_exercise exercise;
    struct nav_live live;
};

#define NAV_RATE_SCALE_MIN 0.0125
#define NAV_RATE_SCALE_MAX 4.0

struct nav_sent {
    uint64_t frames;
    double active_s; /* how long the bus was in use, gaps not counted */
};

/* The frames of one minor frame of 12.5 ms (rate scale 1): attitude in each, positions and speeds
 * in every 8th, time and date in every 80th, on a grid aligned to whole seconds of UTC; 125 us
 * apart in ascending identifier, which is how the bus's arbitration would order them. Every value
 * is that of the instant its frame is sent; latitude, longitude and height belong to one instant,
 * that of the last frame of longitude. Weather, live targets and the exercise come behind these,
 * once a second whatever the rate scale. Nothing is sent in gaps.
 *
 * Writes the log to `out` and reports the sum. Returns 0, or -1 when `out` cannot be written
 * (reported by whoever closes it). Cost: about 1 us a frame. */
int nav_send(const struct nav_track *track, const struct nav_send_options *options, FILE *out,
             struct nav_sent *sent);

#endif
