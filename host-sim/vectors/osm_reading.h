/* What the readers of both OpenStreetMap formats share. */
#ifndef VECTORS_OSM_READING_H
#define VECTORS_OSM_READING_H

#include "vectors/osm_file.h"

#include <stdio.h>

/* Room for `count` entries of `size` bytes in an array that grows by doubling. Returns false when
 * memory is short; the array is then as it was. */
bool osm_room(void **array, size_t *capacity, size_t count, size_t size);

/* Length of an open file, for a progress bar; 1 when it has none. */
uint64_t osm_bytes(FILE *file);

#endif
