/* Elevation models on one grid, side by side or one over the other, read as if they were one
 * raster; its voids are found and filled first.
 *
 * A void is a pixel inside a file that has no elevation: the file's nodata value, NaN, or a height
 * that no place on Earth has. Voids that touch form a region. A region most of whose rim is at or
 * below sea level is sea, and lies at sea level; any other is filled from its rim (GDALFillNodata)
 * when the rectangle around it holds at most TERRAIN_FILL_MAX pixels; the rest stay without
 * terrain. */
#ifndef TERRAIN_MOSAIC_H
#define TERRAIN_MOSAIC_H

#include "resample_georef.h"
#include "resample_mesh.h"

#include <gdal.h>
#include <stdbool.h>
#include <stdint.h>

enum { TERRAIN_FILL_MAX = 16 << 20 };

struct terrain_member {
    GDALDatasetH dataset; /* owned */
    GDALRasterBandH band;
    char *path;              /* owned */
    int x, y, width, height; /* where it lies in the mosaic */
    bool has_nodata;
    double nodata, scale, offset; /* metres = value * scale + offset */
};

/* Void pixels x0..x1 of row y. */
struct terrain_run {
    int32_t y, x0, x1;
    uint32_t region;
    uint64_t
        value; /* index of the first pixel's elevation in `values`; interpolated regions only */
};

enum terrain_filling { TERRAIN_LEFT_VOID, TERRAIN_SEA, TERRAIN_INTERPOLATED };

struct terrain_region {
    int32_t x0, y0, x1, y1; /* inclusive */
    uint64_t pixels, rim, rim_sea;
    enum terrain_filling filling;
};

struct terrain_voids {
    struct terrain_run *runs; /* owned; by y, then x0 */
    size_t run_count;
    struct terrain_region *regions; /* owned */
    size_t region_count;
    float *values; /* owned */
};

struct terrain_mosaic {
    struct resample_georef georef;  /* of the whole */
    struct terrain_member *members; /* owned; the first one that has an elevation gives it */
    int member_count;
    double sea_level_m;
    struct terrain_voids voids;
};

/* What read finds in a pixel. */
enum terrain_state { TERRAIN_NONE, TERRAIN_VOID, TERRAIN_FILLED, TERRAIN_MEASURED };

/* Read a window that lies inside the mosaic: metres (NaN where there is none) and enum
 * terrain_state, row by row. Returns 0, or -1 with file, cause and remedy reported. */
int terrain_mosaic_read(const struct terrain_mosaic *m, const struct resample_window *window,
                        float *metres, uint8_t *state);

void terrain_mosaic_close(struct terrain_mosaic *m);

/* Find and fill the voids. Returns 0, or -1 with the error reported. Reads every pixel once. */
int terrain_voids_fill(struct terrain_mosaic *m);

/* Apply what was found to a window read without it. */
void terrain_voids_apply(const struct terrain_mosaic *m, const struct resample_window *window,
                         float *metres, uint8_t *state);

#endif
