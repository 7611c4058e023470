/* Labelled polygons from any vector format that OGR reads (a TSV or CSV with a WKT column
 * included), in the pixel coordinates of an image. */
#ifndef GIS_POLYGONS_H
#define GIS_POLYGONS_H

#include "gis/raster.h"

#include <stddef.h>

enum { DB_LABEL_SIZE = 64 };

struct db_polygon {
    double *xy;        /* owned: x, y pairs in pixels; the centre of the first pixel is 0.5, 0.5 */
    size_t *ring_ends; /* owned: for each ring, the index of the point after its last */
    size_t ring_count;
    char label[DB_LABEL_SIZE]; /* longer ones are cut */
    long id;                   /* 1 for the first feature of the file */
};

struct db_polygons {
    struct db_polygon *items; /* owned */
    size_t count;
};

/* Read every feature of the first layer that has a field called `field`. Geometries are reprojected
 * when source and image both name a CRS; a source without one is taken to be in the image's.
 * Features without an area are warned of and left out. Returns 0, or -1 with the error reported:
 * - the file cannot be opened, or no layer has the field,
 * - the image's geotransform has no inverse,
 * - a geometry cannot be brought to the image's CRS,
 * - no memory. */
int db_polygons_read(struct db_polygons *p, const char *path, const char *field,
                     const struct db_grid *grid);

/* Harmless on a zeroed struct. */
void db_polygons_free(struct db_polygons *p);

/* Pixels x_begin .. x_end - 1 of row y; a result other than 0 ends the walk. */
typedef int db_span_fn(void *context, int y, int x_begin, int x_end);

/* Hand the pixels whose centre lies inside the polygon (even-odd over all its rings, so that holes
 * are holes) to `take`, rows ascending and clipped to y_begin <= y < y_end and 0 <= x < width.
 * Returns 0, what `take` returned, or -1 out of memory. */
int db_polygon_walk(const struct db_polygon *p, int y_begin, int y_end, int width, db_span_fn *take,
                    void *context);

#endif
