/* A material of which theory has closed forms. */
#ifndef METAL_H
#define METAL_H

#include "tracer/reflect.h"

/* Every material reflects everything and scatters nothing; at TRACE_WAVELENGTH_M. */
struct reflect_law metal_law(enum reflect_kind kind);

#endif
