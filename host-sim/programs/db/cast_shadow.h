/* Shadows on the pixels of a grid: of terrain, buildings and trees, for a sun that moves. */
#ifndef DB_CAST_SHADOW_H
#define DB_CAST_SHADOW_H

#include "gis/raster.h"
#include "ground_slope.h"
#include "infrared/past_suns.h"

enum { SHADOW_PIXELS_MAX = 1 << 26 };

struct cast_shadow {
    int width, height;
    double east_m, south_m; /* of a pixel */
    float *tops;            /* owned: of ground and what stands on it, metres */
    float highest;
    struct ir_past_sun suns[IR_PAST_SUNS]; /* to be set by the caller */
    int sun_count;
};

/* What casts shadows on the pixels of a class raster. */
struct cast_shadow_of {
    const struct db_raster *classes;
    struct ground_slope *terrain; /* NULL: level */
    const char *heights;          /* file of what stands on it, on the same grid; NULL: nothing */
    bool is_trusted;              /* a doubt about the heights is a warning */
};

/* Take elevations and heights. `pixel_m` is that of a pixel towards east and south. Returns 0, or
 * -1 with the error reported: a file cannot be read or lies on another grid, its unit is not known,
 * it does not look like heights (db_plausible_heights), the grid has more than SHADOW_PIXELS_MAX,
 * or there is no memory. */
int cast_shadow_open(struct cast_shadow *s, const struct cast_shadow_of *of,
                     const double pixel_m[2]);

/* Harmless on a zeroed struct. */
void cast_shadow_close(struct cast_shadow *s);

/* How much of the warmth of the suns does not reach a pixel, 0..1. */
double cast_shadow_at(const struct cast_shadow *s, int column, int row);

#endif
