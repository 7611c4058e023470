/* Ray tracing of the radar signal: [Niu], step 2, after its section II-A. */
#ifndef TRACER_TRACE_H
#define TRACER_TRACE_H

#include "tracer/records.h"
#include "tracer/scene.h"

/* The chip of [Niu]: 54 x 54 pixels of 0.2 m, traced in cells of half that; X band. */
#define TRACE_CHIP_CELLS   108
#define TRACE_CHIP_CELL_M  0.1
#define TRACE_WAVELENGTH_M 0.03123 /* 9.6 GHz */

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
};

/* The plane that sees the grid's ground and every part of the scene's bounds that could be focused
 * in the grid. Its steps are cell / rays_per_cell to the right and cell / rays_per_cell * tan
 * (depression) up, or at most as much as to the right: so on level ground each cell, of slant
 * range, is met by the same number of rays, and one ray stands for the same area of the plane
 * everywhere. */
struct trace_sensor trace_sensor_for(const struct scene *s, const struct trace_order *o);

/* Half the side of a square of ground that covers the grid from every side. */
double trace_ground_half_m(const struct trace_grid *grid, double depression_deg);

/* Trace all rays. Where an echo is focused (eq. 2-4): with A where the primary ray leaves the
 * plane, B where the last comes back to it,
 *     across = (A + B) / 2,   range = (way from A to B) / 2 - (plane to scene's centre).
 * Eq. (4) as printed halves the range once more; a point target then lies at half its distance
 * from the centre, so it is not done here (tested with points of known places).
 * Returns 0, or -1 with the error reported with `place` and *r empty. `rays_cast`, when not NULL,
 * gets the number of rays followed, drawn or cast: primary, specular and backward. */
int trace_run(const struct scene *s, const struct trace_order *o, const char *place,
              struct trace_records *r, uint64_t *rays_cast);

#endif
