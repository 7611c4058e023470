/* Vertical reference of an elevation model: its unit, and what its heights are above.
 *
 * Elevations of an image are metres above the geoid EGM96, which stands for mean sea level. */
#ifndef TERRAIN_VERTICAL_H
#define TERRAIN_VERTICAL_H

#include <gdal.h>

enum { TERRAIN_NODES = 65 }; /* along a side of a model */

struct terrain_vertical {
    double metres; /* in a unit of the file; below 0: depths */
    float *shift;  /* owned; metres to add, at nodes spread evenly over the model, row by row; NULL:
                      none */
    char said[240]; /* what was found or assumed */
};

/* NULL: as the file says. */
struct terrain_vertical_options {
    const char *unit;  /* a name as for db_length_unit */
    const char *datum; /* "msl", "egm96", "egm2008", "ellipsoid" */
};

/* Read unit and datum from the vertical coordinate reference system and the unit type of the band.
 * Heights above another datum than EGM96 are shifted, where PROJ has what it takes; otherwise they
 * are taken for heights above mean sea level with a warning, or refused if they are ellipsoidal.
 * Returns 0, or -1 with the error reported and nothing to free:
 * - the unit is not known, or CRS and band differ in it,
 * - heights are above the ellipsoid, and PROJ has no geoid grid for them. */
int terrain_vertical_read(struct terrain_vertical *v, GDALRasterBandH band, const char *path,
                          const struct terrain_vertical_options *options);

/* The shift at a place in pixels of the model, which is `width` x `height`. */
double terrain_vertical_shift(const struct terrain_vertical *v, int width, int height, double x,
                              double y);

/* Harmless on a zeroed struct. */
void terrain_vertical_free(struct terrain_vertical *v);

#endif
