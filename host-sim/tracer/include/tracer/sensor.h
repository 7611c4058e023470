/* Sensor of the tracer: the plane from which rays leave, and the axes that it looks along. */
#ifndef TRACER_SENSOR_H
#define TRACER_SENSOR_H

#include "tracer/records.h"
#include "tracer/scene.h"

/* Of the radar, in the model's axes: unit vectors to the right, level away, along the line of
 * sight, and up on the sensor's plane. */
struct trace_axes {
    struct vec across, away, sight, rise;
};
struct trace_axes trace_axes_of(const struct trace_look *look);

struct trace_order {
    struct trace_look look;
    struct trace_grid grid;
    uint32_t rays_per_cell; /* 1..16 either way, in a cell of level ground */
    uint32_t bounces;       /* 1..TRACE_BOUNCES_MAX */
    uint32_t threads;       /* 1..64; the records do not depend on it */
    struct trace_ends ends; /* 0: one radar, far away */
    bool casts_all;         /* nothing is drawn: for measurements. The records are as good */
};

/* The plane that sees the grid's ground and every part of the scene's bounds that could be focused
 * in the grid. Its steps are cell / rays_per_cell to the right and cell / rays_per_cell * tan
 * (depression) up, or at most as much as to the right: so on level ground each cell, of slant
 * range, is met by the same number of rays, and one ray stands for the same area of the plane
 * everywhere. Ends that are not plain: ends_sensor_for(). */
struct trace_sensor trace_sensor_for(const struct scene *s, const struct trace_order *o);

/* Half the side of a square of ground that covers the grid from every side. */
double trace_ground_half_m(const struct trace_grid *grid, double depression_deg);

#endif
