/* Mesh of a tile: the pixels of a raster under each cell or post of it.
 *
 * PROJ is asked at the nodes of a lattice over the whole Earth, and the mapping is bilinear between
 * them. The lattice is the same at every level and in every latitude zone, and a place that lies on
 * a line of it belongs to the mesh north and east of it: so a place has one pixel position, bit for
 * bit, whichever tile asks for it. Meshes across the seam of a projection, and places without
 * lattice, are worked out point by point. */
#ifndef RESAMPLE_MESH_H
#define RESAMPLE_MESH_H

#include "image/grid.h"
#include "lm/db.h"
#include "resample/georef.h"

/* How far apart the nodes of one raster's lattice are. */
struct resample_lattice {
    int64_t spacing_bam; /* of latitude and of longitude; 0: no lattice, each point on its own */
    double jump_px;      /* neighbours further apart than this lie on two sides of a seam */
};

/* The widest lattice, up to 16 of the finest cells, whose meshes are bilinear to 1/500 pixel all
 * over the raster. */
struct resample_lattice resample_lattice_of(const struct resample_georef *georef, uint8_t shift0);

enum { RESAMPLE_NODES = LM_TILE_POSTS + 1 };

struct resample_mesh {
    const struct resample_georef *georef; /* borrowed */
    struct image_frame frame;
    double jump_px;
    int row_span, column_span; /* cells from node to node; 0: no nodes */
    int rows, columns;         /* of nodes: one mesh more than the tile needs */
    double x[RESAMPLE_NODES * RESAMPLE_NODES], y[RESAMPLE_NODES * RESAMPLE_NODES];
};

/* Find the nodes of a tile. The struct has 70 kB. Cost: one PROJ transformation for each node. */
void resample_mesh_make(struct resample_mesh *m, const struct resample_georef *georef,
                        const struct resample_lattice *lattice, const struct image_frame *frame);

/* Pixel positions of the 65 x 65 posts, row by row from the south-west corner. */
void resample_mesh_posts(const struct resample_mesh *m, double *x, double *y);

/* Pixel positions of the centres of the cells, each cut into `parts` x `parts`: a square of 64 *
 * parts positions a side. */
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
