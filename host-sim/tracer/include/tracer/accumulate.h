/* Accumulation of echoes in the cells where they are focused: [Niu], step 4. */
#ifndef TRACER_ACCUMULATE_H
#define TRACER_ACCUMULATE_H

#include "tracer/records.h"
#include "tracer/reflect.h"

/* Add, for each record with an echo inside the grid, its intensity (records.h, INTENSITY) times the
 * area of plane that a ray stands for, m^2, to its cell of `picture`: cells_across * cells_range
 * numbers, near row first, cleared here. Returns 0, or -1 for lack of memory, reported. */
int accumulate(const struct trace_records *r, const struct reflect_law *law, float *picture);

#endif
