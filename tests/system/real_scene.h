/* What the tests of the real scenes share: the scene made through the gallery's script, and its
 * pictures read back as a radar sees them, in lines and range cells. */
#ifndef REAL_SCENE_H
#define REAL_SCENE_H

#include <stddef.h>
#include <stdint.h>

#include "lm/geo.h"

enum { REAL_CELLS = 256, REAL_NO_PIXEL = -1 };

/* One scene's data, folder and whether the data are here. */
struct real_scene {
    char data[1024];   /* folder of the real data, ends in '/' */
    char folder[1024]; /* where the scene's files and pictures are */
    int is_here;
};

/* Run host-sim/run/gallery_scene.sh for `name` when `needed` (below the real data) is there, or is
 * NULL, for a scene that needs none. The
 * files go into the build's tmp folder. Returns 0, also when the data are absent; -1 when the
 * script failed. */
int real_scene_make(struct real_scene *scene, const char *name, const char *needed);

/* Grey of a picture by line (0 is the leftmost) and range cell (0 is the nearest); REAL_NO_PIXEL
 * where symbols hide it or it is smaller than a pixel. The lines of a patch are here the columns of
 * its square, a cell wide each. */
struct real_picture {
    int grey[REAL_CELLS][REAL_CELLS];
};

/* Read the scene's picture `name` (without .png) of a SAR patch. 0 or -1. */
int real_patch_read(struct real_picture *p, const struct real_scene *scene, const char *name);

/* The same of a ground map of A6, whose cells are made ground ranges: the glass shows slant ranges,
 * `height_cells` is the antenna's height in cells. */
int real_ground_map_read(struct real_picture *p, const struct real_scene *scene, const char *name,
                         double height_cells);

/* A place as degrees. */
struct real_place {
    double latitude, longitude;
};

/* `distance_m` along the geodesic of WGS-84 (PROJ's, not ours). */
struct real_place real_geodesic(struct real_place from, double azimuth_deg, double distance_m);

/* Centre of a patch's cell, by geodesics. */
struct real_place real_patch_place(struct real_place centre, double look_deg, double cell_m,
                                   int line, int cell);

/* A raster held in memory, read by GDAL: value of the nearest pixel (not a number outside), or
 * bilinear between pixel centres. */
struct real_raster {
    double *values; /* owned; no-data is NAN */
    int width, height;
    double inverse[6]; /* from the raster's coordinates to pixels */
};

int real_raster_read(struct real_raster *r, const char *path);
void real_raster_free(struct real_raster *r);
double real_raster_nearest(const struct real_raster *r, double x, double y);
double real_raster_bilinear(const struct real_raster *r, double x, double y);

/* Name of the class that the scene's flash image holds at a place on its finest level, read with
 * the firmware's checks; "" where it holds none. */
const char *real_image_class(const struct real_scene *scene, struct real_place place,
                             char name[17]);

#endif
