#include "hs/class_table.h"

#include "hs/atomic_file.h"
#include "hs/error.h"
#include "hs/number.h"
#include "hs/text_file.h"

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

static const char *const key_names[DB_KEY_COUNT] = {
    "colour",       "kind",          "gamma_db", "spread_db",   "limits_db",
    "texture",      "texture_shape", "height_m", "looks",       "borders",
    "ku_db",        "ka_db",         "mmw_db",   "emissivity",  "albedo",
    "conductivity", "heat_capacity", "wetness",  "roughness_m",
};
enum { KEYS_REQUIRED = DB_KEY_LIMITS + 1, SPREAD_DB_MAX = 20 };

static const char *const kind_names[] = {"ground", "water", "structure", "trees"};
static const char *const texture_names[] = {"gaussian", "rayleigh", "k"};
static const char *const border_names[] = {"straight", "natural"};

/* The keys whose value is numbers: where these are kept, one after the other, how many they are,
 * the range of each, and what a message calls them. */
enum { NUMBERS_MAX = 4 };
struct number_key {
    size_t offset; /* of the first in struct db_class */
    int count;     /* 0: the key is none of these */
    struct {
        double low, high;
    } range[NUMBERS_MAX];
    const char *expected;
};
#define LEVELS(sensor, field)                                                                      \
    offsetof(struct db_class, levels) + (sensor) * sizeof(struct db_levels) +                      \
        offsetof(struct db_levels, field)
#define BAND_KEY(sensor)                                                                           \
    {                                                                                              \
        LEVELS(sensor, gamma_db), 4, {{-80, 40}, {0, 20}, {-100, 60}, {-100, 60}},                 \
            "four numbers of dB: mean -80..40, spread 0..20, lowest and highest around the mean"   \
    }
#define THERMAL(field) offsetof(struct db_class, thermal) + offsetof(struct db_thermal, field)
static const struct number_key number_keys[DB_KEY_COUNT] = {
    [DB_KEY_GAMMA] = {LEVELS(HS_SENSOR_X, gamma_db), 1, {{-80, 40}}, "a number of dB, -80..40"},
    [DB_KEY_SPREAD] = {LEVELS(HS_SENSOR_X, spread_db), 1, {{0, 20}}, "a number of dB, 0..20"},
    [DB_KEY_LIMITS] = {LEVELS(HS_SENSOR_X, low_db),
                       2,
                       {{-100, 60}, {-100, 60}},
                       "two numbers of dB, the lower first, -100..60"},
    [DB_KEY_SHAPE] = {offsetof(struct db_class, texture_shape),
                      1,
                      {{0.1, 1000}},
                      "a number 0.1..1000"},
    [DB_KEY_HEIGHT] = {offsetof(struct db_class, height_m),
                       1,
                       {{0, 1000}},
                       "a number of metres, 0..1000"},
    [DB_KEY_LOOKS] = {offsetof(struct db_class, looks), 1, {{1, 64}}, "a number 1..64"},
    [DB_KEY_KU] = BAND_KEY(HS_SENSOR_KU),
    [DB_KEY_KA] = BAND_KEY(HS_SENSOR_KA),
    [DB_KEY_MMW] = BAND_KEY(HS_SENSOR_MMW),
    [DB_KEY_EMISSIVITY] = {THERMAL(emissivity),
                           2,
                           {{0.05, 0.999}, {0, 0.2}},
                           "two numbers: mean 0.05..0.999 and spread 0..0.2"},
    [DB_KEY_ALBEDO] = {THERMAL(albedo),
                       2,
                       {{0, 0.95}, {0, 0.3}},
                       "two numbers: mean 0..0.95 and spread 0..0.3"},
    [DB_KEY_CONDUCTIVITY] = {THERMAL(conductivity),
                             2,
                             {{0.01, 10000}, {0, 5000}},
                             "two numbers of W/(m K): mean 0.01..10000 and spread 0..5000"},
    [DB_KEY_HEAT_CAPACITY] = {THERMAL(heat_capacity),
                              1,
                              {{0.01, 10}},
                              "a number of MJ/(m3 K), 0.01..10"},
    [DB_KEY_WETNESS] = {THERMAL(wetness), 1, {{0, 1}}, "a number 0..1"},
    [DB_KEY_ROUGHNESS] = {THERMAL(roughness_m), 1, {{1e-6, 5}}, "a number of metres, 1e-6..5"},
};

static int find_word(const char *const *words, int count, const char *word)
{
    for (int i = 0; i < count; i++) {
        if (strcmp(words[i], word) == 0) {
            return i;
        }
    }
    return -1;
}

/* Exactly `count` numbers and nothing else. */
static bool read_numbers(const char *text, int count, double *numbers, double low, double high)
{
    for (int i = 0; i < count; i++) {
        text = hs_number_begin(text, &numbers[i]);
        if (!text || !(numbers[i] >= low && numbers[i] <= high)) {
            return false;
        }
    }
    return *text == '\0';
}

static bool set_colour(struct db_class *c, const char *value)
{
    double rgb[3];
    if (!read_numbers(value, 3, rgb, 0, 255)) {
        return false;
    }
    for (int i = 0; i < 3; i++) {
        c->colour[i] = (uint8_t)rgb[i];
        if (rgb[i] != c->colour[i]) {
            return false;
        }
    }
    return true;
}

/* Whether limits are in their order, and around the mean where that stands before them. */
static bool is_ordered(enum db_class_key key, const double *v)
{
    return key == DB_KEY_LIMITS                    ? v[0] < v[1]
           : key >= DB_KEY_KU && key <= DB_KEY_MMW ? v[2] < v[3] && v[2] <= v[0] && v[0] <= v[3]
                                                   : true;
}

static bool set_numbers(struct db_class *c, enum db_class_key key, const char *text)
{
    const struct number_key *k = &number_keys[key];
    double v[NUMBERS_MAX];
    if (!read_numbers(text, k->count, v, -HUGE_VAL, HUGE_VAL)) {
        return false;
    }
    for (int i = 0; i < k->count; i++) {
        if (!(v[i] >= k->range[i].low && v[i] <= k->range[i].high)) {
            return false;
        }
    }
    memcpy((char *)c + k->offset, v, (size_t)k->count * sizeof v[0]);
    return is_ordered(key, v);
}

/* Returns what the value should have been, or NULL when it was right. */
static const char *set_key(struct db_class *c, enum db_class_key key, const char *value)
{
    if (number_keys[key].count > 0) {
        return set_numbers(c, key, value) ? NULL : number_keys[key].expected;
    }
    int word;
    switch (key) {
    case DB_KEY_COLOUR:
        return set_colour(c, value) ? NULL : "three whole numbers 0..255";
    case DB_KEY_KIND:
        word = find_word(kind_names, 4, value);
        c->kind = word < 0 ? DB_KIND_GROUND : (enum db_class_kind)word;
        return word >= 0 ? NULL : "ground, water, structure or trees";
    case DB_KEY_TEXTURE:
        word = find_word(texture_names, 3, value);
        c->texture = word < 0 ? DB_TEXTURE_GAUSSIAN : (enum db_texture)word;
        return word >= 0 ? NULL : "gaussian, rayleigh or k";
    case DB_KEY_BORDERS:
        word = find_word(border_names, 2, value);
        c->is_natural = word == 1;
        return word >= 0 ? NULL : "natural or straight";
    default:
        return "a known key";
    }
}

/* What does not leave as the body's own radiation is reflected (Kirchhoff's law). */
static void set_infrared_levels(struct db_class *c)
{
    const struct db_thermal *t = &c->thermal;
    if (c->has_key[DB_KEY_EMISSIVITY]) {
        const double reflected = 1 - t->emissivity;
        const double mean_db = 10 * log10(reflected);
        const double spread_db =
            fmin(SPREAD_DB_MAX, 10 / log(10) * t->emissivity_spread / reflected);
        c->levels[HS_SENSOR_IR] = (struct db_levels){mean_db, spread_db, mean_db - 3 * spread_db,
                                                     fmin(0, mean_db + 3 * spread_db)};
    }
}

static int finish_section(const struct db_text_file *f, struct db_class *c)
{
    if (!c) {
        return 0;
    }
    for (int i = 0; i < KEYS_REQUIRED; i++) {
        if (!c->has_key[i]) {
            return db_text_error(f, "add it to the section", "class [%s] ends here without `%s`",
                                 c->name, key_names[i]);
        }
    }
    if (!c->has_key[DB_KEY_BORDERS]) {
        c->is_natural = c->kind != DB_KIND_STRUCTURE;
    }
    const struct db_levels *x = &c->levels[HS_SENSOR_X];
    if (x->gamma_db < x->low_db || x->gamma_db > x->high_db) {
        return db_text_error(f, "widen limits_db or move gamma_db",
                             "class [%s] has its mean %g dB outside its limits %g..%g dB", c->name,
                             x->gamma_db, x->low_db, x->high_db);
    }
    set_infrared_levels(c);
    return 0;
}

static bool is_name(const char *name, size_t length)
{
    return length > 0 && length < DB_NAME_SIZE &&
           strspn(name, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-") ==
               length;
}

static int start_section(const struct db_text_file *f, struct db_class_table *table)
{
    char *name = f->line + 1;
    const size_t length = strcspn(name, "]");
    if (name[length] != ']' || name[length + 1] != '\0') {
        return db_text_error(f, "write [name]", "this is not a class heading");
    }
    name[length] = '\0';
    if (!is_name(name, length)) {
        return db_text_error(f, "use at most 31 letters, digits, '_' or '-'",
                             "`%s` is not a class name", name);
    }
    if (db_class_find(table, name) >= 0) {
        return db_text_error(f, "remove one of the two", "class [%s] is here a second time", name);
    }
    if (table->count == DB_CLASS_MAX) {
        return db_text_error(f, "merge some classes", "there are more than %d classes",
                             DB_CLASS_MAX);
    }
    struct db_class *c = &table->items[table->count++];
    *c = (struct db_class){
        .texture_shape = 1, .looks = 1, .thermal = {.roughness_m = 0.01}, .line = f->line_number};
    memcpy(c->name, name, length + 1);
    return 0;
}

static int read_key(const struct db_text_file *f, struct db_class *c)
{
    char *name, *value;
    if (db_text_split(f->line, &name, &value) != 0) {
        return db_text_error(f, "write key = value   # unit, source",
                             "this line is neither a heading nor a value");
    }
    const int key = find_word(key_names, DB_KEY_COUNT, name);
    if (key < 0) {
        return db_text_error(f, "see docs/classifier.md for the keys", "`%s` is not a known key",
                             name);
    }
    if (!c) {
        return db_text_error(f, "start with [name]", "`%s` stands before any class", name);
    }
    if (c->has_key[key]) {
        return db_text_error(f, "remove one of the two", "`%s` is given twice for [%s]", name,
                             c->name);
    }
    const char *expected = set_key(c, (enum db_class_key)key, value);
    if (expected) {
        return db_text_error(f, NULL, "`%s` needs %s, not `%s`", name, expected, value);
    }
    c->has_key[key] = true;
    _Static_assert(sizeof f->remark == DB_SOURCE_SIZE, "a remark fits as a source");
    strcpy(c->source[key], f->remark);
    return 0;
}

static int read_sections(struct db_text_file *f, struct db_class_table *table)
{
    struct db_class *c = NULL; /* before the first [name] */
    int more;
    while ((more = db_text_next(f)) > 0) {
        if (f->line[0] == '[') {
            if (finish_section(f, c) != 0 || start_section(f, table) != 0) {
                return -1;
            }
            c = &table->items[table->count - 1];
        } else if (read_key(f, c) != 0) {
            return -1;
        }
    }
    if (more < 0 || finish_section(f, c) != 0) {
        return -1;
    }
    if (table->count == 0) {
        return hs_error(f->path, "start from classes/heaton6.classes", "holds no class");
    }
    return 0;
}

int db_class_table_read(struct db_class_table *table, const char *path)
{
    *table = (struct db_class_table){0};
    struct db_text_file f;
    if (db_text_open(&f, path) != 0) {
        return -1;
    }
    const int result = read_sections(&f, table);
    db_text_close(&f);
    return result == 0 ? db_class_table_choose(table, path, HS_SENSOR_X) : -1;
}

/* The keys that a sensor needs: `count` from `first` on. */
static const struct {
    enum db_class_key first;
    int count;
} sensor_keys[HS_SENSOR_COUNT] = {
    [HS_SENSOR_X] = {DB_KEY_GAMMA, 3},       [HS_SENSOR_KU] = {DB_KEY_KU, 1},
    [HS_SENSOR_KA] = {DB_KEY_KA, 1},         [HS_SENSOR_MMW] = {DB_KEY_MMW, 1},
    [HS_SENSOR_IR] = {DB_KEY_EMISSIVITY, 4},
};

static int choose_of_class(struct db_class *c, const char *path, enum hs_sensor sensor)
{
    for (int i = 0; i < sensor_keys[sensor].count; i++) {
        const int key = (int)sensor_keys[sensor].first + i;
        if (!c->has_key[key]) {
            char place[512];
            snprintf(place, sizeof place, "%s:%d", path, c->line);
            return hs_error(place, "add it as in heaton6.classes; see docs/classifier.md",
                            "class [%s] has no `%s`, which %s needs", c->name, key_names[key],
                            hs_sensor_title(sensor));
        }
    }
    const struct db_levels *l = &c->levels[sensor];
    c->gamma_db = l->gamma_db;
    c->spread_db = l->spread_db;
    c->low_db = l->low_db;
    c->high_db = l->high_db;
    c->texture = sensor == HS_SENSOR_IR ? DB_TEXTURE_GAUSSIAN : c->texture;
    return 0;
}

int db_class_table_choose(struct db_class_table *table, const char *path, enum hs_sensor sensor)
{
    for (int i = 0; i < table->count; i++) {
        if (choose_of_class(&table->items[i], path, sensor) != 0) {
            return -1;
        }
    }
    return 0;
}

static void write_numbers(FILE *out, const struct db_class *c, enum db_class_key key)
{
    for (int i = 0; i < number_keys[key].count; i++) {
        double number;
        memcpy(&number, (const char *)c + number_keys[key].offset + (size_t)i * sizeof number,
               sizeof number);
        fprintf(out, " %.17g", number);
    }
}

static void write_value(FILE *out, const struct db_class *c, enum db_class_key key)
{
    fprintf(out, "%s =", key_names[key]);
    switch (key) {
    case DB_KEY_COLOUR:
        fprintf(out, " %d %d %d", c->colour[0], c->colour[1], c->colour[2]);
        break;
    case DB_KEY_KIND:
        fprintf(out, " %s", kind_names[c->kind]);
        break;
    case DB_KEY_TEXTURE:
        fprintf(out, " %s", texture_names[c->texture]);
        break;
    case DB_KEY_BORDERS:
        fprintf(out, " %s", border_names[c->is_natural]);
        break;
    default:
        write_numbers(out, c, key);
        break;
    }
    fprintf(out, c->source[key][0] ? "   # %s\n" : "\n", c->source[key]);
}

int db_class_table_write(const struct db_class_table *table, const char *path)
{
    struct hs_atomic_file file;
    if (hs_atomic_open(&file, path) != 0) {
        return -1;
    }
    fputs("# landmass class table: key = value   # unit, source\n", file.stream);
    for (int i = 0; i < table->count; i++) {
        fprintf(file.stream, "\n[%s]\n", table->items[i].name);
        for (int key = 0; key < DB_KEY_COUNT; key++) {
            if (table->items[i].has_key[key]) {
                write_value(file.stream, &table->items[i], (enum db_class_key)key);
            }
        }
    }
    return hs_atomic_commit(&file);
}

int db_class_find(const struct db_class_table *table, const char *name)
{
    for (int i = 0; i < table->count; i++) {
        if (strcmp(table->items[i].name, name) == 0) {
            return i;
        }
    }
    return -1;
}

void db_class_names(const struct db_class_table *table, char *text, int size)
{
    int used = 0;
    text[0] = '\0';
    for (int i = 0; i < table->count && used < size; i++) {
        used += snprintf(text + used, (size_t)(size - used), "%s%s", i ? ", " : "",
                         table->items[i].name);
    }
}
