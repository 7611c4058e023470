/* Walk over a band: every pixel once, in blocks of rows, under a progress bar. */
#ifndef GIS_BAND_WALK_H
#define GIS_BAND_WALK_H

#include <gdal.h>
#include <stdbool.h>
#include <stddef.h>

struct db_band_walk {
    GDALDataType type;          /* what pixels are converted to */
    const char *label, *remedy; /* of the bar; of a block that cannot be read */

    /* Take the next `count` pixels, from north-west by rows. Returns whether to go on. */
    bool (*take)(void *context, const void *pixels, size_t count);
    void *context;
};

/* Returns 0, also when `take` ended the walk, or -1 with the error reported by `path`: a block
 * cannot be read, or no memory. Holds 64 MiB of pixels at a time, or one row of more. */
int db_band_walk(GDALRasterBandH band, const char *path, const struct db_band_walk *walk);

#endif
