/* The two readers of OpenStreetMap behind one door. */
#ifndef FUZZ_OSM_H
#define FUZZ_OSM_H

#include "fuzz.h"
#include "vectors/osm_file.h"

/* Read the input with `read` and look at everything that it gives to its sink. Returns 0. */
int fuzz_osm(const uint8_t *data, size_t size,
             int (*read)(const char *path, struct osm_sink *sink));

#endif
