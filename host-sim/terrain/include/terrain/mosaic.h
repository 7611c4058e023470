/* Elevation models on one grid, side by side or one over the other, read as if they were one
 * raster; its voids are found and filled first.
 *
 * A void is a pixel inside a file that has no elevation: the file's nodata value, NaN, or a height
 * that no place on Earth has. Voids that touch form a region, and its rim decides what becomes of
 * it: at least nine tenths of the rim at or below sea level, or more than half round a small
 * region: it is sea, and lies at sea level; more than a tenth but not nine tenths of the rim of a
 * region that is not small: a coast that nobody knows. It is left without data, its heights
 * continued from the rim so that no cliff stands there; otherwise it is land, filled from its rim
 * (terrain_fill); a region without a rim, or too large to fill, is left without data. */
#ifndef TERRAIN_MOSAIC_H
#define TERRAIN_MOSAIC_H

#include "resample/georef.h"
#include "resample/mesh.h"

#include <gdal.h>
#include <stdbool.h>
#include <stdint.h>

enum {
    TERRAIN_FILL_MAX = 16 << 20,    /* pixels in the rectangle around a region that can be filled */
    TERRAIN_SMALL_REGION = 64 << 10 /* pixels: 60 km2 at one arc second, 500 km2 at three */
};

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
    uint64_t value; /* index of the first pixel's elevation in `values`, when the region has any */
};

enum terrain_filling { TERRAIN_LEFT_VOID, TERRAIN_SEA, TERRAIN_INTERPOLATED };

struct terrain_region {
    int32_t x0, y0, x1, y1; /* inclusive */
    size_t first_run;       /* the others follow among the runs of rows up to y1 */
    uint64_t pixels, rim, rim_sea;
    enum terrain_filling filling;
    bool has_values;
};

struct terrain_voids {
    struct terrain_run *runs; /* owned; by y, then x0 */
    size_t run_count;
    struct terrain_region *regions; /* owned */
    size_t region_count;
    float *values;  /* owned */
    bool is_filled; /* until then a void reads as a void */
};

struct terrain_mosaic {
    struct resample_georef georef;  /* of the whole */
    struct terrain_member *members; /* owned; the first one that has an elevation gives it */
    int member_count;
    double sea_level_m;
    bool voids_are_sea; /* all of them, whatever their rim */
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
