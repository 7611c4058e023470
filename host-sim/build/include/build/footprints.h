/* Footprints: the buildings of the detail, as cells of the finest level.
 *
 * A cell whose middle lies in a footprint becomes a structure, as high as the building, whatever
 * the class raster says: coarse pictures, which show the cells, then agree with fine ones, which
 * show the detail. Beside a footprint a pixel of the inputs mixes roof and ground. A classifier
 * easily takes it for trees, as high as the roof, which would throw their shadow on it: trees less
 * than 3/4 of a cell from a footprint have no height. */
#ifndef BUILD_FOOTPRINTS_H
#define BUILD_FOOTPRINTS_H

#include "build/tile.h"

/* Enter the footprints into the cells of a tile of the finest level; other levels take theirs from
 * below. Walls and masts narrower than half a cell are not entered. A footprint reaches over the
 * borders of its tile, but not over those of a latitude zone or of longitude 0. */
void build_footprints(const struct build_context *b, const struct image_frame *f,
                      struct image_ground *ground);

#endif
