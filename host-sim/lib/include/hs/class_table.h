/* Class table: the feature classes of a database, how each looks in a picture, to radars of several
 * bands and in the thermal infrared.
 *
 * The file is text, one `[name]` line a class followed by `key = value   # unit, source` lines:
 *
 *     colour         red green blue, 0..255, for pictures
 *     kind           ground | water | structure | trees
 *     gamma_db       mean of the constant-gamma reflectivity at X band in dB, -80..40
 *     spread_db      standard deviation of the same, 0..20 dB
 *     limits_db      low high: no pixel of the class leaves them; those of two classes may overlap
 *     texture        gaussian | rayleigh | k: shape in dB (reflectivity/reflect.h)
 *     texture_shape  order of the k texture, 0.1..1000; 1 unless given
 *     height_m       height of structures and canopy where nothing better is known, 0..1000 m
 *     looks          speckle looks, 1..64; 1 unless given
 *     borders        natural | straight: whether people made its borders; unless given, those of
 *                    structures are straight
 *
 * colour to limits_db are required. A class is known elsewhere by its place in the file, from 0.
 *
 * Values for other sensors than a radar at X band (hs/sensor.h) are asked for where they are used:
 *
 *     ku_db, ka_db, mmw_db   mean spread lowest highest: as gamma_db, spread_db and limits_db at X
 *     emissivity             mean spread, at 8..12 um, 0.05..0.999 and 0..0.2
 *     albedo                 mean spread, of sunlight, 0..0.95 and 0..0.3
 *     conductivity           mean spread, of heat, 0.01..10000 and 0..5000 W/(m K)
 *     heat_capacity          of a volume, 0.01..10 MJ/(m3 K)
 *     wetness                0..1: what evaporates, as a share of free water; 0 unless given
 *     roughness_m            roughness length for the wind, 1e-6..5 m; 0.01 unless given
 *
 * The infrared needs emissivity to heat_capacity. Its reflectivity in dB is that of one less the
 * emissivity (Kirchhoff's law), cut at three spreads. */
#ifndef HS_CLASS_TABLE_H
#define HS_CLASS_TABLE_H

#include "hs/sensor.h"

#include <stdbool.h>
#include <stdint.h>

enum {
    DB_CLASS_MAX = 16,
    DB_CLASS_NODATA = 255, /* in class rasters */
    DB_NAME_SIZE = 32,     /* of class names and source labels, with the final zero */
    DB_SOURCE_SIZE = 120,
};

enum db_class_kind { DB_KIND_GROUND, DB_KIND_WATER, DB_KIND_STRUCTURE, DB_KIND_TREES };
enum db_texture { DB_TEXTURE_GAUSSIAN, DB_TEXTURE_RAYLEIGH, DB_TEXTURE_K };

enum db_class_key {
    DB_KEY_COLOUR,
    DB_KEY_KIND,
    DB_KEY_GAMMA,
    DB_KEY_SPREAD,
    DB_KEY_LIMITS,
    DB_KEY_TEXTURE,
    DB_KEY_SHAPE,
    DB_KEY_HEIGHT,
    DB_KEY_LOOKS,
    DB_KEY_BORDERS,
    DB_KEY_KU,
    DB_KEY_KA,
    DB_KEY_MMW,
    DB_KEY_EMISSIVITY,
    DB_KEY_ALBEDO,
    DB_KEY_CONDUCTIVITY,
    DB_KEY_HEAT_CAPACITY,
    DB_KEY_WETNESS,
    DB_KEY_ROUGHNESS,
    DB_KEY_COUNT
};

/* Reflectivity of a class to one sensor. */
struct db_levels {
    double gamma_db, spread_db, low_db, high_db;
};

/* What a class is to sun, air and the infrared. A spread is a standard deviation. */
struct db_thermal {
    double emissivity, emissivity_spread;     /* 8..12 um */
    double albedo, albedo_spread;             /* of sunlight */
    double conductivity, conductivity_spread; /* W/(m K) */
    double heat_capacity;                     /* MJ/(m3 K) */
    double wetness;                           /* 0..1 */
    double roughness_m;
};

struct db_class {
    char name[DB_NAME_SIZE];
    uint8_t colour[3];
    enum db_class_kind kind;
    double gamma_db, spread_db, low_db, high_db; /* to the sensor chosen, X when just read */
    enum db_texture texture;
    double texture_shape;
    double height_m;
    double looks;
    bool is_natural; /* borders have grown */
    struct db_levels levels[HS_SENSOR_COUNT];
    struct db_thermal thermal;
    bool has_key[DB_KEY_COUNT];                /* what the file gives */
    int line;                                  /* of the heading, from 1 */
    char source[DB_KEY_COUNT][DB_SOURCE_SIZE]; /* the remark after each value; empty when none */
};

struct db_class_table {
    struct db_class items[DB_CLASS_MAX];
    int count;
};

/* Read and check the whole file. Returns 0, or -1 with file, line, cause and remedy reported:
 * - the file cannot be read, or holds no class or more than DB_CLASS_MAX,
 * - a line is neither a heading nor a value; a name is none or stands twice,
 * - a key is unknown, stands twice or before any class, or its value is out of range,
 * - a class lacks a required key, or the mean of a sensor lies outside its limits. */
int db_class_table_read(struct db_class_table *table, const char *path);

/* Put the levels of `sensor` into gamma_db, spread_db, low_db and high_db of each class of a table
 * just read from `path`. Textures are those of radars: the infrared has normal ones. Returns 0, or
 * -1 with file, line, cause and remedy reported: a class lacks a key that the sensor needs. */
int db_class_table_choose(struct db_class_table *table, const char *path, enum hs_sensor sensor);

/* Write the table so that reading it back gives the same. Returns 0, or -1 with the error reported.
 */
int db_class_table_write(const struct db_class_table *table, const char *path);

/* The index of the class called `name`, or -1. */
int db_class_find(const struct db_class_table *table, const char *name);

/* Write the names in one line, "soil, asphalt, water", into the `size` bytes of `text`, cut where
 * they end; for messages. */
void db_class_names(const struct db_class_table *table, char *text, int size);

#endif
