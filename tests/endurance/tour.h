/* A tour round the Earth along 0 and 180 degrees of longitude, over both poles, and the bus that
 * tells it: everything is a function of the time since its begin. */
#ifndef TOUR_H
#define TOUR_H

#include "lm/port.h"

#include <stdbool.h>
#include <stdint.h>

enum {
    TOUR_PLACES = 4,
    TOUR_FRAMES = 80,      /* of a tick, at most */
    TOUR_TICK_US = 50000,  /* between two sets of navigation frames */
    TOUR_MIDNIGHT_S = 7200 /* the exercise's first midnight; then, too, a place is circled */
};

/* A map is here, and the aircraft circles over it, to both sides of the meridian in turn. */
struct tour_place {
    const char *name;
    double latitude_deg, longitude_deg;
};
extern const struct tour_place tour_places[TOUR_PLACES];

struct tour_point {
    double latitude_deg, longitude_deg, track_deg, speed_m_s, turn_deg_s;
    int circling;       /* the place over which it circles, or -1 on the way to the next one */
    double distance_km; /* to the nearest place's middle; of what is far away, far */
    uint64_t lap;
};
struct tour_point tour_at(uint64_t world_us);

/* Length of a lap. */
uint64_t tour_lap_us(void);

/* The frames of a tick, which came at its beginning; their times are those of the tour. Returns
 * how many. */
uint32_t tour_frames(uint64_t tick, struct lm_can_frame frames[TOUR_FRAMES]);

#endif
