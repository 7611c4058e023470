/* Painting: the scene while it is made, and the brushes that its painters share. */
#ifndef SCENE_PAINTING_H
#define SCENE_PAINTING_H

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

/* A brush for ground without height, and one for something that stands on it. */
struct brush scene_ground(enum material m, uint64_t variant, material_set over);
struct brush scene_solid(enum material m, uint64_t variant, double height_m);

#endif
