/* A cloud of facets at random angles, as traced records: reflections of up to five bounces without
 * a ray tracer, and another "aspect" of the same target with each seed. */
#ifndef FACETS_H
#define FACETS_H

#include "tracer/records.h"

/* `side` x `side` rays over a picture of cells x cells of 0.1 m, materials 0 to 2. About half of
 * the rays go on after each bounce, one echo in ten is blocked, some lie outside. */
void facets_make(struct trace_records *r, uint64_t seed, uint32_t side, uint32_t cells);

#endif
