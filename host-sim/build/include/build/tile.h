/* Tile of an image, made from the inputs or from the four tiles below it. */
#ifndef BUILD_TILE_H
#define BUILD_TILE_H

#include "build/detail.h"
#include "build/exact_sum.h"
#include "build/facing.h"
#include "build/plan.h"
#include "build/towns.h"
#include "hs/class_table.h"
#include "image/ground.h"
#include "image/writer.h"
#include "lm/db.h"
#include "lm/radar.h"
#include "reflectivity/reflect.h"
#include "resample/cover.h"
#include "terrain/surface.h"

#include <stdint.h>

/* Class of a cell that the class raster does not give, from the terrain alone. */
struct build_rule {
    int land, water, steep; /* class numbers; steep -1: none */
    double sea_level_m;     /* a cell whose centre is not higher is water */
    double steep_tangent;   /* steeper than this is `steep` */
};

/* What was made, in numbers that do not depend on the order of the tiles. */
struct build_counts {
    uint64_t cells[LM_DB_CLASSES]; /* as generated, each once, at whatever level */
    struct build_sum area_m2[LM_DB_CLASSES];
    uint64_t cells_by_rule;        /* of these, by the terrain's rule */
    uint64_t cells_beyond_terrain; /* of these, on elevations of the terrain's edge */
    struct build_sum land_area_m2, land_metres_m2; /* for the mean elevation */
    uint64_t detail_items;                         /* of tiles that are in the image */
    uint64_t heights_cut; /* samples of structures and trees above 1,000 m */
};

struct build_context {
    struct resample_cover cover;
    struct terrain terrain;
    enum hs_sensor sensor; /* that the reflectivities are for */
    struct lm_radar radar; /* that shall look at the image; all zero: any of that band */
    struct db_class_table table;
    struct db_code_map codes;                 /* of the class raster, when it is a land cover */
    struct db_reflect_law laws[DB_CLASS_MAX]; /* of the table's classes */
    struct lm_classes classes;                /* of the table, then those of facings */
    struct build_rule rule;
    struct build_plan plan;
    uint32_t seed;
    int parts; /* pixels of the class raster that a cell is cut into, along one side */
    int terrain_level[HS_LIST_MAX]; /* from which level each terrain layer gives tiles of its own */
    struct build_detail detail;     /* all zero without any */
    struct build_counts counts;
    struct build_towns towns;
    struct build_facing facing;
    struct lm_geoid geoid;          /* rows 0: none */
    struct image_bytes geoid_pages; /* its section; data NULL: none */
};

enum { BUILD_HEIGHT_MAX_DM = 10000 }; /* 1,000 m: higher things are cut to it, and counted */

/* A tile, the ground from which coarser ones are made, and its elevations not yet cut to steps. */
struct build_tile {
    struct lm_tile record;
    struct image_ground ground;
    struct terrain_posts posts;
    float built[LM_TILE_CELLS][LM_TILE_CELLS]; /* share that is built-up */
};

/* The posts that the tiles below, below[2 * north + east] or NULL, give to a tile: every second
 * one, smoothed (image/codes.h). */
void build_take_posts(struct terrain_posts *posts, const struct terrain_posts *const below[4]);

/* Make tile (level, row, column); children[2 * north + east] are the tiles below it or NULL.
 * Returns 0 and *out, which the caller frees, or NULL there when the tile holds no data; -1 with
 * the error reported. */
int build_tile_make(struct build_context *b, int level, uint8_t zone, uint32_t row, uint32_t column,
                    struct build_tile *const children[4], struct build_tile **out);

#endif
