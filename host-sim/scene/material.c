#include "scene/material.h"

/* Reflectances in the bands blue, green, red, near infrared and two of the short-wave infrared, of
 * the order that field spectra of such surfaces have. Two likenesses are deliberate, because paper
 * A met them: beach sand and concrete, and old bitumen roofs and asphalt. */
static const struct material_look looks[MATERIAL_COUNT] = {
    [SEA_DEEP] = {CLASS_WATER, {430, 350, 190, 90, 50, 35}, 0.06, 0.05},
    [SEA_SHALLOW] = {CLASS_WATER, {720, 820, 430, 150, 70, 50}, 0.10, 0.10},
    [SEA_TURBID] = {CLASS_WATER, {760, 950, 840, 330, 120, 90}, 0.08, 0.08},
    [HARBOUR_WATER] = {CLASS_WATER, {500, 530, 400, 190, 110, 90}, 0.08, 0.08},
    [RIVER_WATER] = {CLASS_WATER, {620, 850, 740, 380, 160, 120}, 0.08, 0.08},
    [LAKE_WATER] = {CLASS_WATER, {390, 450, 300, 160, 80, 60}, 0.08, 0.08},
    [LAKE_ALGAE] = {CLASS_WATER, {400, 660, 400, 520, 150, 90}, 0.10, 0.15},
    [SAND] = {CLASS_SOIL, {1750, 2200, 2600, 3150, 3750, 3350}, 0.08, 0.03},
    [SAND_WET] = {CLASS_SOIL, {1050, 1330, 1600, 1900, 1750, 1350}, 0.10, 0.04},
    [SOIL_LIGHT] = {CLASS_SOIL, {950, 1300, 1750, 2450, 3150, 2750}, 0.10, 0.05},
    [SOIL_DARK] = {CLASS_SOIL, {580, 780, 1030, 1550, 2050, 1750}, 0.12, 0.06},
    [SOIL_RED] = {CLASS_SOIL, {600, 850, 1450, 2050, 2700, 2300}, 0.12, 0.06},
    [STUBBLE] = {CLASS_SOIL, {880, 1250, 1650, 2450, 3150, 2500}, 0.10, 0.08},
    [ROCK] = {CLASS_SOIL, {1050, 1300, 1520, 1900, 2350, 2100}, 0.16, 0.06},
    [GRAVEL] = {CLASS_SOIL, {1200, 1500, 1800, 2300, 2750, 2450}, 0.10, 0.04},
    [ASPHALT_NEW] = {CLASS_ASPHALT, {620, 670, 710, 810, 920, 880}, 0.10, 0.03},
    [ASPHALT_OLD] = {CLASS_ASPHALT, {980, 1080, 1150, 1290, 1450, 1400}, 0.10, 0.03},
    [CONCRETE] = {CLASS_CONCRETE, {1900, 2280, 2600, 2980, 3300, 3050}, 0.08, 0.02},
    [CONCRETE_OLD] = {CLASS_CONCRETE, {1450, 1720, 1930, 2250, 2550, 2400}, 0.09, 0.02},
    [PAINT] = {CLASS_CONCRETE, {4000, 4300, 4400, 4500, 3900, 3500}, 0.05, 0.02},
    [ROOF_TILE] = {CLASS_STRUCTURE, {680, 950, 1950, 2450, 2650, 2150}, 0.14, 0.04},
    [ROOF_METAL] = {CLASS_STRUCTURE, {2050, 2150, 2150, 2200, 1850, 1550}, 0.14, 0.04},
    [ROOF_WHITE] = {CLASS_STRUCTURE, {4200, 4450, 4500, 4400, 3200, 2600}, 0.10, 0.03},
    [ROOF_DARK] = {CLASS_STRUCTURE, {850, 880, 900, 980, 1180, 1250}, 0.16, 0.05},
    [ROOF_BLUE] = {CLASS_STRUCTURE, {1550, 1450, 1050, 1700, 1500, 1300}, 0.12, 0.04},
    [TANK] = {CLASS_STRUCTURE, {4900, 5050, 5000, 4800, 3800, 3200}, 0.06, 0.02},
    [SHIP] = {CLASS_STRUCTURE, {1300, 1280, 1420, 1600, 1500, 1350}, 0.25, 0.08},
    [CONTAINER] = {CLASS_STRUCTURE, {1250, 1350, 1600, 1950, 1650, 1400}, 0.28, 0.12},
    [GRASS] = {CLASS_VEGETATION, {420, 820, 560, 3400, 2150, 1050}, 0.07, 0.08},
    [MEADOW] = {CLASS_VEGETATION, {500, 880, 800, 2950, 2350, 1300}, 0.09, 0.12},
    [WHEAT] = {CLASS_VEGETATION, {820, 1250, 1480, 2900, 2700, 1850}, 0.08, 0.10},
    [MAIZE] = {CLASS_VEGETATION, {360, 680, 420, 4100, 1850, 820}, 0.07, 0.08},
    [RAPE] = {CLASS_VEGETATION, {560, 1450, 1250, 4200, 2200, 1100}, 0.06, 0.08},
    [ORCHARD] = {CLASS_VEGETATION, {500, 760, 740, 2600, 2150, 1250}, 0.10, 0.10},
    [GARDEN] = {CLASS_VEGETATION, {460, 760, 640, 2850, 1950, 1080}, 0.12, 0.14},
    [MAQUIS] = {CLASS_VEGETATION, {400, 620, 560, 2150, 1700, 980}, 0.12, 0.12},
    [BROADLEAF] = {CLASS_VEGETATION, {250, 480, 280, 3500, 1500, 620}, 0.13, 0.08},
    [CONIFER] = {CLASS_VEGETATION, {190, 340, 215, 2250, 880, 370}, 0.13, 0.08},
};

const struct material_look *material_look(enum material m)
{
    return &looks[m];
}

const char *material_name(enum material m)
{
    static const char *const names[MATERIAL_COUNT] = {
        "deep sea",        "shallow sea", "turbid sea",
        "harbour water",   "river water", "lake water",
        "algal bloom",     "beach sand",  "wet sand",
        "light soil",      "dark soil",   "red soil",
        "stubble",         "rock",        "gravel",
        "new asphalt",     "old asphalt", "new concrete",
        "old concrete",    "white paint", "clay tiles",
        "metal roof",      "white roof",  "bitumen roof",
        "blue roof",       "tank",        "ship",
        "containers",      "grass",       "meadow",
        "ripe wheat",      "maize",       "rape",
        "orchard",         "garden",      "heath",
        "broadleaf trees", "conifers"};
    return names[m];
}

const char *material_class_name(enum material_class c)
{
    static const char *const names[CLASS_COUNT] = {"soil",      "asphalt",    "concrete",
                                                   "structure", "vegetation", "water"};
    return names[c];
}

const char *material_band_name(int band)
{
    static const char *const names[BAND_COUNT] = {"blue", "green", "red", "nir", "swir1", "swir2"};
    return names[band];
}

material_set material_set_of_class(enum material_class c)
{
    material_set set = 0;
    for (int m = 0; m < MATERIAL_COUNT; m++) {
        set |= looks[m].group == c ? MATERIAL_BIT(m) : 0;
    }
    return set;
}
