/* Schedule: which items go out in a minor frame of the bus, and when in it. */
#ifndef NAV_SCHEDULE_H
#define NAV_SCHEDULE_H

#include "nav/canas.h"
#include "nav/send.h"

enum { NAV_MINOR_US = 12500 }; /* 80 Hz */

/* Where the values come from. `kinematics` leaves latitude, longitude and height alone, and
 * `position` all else. */
struct nav_source {
    void (*kinematics)(void *context, int64_t time_us, struct nav_state *state);
    void (*position)(void *context, int64_t time_us, struct nav_state *state);
    void *context;
};

/* Where the frames go. Returns 0, or -1 to give up. */
struct nav_sink {
    int (*put)(void *context, const struct canas_frame *frame, int64_t time_us);
    void *context;
};

struct nav_schedule {
    const struct nav_send_options *options; /* borrowed */
    enum nav_datum datum;
    struct nav_source source;
    struct nav_sink sink;
    int64_t utc_ahead_us; /* of the clock that is told */
    struct nav_state state;
    struct canas_codes codes;
    int64_t slot_us; /* when the next frame goes out */
    uint64_t frames;
};

/* Set everything but options, datum, source and sink. */
void nav_schedule_begin(struct nav_schedule *s);

/* The frames of the minor frame `number`, which begins at `tick_us`. The log began at `first_us`.
 * Returns 0, or -1 when the sink gave up. */
int nav_schedule_put(struct nav_schedule *s, uint64_t number, int64_t tick_us, int64_t first_us);

#endif
