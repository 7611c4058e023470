/* Tree of an OGC CDB data store: where its tiles lie by the standard's layout (OGC 15-113, volume
 * 1: geocells, levels of detail, names of files), and its rasters put together on one grid.
 *
 * A geocell is one degree high and one degree wide, or more near the poles. Its tile of level L >=
 * 0 is one of 2^L x 2^L with 1024 x 1024 pixels; of level L < 0 it is the whole geocell with 1024 /
 * 2^-L pixels a side. Pixels of imagery are areas; posts of elevation lie on the south-west corners
 * of their pixels. */
#ifndef VISUAL_CDB_H
#define VISUAL_CDB_H

#include "hs/class_table.h"
#include "visual/canvas.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum {
    CDB_ELEVATION = 1,
    CDB_IMAGERY = 4,
    CDB_MATERIALS = 5,
    CDB_GS_FEATURE = 100,
    CDB_GT_FEATURE = 101,
    CDB_LEVEL_MIN = -10,
    CDB_LEVEL_MAX = 23,
    CDB_PATH_SIZE = 1024,
};

/* Degrees. */
struct cdb_area {
    double south, west, north, east;
};

struct cdb_tile {
    char path[CDB_PATH_SIZE];
    int latitude, longitude; /* of the geocell's south-west corner */
    int dataset, selector[2], level, up, right;
};

struct cdb_tiles {
    struct cdb_tile *items; /* owned; by level, the coarsest first, then by path */
    size_t count, room;
};

struct visual_cdb {
    const char *root; /* borrowed */
    struct cdb_area area;
    int geocell_width;  /* degrees; that of all geocells in the area */
    uint64_t strangers; /* files whose names are not those of tiles, and are left out */
};

/* Degrees of longitude of a geocell whose south-west corner is at that latitude. */
int cdb_geocell_width(int latitude);

/* Find the geocells of a tree. `area` NULL: all of them. Returns 0, or -1 with the error reported:
 * - the folder has no Tiles, or none of its geocells lies in the area,
 * - the area holds geocells of different widths. */
int visual_cdb_open(struct visual_cdb *cdb, const char *root, const struct cdb_area *area);

/* All files of a dataset in the area whose names end with one of `endings` (".tif\0.jp2\0").
 * Returns 0, or -1 with the error reported: no memory. */
int visual_cdb_tiles(struct visual_cdb *cdb, struct cdb_tiles *tiles, int dataset,
                     const char *endings);
/* Read the name of a tile's file, "N32W118_D004_S001_T001_L02_U2_R3.jp2", into all of `t` but its
 * path. False for every other name: a tile outside the world, its geocell or the levels, digits too
 * few or too many. */
bool cdb_tile_read_name(struct cdb_tile *t, const char *name);
/* The area of a tile. */
struct cdb_area cdb_tile_area(const struct cdb_tile *t);
/* Harmless on a zeroed struct. */
void cdb_tiles_free(struct cdb_tiles *tiles);

/* Pixels of one level over the area: the first is number `first` counted from 180 W and 90 S. */
struct cdb_grid {
    int level, geocell_width;
    int64_t first[2]; /* west, south */
    int width, height;
};

/* The pixels of a level that cover the area. Width and height are 0 when they are more than
 * VISUAL_CELLS_MAX. */
struct cdb_grid cdb_grid_of(const struct visual_cdb *cdb, int level);
/* GDAL's geotransform; of posts when `is_post`. */
void cdb_grid_geotransform(const struct cdb_grid *g, bool is_post, double geotransform[6]);
/* Degrees of latitude of a pixel of the level. */
double cdb_pixel_degrees(int level);

enum { CDB_COARSE_LEVELS = 3 };

/* Paint the imagery into the canvas, finer tiles over coarser ones; black pixels are holes. Each
 * tile is a patch. `coarse` becomes the number of cells whose tile is CDB_COARSE_LEVELS or more
 * coarser than the grid: single pixels that fill 8 x 8 cells or more. Returns 0, or -1 with the
 * error reported: a tile cannot be read, or has not the size or the bands of an imagery tile. */
int visual_cdb_paint(const struct cdb_tiles *tiles, const struct cdb_grid *g,
                     struct visual_canvas *c, struct visual_patches *patches, uint64_t *coarse);

/* The class that a name of a composite or base material stands for, or -1. */
typedef int cdb_class_fn(void *context, const char *material);

/* Give cells the classes of the raster materials, layer 1. `unknown` becomes the number of cells
 * whose material stands for none. Returns 0, or -1 with the error reported. */
int visual_cdb_materials(const struct cdb_tiles *tiles, const struct cdb_grid *g,
                         struct visual_canvas *c, cdb_class_fn *class_of, void *context);

/* Put the elevation together: posts of the finest tiles as they are, and where those are missing
 * bilinear between posts of coarser ones; NAN where there are none. `posts` has g->width *
 * g->height values, from the north-west. Returns 0, or -1 with the error reported. */
int visual_cdb_elevation(const struct visual_cdb *cdb, const struct cdb_tiles *tiles,
                         const struct cdb_grid *g, float *posts);

#endif
