/* Class table: the feature classes of a database, how each looks in a picture and to the radar.
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
 * colour to limits_db are required. A class is known elsewhere by its place in the file, from 0. */
#ifndef HS_CLASS_TABLE_H
#define HS_CLASS_TABLE_H

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
    DB_KEY_COUNT
};

struct db_class {
    char name[DB_NAME_SIZE];
    uint8_t colour[3];
    enum db_class_kind kind;
    double gamma_db, spread_db, low_db, high_db;
    enum db_texture texture;
    double texture_shape;
    double height_m;
    double looks;
    bool is_natural;                           /* borders have grown */
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
 * - a class lacks a required key, or gamma_db lies outside limits_db. */
int db_class_table_read(struct db_class_table *table, const char *path);

/* Write the table so that reading it back gives the same. Returns 0, or -1 with the error reported.
 */
int db_class_table_write(const struct db_class_table *table, const char *path);

/* The index of the class called `name`, or -1. */
int db_class_find(const struct db_class_table *table, const char *name);

/* Write the names in one line, "soil, asphalt, water", into the `size` bytes of `text`, cut where
 * they end; for messages. */
void db_class_names(const struct db_class_table *table, char *text, int size);

#endif
