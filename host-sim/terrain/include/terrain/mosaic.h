/* Mosaic of elevation models: files on one grid, side by side or one over the other, read as if
 * they were one raster. What becomes of pixels without an elevation: terrain/voids.h. */
#ifndef TERRAIN_MOSAIC_H
#define TERRAIN_MOSAIC_H

#include "resample/georef.h"
#include "resample/mesh.h"
#include "terrain/vertical.h"

#include <gdal.h>
#include <stdbool.h>
#include <stdint.h>

struct terrain_member {
    GDALDatasetH dataset; /* owned */
    GDALRasterBandH band;
    char *path;              /* owned */
    int x, y, width, height; /* where it lies in the mosaic */
    bool has_nodata;
    double nodata, scale, offset; /* metres = value * scale + offset + shift of `vertical` */
    struct terrain_vertical vertical;
};

struct terrain_mosaic {
    struct resample_georef georef;  /* of the whole */
    struct terrain_member *members; /* owned; the first one that has an elevation gives it */
    int member_count;
};

/* What a pixel holds. terrain_mosaic_read finds the first, second and last: no file reaches the
 * pixel, it is a void, or it has an elevation. Only terrain_voids_apply fills one. */
enum terrain_state { TERRAIN_NONE, TERRAIN_VOID, TERRAIN_FILLED, TERRAIN_MEASURED };

/* Read a window that lies inside the mosaic: metres (NaN where there is none) and enum
 * terrain_state, row by row. Returns 0, or -1 with file, cause and remedy reported. */
int terrain_mosaic_read(const struct terrain_mosaic *m, const struct resample_window *window,
                        float *metres, uint8_t *state);

/* Harmless on a zeroed struct, which is what it leaves. */
void terrain_mosaic_close(struct terrain_mosaic *m);

#endif
