/* Features of an OpenStreetMap store, for vectors/source.h. */
#ifndef VECTORS_OSM_SOURCE_H
#define VECTORS_OSM_SOURCE_H

#include "osm_store.h"
#include "vectors/source.h"

/* The area that the file's head names, or else where its nodes lie; false when it has none. */
bool osm_source_area(const struct osm_store *s, struct vector_area *area);

int osm_source_add(struct vector_source *source, struct vector_map *map);

#endif
