/* Georeference of a raster: from WGS-84 latitude and longitude to pixels, in any coordinate
 * reference system that PROJ knows, and from the raster back to the area that it covers.
 *
 * Pixel coordinates are GDAL's: (0, 0) is the outer corner of the first pixel, (0.5, 0.5) its
 * centre. */
#ifndef RESAMPLE_GEOREF_H
#define RESAMPLE_GEOREF_H

#include "image/grid.h"

#include <gdal.h>
#include <ogr_srs_api.h>
#include <stdbool.h>
#include <stddef.h>

struct resample_georef {
    int width, height;
    double geotransform[6];
    double to_pixel[6];       /* its inverse */
    OGRSpatialReferenceH crs; /* owned; axis order x, y */
    OGRCoordinateTransformationH from_wgs84,
        to_wgs84; /* owned; NULL when the CRS is WGS-84 degrees */
    bool is_geographic;
    double longitude_span; /* degrees or CRS units of a full circle; geographic only */
    double centre_x;       /* of the raster, CRS units: longitudes are wrapped to lie around it */
};

/* Read the georeference of an open dataset; `path` is for messages. Returns 0, or -1 with the error
 * reported and nothing to close:
 * - the dataset has no geotransform, or no CRS,
 * - its CRS cannot be reached from WGS-84, or PROJ lacks its data. */
int resample_georef_open(struct resample_georef *g, GDALDatasetH dataset, const char *path);
/* Harmless on a zeroed struct. */
void resample_georef_close(struct resample_georef *g);

/* Move the origin to pixel (x, y) and take another size: the frame of a mosaic. */
void resample_georef_reframe(struct resample_georef *g, double x, double y, int width, int height);

/* Pixel coordinates of places given in BAM. Where the CRS has no such place x and y become NaN.
 * Both inputs may be any representative modulo 2^32. Cost: one PROJ transformation each unless the
 * CRS is WGS-84 degrees. */
void resample_to_pixels(const struct resample_georef *g, size_t count, const double *latitude_bam,
                        const double *longitude_bam, double *x, double *y);

/* The area on the ground under the raster, a little more rather than less. Returns 0, or -1 when no
 * part of the raster can be placed on the Earth. */
int resample_area(const struct resample_georef *g, struct image_area *area);

/* Size of a pixel at the raster's middle, in BAM of latitude and of longitude. Returns 0, or -1
 * when the middle lies nowhere on Earth. */
int resample_pixel_bam(const struct resample_georef *g, double *latitude, double *longitude);

/* Are `b`'s pixels those of `a` but for a shift by a whole number of pixels? Then (*x, *y) is the
 * position of b's first pixel in a's. */
bool resample_is_aligned(const struct resample_georef *a, const struct resample_georef *b, int *x,
                         int *y);

#endif
