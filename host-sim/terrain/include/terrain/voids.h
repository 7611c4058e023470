/* Voids of a mosaic of elevation models, found and filled.
 *
 * A void is a pixel inside a file that has no elevation: the file's nodata value, NaN, or a height
 * that no place on Earth has. Voids that touch form a region. Its rim, the pixels around it that
 * have an elevation, decides what becomes of it:
 * - sea, at sea level: at least nine tenths of the rim lie at or below sea level, or more than half
 *   of it round a small region;
 * - unknown coast: otherwise, when more than a tenth of the rim of a region that is not small lies
 *   so. The region is left without data, its heights continued from the rim so that no cliff stands
 *   there;
 * - land, filled from the rim: otherwise;
 * - left without data: a region without a rim, or too large to fill. */
#ifndef TERRAIN_VOIDS_H
#define TERRAIN_VOIDS_H

#include "terrain/mosaic.h"

#include <stddef.h>

enum {
    TERRAIN_FILL_MAX = 16 << 20,    /* pixels in the rectangle around a region that can be filled */
    TERRAIN_SMALL_REGION = 64 << 10 /* pixels: 60 km2 at one arc second, 500 km2 at three */
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
    double sea_level_m;       /* set before terrain_voids_fill, like the next */
    bool are_sea;             /* all of them, whatever their rim */
    struct terrain_run *runs; /* owned; by y, then x0 */
    size_t run_count;
    struct terrain_region *regions; /* owned */
    size_t region_count;
    float *values;  /* owned */
    bool is_filled; /* until then a void reads as a void */
};

/* Find and fill the voids of `m`. Returns 0, or -1 with the error reported; either way
 * terrain_voids_free frees what it holds. Cost: reads every pixel once, and filled regions again.
 */
int terrain_voids_fill(struct terrain_voids *v, const struct terrain_mosaic *m);

/* Put what was found into a window that terrain_mosaic_read has read: metres and enum
 * terrain_state. */
void terrain_voids_apply(const struct terrain_voids *v, const struct resample_window *window,
                         float *metres, uint8_t *state);

/* Harmless on a zeroed struct, which is what it leaves. */
void terrain_voids_free(struct terrain_voids *v);

#endif
