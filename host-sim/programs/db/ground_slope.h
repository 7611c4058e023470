/* Slope of the ground under the pixels of a grid, from an elevation model in any CRS. */
#ifndef DB_GROUND_SLOPE_H
#define DB_GROUND_SLOPE_H

#include "gis/raster.h"
#include "pixel_places.h"

struct ground_slope {
    struct db_raster terrain;
    const struct db_grid *grid; /* borrowed */
    double metres;              /* in a unit of elevation */
    float *heights;             /* owned: of the rows asked for, and one on either side */
    int y, rows;
    size_t pixels, missing; /* of all calls of ground_slope_rows; those without an elevation */
};

/* Prepare for a grid whose rows run from west to east, the first the northernmost. Returns 0, or -1
 * with the error reported: the file cannot be read, has several bands, no georeferencing or an
 * unknown unit, does not look like terrain (db_plausible_terrain; a warning if it is trusted), the
 * grid is turned or has no CRS, or there is no memory for `rows_most` rows. */
int ground_slope_open(struct ground_slope *s, const char *path, const struct db_grid *grid,
                      int rows_most, bool is_trusted);

/* Harmless on a zeroed struct. */
void ground_slope_close(struct ground_slope *s);

/* Bring the elevations of rows y .. y + rows - 1 onto the grid. Returns 0, or -1 with the error
 * reported. */
int ground_slope_rows(struct ground_slope *s, int y, int rows);

/* Metres of rise per metre towards east and north at a pixel of these rows; 0 where the model has
 * no data beside it. `places` stands at this row. */
void ground_slope_at(const struct ground_slope *s, const struct pixel_places *places, int column,
                     int row, double *east, double *north);

/* Elevation of a pixel of these rows, metres; 0 where there is none. */
double ground_slope_elevation_m(const struct ground_slope *s, int column, int row);

#endif
