/* Footprints as boxes: the detail of an image knows rectangles alone. */
#ifndef VECTORS_FOOTPRINT_H
#define VECTORS_FOOTPRINT_H

#include <ogr_api.h>

enum { FOOTPRINT_BOXES_MAX = 24 };

/* On the plane, metres. (east, north) is the direction of the length. */
struct footprint_box {
    double x, y, length_m, width_m, east, north;
};

/* Cut a polygon into boxes along the direction that most of its walls have: one box where it fills
 * its rectangle to 88 % or more, with the polygon's area; else slices, at corners or as thin as it
 * takes, so that FOOTPRINT_BOXES_MAX are enough. Courts stay open. Returns their number, 0 for a
 * polygon without area, or -1 out of memory. */
int footprint_cut(OGRGeometryH polygon, struct footprint_box boxes[FOOTPRINT_BOXES_MAX]);

#endif
