/* Materials of the scene's ground: how each looks from above, and which of [Heaton]'s six classes
 * it belongs to (Heaton, "Applying artificial neural networks to generate radar simulation data
 * bases": soil, asphalt, concrete, structure, vegetation, water). */
#ifndef SCENE_MATERIAL_H
#define SCENE_MATERIAL_H

#include <stdint.h>

enum material_class {
    CLASS_SOIL,
    CLASS_ASPHALT,
    CLASS_CONCRETE,
    CLASS_STRUCTURE,
    CLASS_VEGETATION,
    CLASS_WATER,
    CLASS_COUNT
};

enum material {
    SEA_DEEP,
    SEA_SHALLOW,
    SEA_TURBID,
    HARBOUR_WATER,
    RIVER_WATER,
    LAKE_WATER,
    LAKE_ALGAE,
    SAND,
    SAND_WET,
    SOIL_LIGHT,
    SOIL_DARK,
    SOIL_RED,
    STUBBLE,
    ROCK,
    GRAVEL,
    ASPHALT_NEW,
    ASPHALT_OLD,
    CONCRETE,
    CONCRETE_OLD,
    PAINT,
    ROOF_TILE,
    ROOF_METAL,
    ROOF_WHITE,
    ROOF_DARK,
    ROOF_BLUE,
    TANK,
    SHIP,
    CONTAINER,
    GRASS,
    MEADOW,
    WHEAT,
    MAIZE,
    RAPE,
    ORCHARD,
    GARDEN,
    MAQUIS,
    BROADLEAF,
    CONIFER,
    MATERIAL_COUNT
};

enum { BAND_COUNT = 6 };

struct material_look {
    enum material_class group;
    uint16_t reflectance[BAND_COUNT]; /* mean, times 10000 */
    double spread;    /* of brightness between objects, one standard deviation, as a share */
    double greenness; /* the same of the balance between visible and near infrared */
};

/* The look of a material; constant data. */
const struct material_look *material_look(enum material m);
/* Words for a file: "beach sand", "clay tiles". */
const char *material_name(enum material m);
const char *material_class_name(enum material_class c);

/* The bands are those of the Landsat Thematic Mapper with 30 m pixels: 1-5 and 7. */
const char *material_band_name(int band);

/* Sets of materials, one bit each. */
typedef uint64_t material_set;
material_set material_set_of_class(enum material_class c);
#define MATERIAL_BIT(m) ((material_set)1 << (m))

#endif
