/* Ends of an echo's way: transmitter and receiver, each at a distance or so far away that its waves
 * are plane (records.h, struct trace_ends). The usual radar is both, far away.
 *
 * PLACES. With way_m the way from the transmitter to the receiver, and c the direction cosine of
 * the echo to the right of an end's line of sight,
 *     range_m  = (way_m - the two distances) / 2
 *     across_m = mean of (distance c) of both ends
 * as polar formatting has it. Places of one range lie on an ellipsoid about the two ends, or a
 * sphere about the radar. Far away it is eq. (2) and (3) of [Niu].
 *
 * POWER is that at the scene's centre: a ray stands for the area on the plane at the centre that
 * has its solid angle, and what comes back goes by the square of the receiver's distance. A point
 * thus goes by the fourth power of range. */
#ifndef TRACER_ENDS_H
#define TRACER_ENDS_H

#include "tracer/sensor.h"

#include <stdbool.h>

struct end {
    struct trace_axes axes;
    double distance_m; /* 0: plane waves */
};

struct ends {
    struct end out, back; /* transmitter, receiver */
};

/* One radar, far away: nothing of this header is needed. */
bool ends_are_plain(const struct trace_ends *e);

/* In axes in which the transmitter's azimuth is `azimuth_deg`: look->azimuth_deg gives the model's,
 * ENDS_OF_PICTURE those of records.h: across, away, up. */
#define ENDS_OF_PICTURE 90.0
struct ends ends_of(const struct trace_look *look, const struct trace_ends *e, double azimuth_deg);

/* A place as an end sees it. */
struct end_view {
    struct vec along; /* from the end to the place, of unit length */
    double way_m;     /* likewise, less the end's distance */
    double across_m;  /* distance times direction cosine */
};
struct end_view end_view(const struct end *e, struct vec place);

/* Primary ray through a place of the transmitter's plane, which is where it is taken to begin. */
struct ends_primary {
    struct vec from, along;
    double way_m, across_m; /* at `from` */
};
struct ends_primary ends_primary(const struct ends *e, double across_m, double up_m);

/* The plane for ends that are not plain. Its rays meet the ground of the whole picture and all of
 * the model, each cell of ground by at least 2 rays_per_cell either way: they are not in step with
 * the cells. */
struct trace_sensor ends_sensor_for(const struct scene *s, const struct trace_order *o);

/* As trace_ground_half_m(), for any ends. */
double ends_ground_half_m(const struct trace_order *o);

/* Does the order make sense? Refused: an end within or below the model, a picture that reaches
 * below an end, azimuths more than ENDS_APART_MAX_DEG apart. Returns 0, or -1
 * reported. */
#define ENDS_APART_MAX_DEG 120.0
int ends_check(const struct scene *s, const struct trace_order *o);

/* Area of the plane at the centre that a ray stands for, m^2. */
double ends_ray_m2(const struct trace_records *r, uint32_t ray);

/* Power at the receiver from a place (axes of records.h), over that from the centre. */
double ends_gain(const struct ends *picture, struct vec place);

/* The area that the echo of record t of bounce b counts for: both of the above. */
double ends_echo_m2(const struct trace_records *r, uint32_t b, const struct trace_record *t);

#endif
