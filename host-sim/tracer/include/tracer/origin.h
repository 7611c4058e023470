/* Origin of an echo: where its ray was reflected, and how high it seems to come from. It follows
 * from the records alone. */
#ifndef TRACER_ORIGIN_H
#define TRACER_ORIGIN_H

#include "tracer/records.h"
#include "tracer/vec.h"

struct origin {
    struct vec places[TRACE_BOUNCES_MAX]; /* across, away, up (records.h): of each reflection */
    uint32_t count;                       /* of them */
    /* What tomography finds: the echo lies at `range` along the line of sight and this far up the
     * sensor's plane, the mean of where its ray left the plane and came back to it. After one
     * reflection that is the place itself; after two in a right angle the seam. Of one radar far
     * away: with other ends the two numbers mean nothing. */
    double elevation_m;
    double height_m; /* the same place's height above the ground */
};

/* Of record t of bounce b (from 0). Places are good to some 1e-5 of the way between them. */
struct origin origin_of(const struct trace_records *r, uint32_t b, const struct trace_record *t);

#endif
