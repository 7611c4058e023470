/* Radar imagery brought onto the grid of a class raster: mean powers, so that speckle is less. */
#ifndef DB_RADAR_IMAGE_H
#define DB_RADAR_IMAGE_H

#include "gis/raster.h"

#include <gdalwarper.h>

/* In the order of the words of --radar-unit. */
enum radar_unit { RADAR_DB, RADAR_LINEAR };

struct radar_options {
    const char *path;
    int unit; /* enum radar_unit; -1: not said */
    long band, multilook;
    double incidence_deg; /* NAN: the values are gamma0 */
    bool is_trusted;      /* a doubt about the imagery is a warning */
};

enum { RADAR_PIXELS_MAX = 1 << 28 };

struct radar_image {
    GDALDatasetH powers;        /* owned: band 1 power times weight, band 2 weight */
    float *planes;              /* owned: what lies in them */
    const struct db_grid *grid; /* borrowed: of the class raster */
    GDALResampleAlg how;        /* area mean where its pixels are larger, else bilinear */
    double pixels_per_cell;     /* along x */
    uint64_t missing;           /* pixels of the imagery without data */
    const char *name;
};

/* Read the imagery as powers, each the mean over multilook x multilook pixels. Returns 0, or -1
 * with the error reported:
 * - it cannot be read, has not that band, more than RADAR_PIXELS_MAX pixels, or no georeferencing,
 * - it seems to be something else (gis/plausible.h) and is not trusted,
 * - its values cannot be of the unit: powers below 0, or decibels nearly all above 0,
 * - it does not lie on the grid, or PROJ does not bring it there. */
int radar_image_open(struct radar_image *r, const struct radar_options *options,
                     const struct db_grid *grid);

/* gamma in dB of rows y .. y + rows - 1 of the grid; NAN where there is no data. Returns 0, or -1
 * with the error reported. */
int radar_image_rows(const struct radar_image *r, int y, int rows, float *gamma_db);

/* Harmless on a zeroed struct. */
void radar_image_close(struct radar_image *r);

#endif
