/* Ray tracing of the radar signal: [Niu], step 2, after its section II-A. */
#ifndef TRACER_TRACE_H
#define TRACER_TRACE_H

#include "tracer/records.h"
#include "tracer/scene.h"
#include "tracer/sensor.h"

/* The chip of [Niu]: 54 x 54 pixels of 0.2 m, traced in cells of half that; X band. */
#define TRACE_CHIP_CELLS   108
#define TRACE_CHIP_CELL_M  0.1
#define TRACE_WAVELENGTH_M 0.03123 /* 9.6 GHz */

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
