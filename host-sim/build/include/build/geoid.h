/* Geoid of an image: heights of mean sea level above the ellipsoid at the nodes of a grid over its
 * area, from a model of the whole Earth. */
#ifndef BUILD_GEOID_H
#define BUILD_GEOID_H

#include "image/grid.h"
#include "image/writer.h"
#include "lm/geoid.h"

/* Make the grid that covers `area` with at most LM_GEOID_NODES_MAX nodes a side, 5' apart or more.
 * `source` is "egm96", which PROJ has (package proj-data), or a raster of metres in any CRS that
 * covers the area (.gtx, GeoTIFF). Prints what was made, and how much is lost between nodes.
 * Returns 0, or -1 with the error reported:
 * - PROJ has no grid of EGM96, or the raster cannot be read,
 * - a node has no height, or one that no place on Earth has (-120..120 m). */
int build_geoid_make(struct lm_geoid *g, const struct image_area *area, const char *source);

/* Make the pages of an area into *section, whose data the caller frees: squares of 22.5 degrees
 * with nodes 0.7 degrees apart. Only where the nodes of `g`, its grid, are farther apart than that;
 * else *section stays empty. Nodes that the source does not have are those of `g`. Prints what was
 * made. Returns 0, or -1 with the error reported. */
int build_geoid_pages_make(struct image_bytes *section, const struct lm_geoid *g,
                           const struct image_area *area, const char *source);

#endif
