/* Painters of the scene, from nature to what people built. Each paints over what the ones before
 * it left. */
#ifndef SCENE_H
#define SCENE_H

#include "scene/canvas.h"
#include "scene/land.h"

#include <stdint.h>

struct scene {
    uint64_t seed;
    int size;      /* pixels a side */
    double cell_m; /* of a pixel */
    struct land land;
    struct canvas canvas;
};

/* Ground that fields, villages and roads may take: meadow in a plain. */
#define SCENE_OPEN                                                                                 \
    (MATERIAL_BIT(MEADOW) | MATERIAL_BIT(STUBBLE) | MATERIAL_BIT(SOIL_LIGHT) |                     \
     MATERIAL_BIT(SOIL_DARK) | MATERIAL_BIT(SOIL_RED) | MATERIAL_BIT(WHEAT) |                      \
     MATERIAL_BIT(MAIZE) | MATERIAL_BIT(RAPE) | MATERIAL_BIT(ORCHARD) | MATERIAL_BIT(GRAVEL))

/* Sea, beach, lake, woods, heath, rock, and meadow for the rest. */
void scene_paint_nature(struct scene *s);
/* Parcels of the plain with their crops, lanes, tree lines and farmsteads. */
void scene_paint_farms(struct scene *s);
/* The river and its streams with the trees on their banks. */
void scene_paint_streams(struct scene *s);
/* Town, industry and villages: streets, blocks, buildings, parks. */
void scene_paint_towns(struct scene *s);
/* Quays, piers, moles, warehouses, tanks, ships. */
void scene_paint_port(struct scene *s);
void scene_paint_airfield(struct scene *s);
/* The main roads and their bridges. */
void scene_paint_roads(struct scene *s);

/* All of it. Returns 0, or -1 when memory is short (reported). `size` and `cell_m` are set and
 * within the limits of the command line. */
int scene_make(struct scene *s);
void scene_free(struct scene *s);

/* A brush for ground without height, and one for something that stands on it. */
struct brush scene_ground(enum material m, uint64_t variant, material_set over);
struct brush scene_solid(enum material m, uint64_t variant, double height_m);

#endif
