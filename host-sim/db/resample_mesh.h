/* The pixels of a raster under a tile of the image.
 *
 * PROJ is asked at 5 x 5 nodes a tile, every 16 cells, and the mapping is bilinear between them.
 * Where that would be out by more than 1/500 pixel (very coarse cells, the seam of a projection)
 * every point is worked out on its own. Each of the tile's four edges decides this from its own
 * five nodes, so that the posts that two tiles share come out the same in both, bit for bit. */
#ifndef RESAMPLE_MESH_H
#define RESAMPLE_MESH_H

#include "image_grid.h"
#include "resample_georef.h"

#include "lm/db.h"

enum { RESAMPLE_NODES = 5 };

struct resample_mesh {
    const struct resample_georef *georef; /* borrowed */
    struct image_frame frame;
    double x[RESAMPLE_NODES][RESAMPLE_NODES], y[RESAMPLE_NODES][RESAMPLE_NODES]; /* [north][east] */
    bool is_smooth;
};

void resample_mesh_make(struct resample_mesh *m, const struct resample_georef *georef,
                        const struct image_frame *frame);

/* Pixel positions of the 65 x 65 posts, row by row from the south-west corner. */
void resample_mesh_posts(const struct resample_mesh *m, double *x, double *y);

/* Pixel positions of the centres of the cells, each cut into `parts` x `parts`: a square of
 * 64 * parts positions a side. */
void resample_mesh_cells(const struct resample_mesh *m, int parts, double *x, double *y);

/* The pixels that a set of positions needs. */
struct resample_window {
    int x, y, width, height; /* width 0: none */
};

/* The window of the raster that holds all positions and `margin` pixels around them. Positions that
 * are NaN or further than `margin` outside are left out. */
struct resample_window resample_window_of(const struct resample_georef *georef, size_t count,
                                          const double *x, const double *y, int margin);

#endif
