/* Sources of an import: a file of OpenStreetMap, or any vector file that GDAL reads. Each element
 * is counted once, with what became of it (vectors/census.h).
 *
 * Usage: vector_source_open, vector_source_add once the map is laid, vector_source_close. */
#ifndef VECTORS_SOURCE_H
#define VECTORS_SOURCE_H

#include "vectors/map.h"

struct osm_store;

struct vector_source {
    const char *path;        /* borrowed */
    struct osm_store *store; /* owned; of OpenStreetMap */
    GDALDatasetH file;       /* owned; of other formats */
    bool has_area;
    struct vector_area area; /* what the file's head says, or where its places lie */
    struct vector_census census;
};

/* Open a file and find its area. Returns 0, or -1 with the error reported and nothing to close: it
 * cannot be read (osm_file_read), GDAL knows no such format, or it has no vector layer.
 *
 * Cost: a file of OpenStreetMap is kept in memory, some 24 bytes a node and 8 a reference. */
int vector_source_open(struct vector_source *s, const char *path);

/* Add what the map's rules fit. Returns 0, or -1 with the error reported: no memory, a CRS that
 * cannot be brought to the plane, or a layer that cannot be read to its end. */
int vector_source_add(struct vector_source *s, struct vector_map *map);

/* Harmless on a zeroed struct. */
void vector_source_close(struct vector_source *s);

#endif
