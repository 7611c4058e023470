/* What the readers of both OpenStreetMap formats share. */
#ifndef VECTORS_OSM_READING_H
#define VECTORS_OSM_READING_H

#include "vectors/osm_file.h"

/* Room for `count` entries of `size` bytes in an array that grows by doubling. Returns false when
 * memory is short; the array is then as it was. */
bool osm_room(void **array, size_t *capacity, size_t count, size_t size);

#endif
