/* Complex raster: a picture of complex numbers with notes about it, for other people's programs.
 * The end of the name says the form:
 * - .tif, .tiff: GeoTIFF, one band of CFloat32, the notes as metadata,
 * - .ntf, .nitf: NITF 2.1, image category SAR, bands I and Q of 32-bit floats, the notes as image
 *   comments, of which there may be nine; the tenth is in the title,
 * - SICD: a NITF with a text (XML) in a data extension segment that says the geometry. */
#ifndef GIS_COMPLEX_RASTER_H
#define GIS_COMPLEX_RASTER_H

#include <complex.h>
#include <stdbool.h>

enum { DB_COMPLEX_NOTES_MAX = 10 };

/* "name=value", at most 80 characters in ASCII. */
struct db_complex_note {
    const char *name;
    char value[64];
};

/* Where it lies on earth, degrees of WGS84: pixel (column, row), counted from the outer corner of
 * the first, has longitude [0] + column [1] + row [2], and latitude [3] + column [4] + row [5]. */
struct db_complex_place {
    double degrees[6];
};

/* By the end of its name. */
bool db_complex_is_nitf(const char *path);

/* Write `pixels`, the first row on top, whole or not at all; `place` may be NULL. Returns 0, or -1
 * with the error reported: another end of the name, a place in a NITF, for which there is a SICD
 * (below), or it cannot be written. */
int db_complex_write(const char *path, const float complex *pixels, int width, int height,
                     const struct db_complex_note *notes, int count,
                     const struct db_complex_place *place);

struct db_sicd {
    const char *text;     /* XML, of version 1.2.1, without backslashes */
    double corners[4][2]; /* latitude, longitude of the ground: first row and column, first row and
                             last column, and on around */
};

/* Write a SICD. GDAL makes NITFs with one band after the other, but fills those with pixels in
 * turn, as SICD wants them: the byte of the header that says so is changed between. Returns as
 * above. */
int db_sicd_write(const char *path, const float complex *pixels, int width, int height,
                  const struct db_sicd *sicd);

#endif
