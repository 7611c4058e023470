/* What the sources of `landmass-db import` share. */
#ifndef DB_IMPORT_H
#define DB_IMPORT_H

#include "gis/label_map.h"
#include "gis/raster.h"
#include "visual/canvas.h"
#include "visual/cdb.h"
#include "visual/scene.h"

struct import_options {
    struct hs_list models;
    const char *cdb;
    const char *unit, *up, *crs, *origin, *at, *area;
    double cell_m;
    const char *classes, *map;
    const char *image, *mask, *class_raster, *top, *terrain, *heights;
    bool boxes;
};

enum { IMPORT_NODATA_M = -9999 };

struct import {
    const struct import_options *options; /* borrowed */
    const char *place;                    /* for messages */
    struct db_class_table table;
    struct db_label_map map;
    bool is_ground[256]; /* by class; false of DB_CLASS_NODATA */
    struct visual_patches patches;
    struct visual_scene scene;
    struct visual_canvas canvas;
    struct db_grid grid;         /* of the canvas; its CRS is owned */
    struct db_grid terrain_grid; /* its CRS is that of `grid` */
    float *terrain;              /* owned */
    float *heights;              /* owned: metres above the ground, IMPORT_NODATA_M: none */
};

/* The class of a material by the map, or -1; `context` is the import. */
int import_class_of(void *context, const char *material);

/* Fill canvas, grids, terrain and heights as far as outputs want them. Return 0, or -1 with the
 * error reported. */
int import_models(struct import *im);
int import_cdb(struct import *im);

/* Warn of textures that are missing. */
void import_warn_lost(const struct import *im, uint32_t count, const char *first);

#endif
