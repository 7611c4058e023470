/* Places of a raster's pixels on the ground, a row at a time. */
#ifndef DB_PIXEL_PLACES_H
#define DB_PIXEL_PLACES_H

#include "gis/raster.h"
#include "reflectivity/place.h"

#include <ogr_srs_api.h>

struct pixel_places {
    const struct db_grid *grid;            /* borrowed */
    OGRCoordinateTransformationH to_wgs84; /* owned; NULL: the grid names no CRS */
    int apart;                             /* pixels between those that PROJ is asked for */
    double pixel_m;                        /* from a row to the next, in the middle of the grid */
    double *x, *y;                         /* owned: of those */
    int *is_found;                         /* owned: of those */
    struct reflect_place *row;             /* owned: of the middles of a row's pixels */
};

/* Prepare for a grid. Without a CRS places are the grid's own coordinates, as if in metres on a
 * plane. Returns 0, or -1 with the error reported; `name` is for that. */
int pixel_places_open(struct pixel_places *p, const struct db_grid *grid, const char *name);
/* Harmless on a zeroed struct. */
void pixel_places_close(struct pixel_places *p);

/* Fill p->row with the places of row y. PROJ is asked for pixels less than 500 m apart, and places
 * between them lie on straight lines, 5 mm off at most. Pixels that PROJ cannot place get the
 * grid's coordinates. */
void pixel_places_row(struct pixel_places *p, int y);

#endif
