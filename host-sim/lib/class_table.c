#include "hs/class_table.h"

#include "hs/atomic_file.h"
#include "hs/error.h"
#include "hs/text_file.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

static const char *const key_names[DB_KEY_COUNT] = {
    "colour",  "kind",          "gamma_db", "spread_db", "limits_db",
    "texture", "texture_shape", "height_m", "looks",     "borders",
};
enum { KEYS_REQUIRED = DB_KEY_LIMITS + 1 };

static const char *const kind_names[] = {"ground", "water", "structure", "trees"};
static const char *const texture_names[] = {"gaussian", "rayleigh", "k"};
static const char *const border_names[] = {"straight", "natural"};

/* The keys whose value is one number: where it is kept, its range, and what a message calls it. */
struct number_key {
    size_t offset; /* of the double in struct db_class */
    double low, high;
    const char *expected; /* NULL: the key is none of these */
};
static const struct number_key number_keys[DB_KEY_COUNT] = {
    [DB_KEY_GAMMA] = {offsetof(struct db_class, gamma_db), -80, 40, "a number of dB, -80..40"},
    [DB_KEY_SPREAD] = {offsetof(struct db_class, spread_db), 0, 20, "a number of dB, 0..20"},
    [DB_KEY_SHAPE] = {offsetof(struct db_class, texture_shape), 0.1, 1000, "a number 0.1..1000"},
    [DB_KEY_HEIGHT] = {offsetof(struct db_class, height_m), 0, 1000, "a number of metres, 0..1000"},
    [DB_KEY_LOOKS] = {offsetof(struct db_class, looks), 1, 64, "a number 1..64"},
};

/* What is known of the class whose section is being read. */
struct section {
    struct db_class *c; /* NULL before the first [name] */
    bool has_key[DB_KEY_COUNT];
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
        char *end;
        numbers[i] = strtod(text, &end);
        if (end == text || !(numbers[i] >= low && numbers[i] <= high)) {
            return false;
        }
        text = end;
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

static bool set_limits(struct db_class *c, const char *value)
{
    double limits[2];
    if (!read_numbers(value, 2, limits, -100, 60) || limits[0] >= limits[1]) {
        return false;
    }
    c->low_db = limits[0];
    c->high_db = limits[1];
    return true;
}

/* Returns what the value should have been, or NULL when it was right. */
static const char *set_key(struct db_class *c, enum db_class_key key, const char *value)
{
    const struct number_key *number = &number_keys[key];
    if (number->expected) {
        double read;
        if (!read_numbers(value, 1, &read, number->low, number->high)) {
            return number->expected;
        }
        memcpy((char *)c + number->offset, &read, sizeof read);
        return NULL;
    }
    int word;
    switch (key) {
    case DB_KEY_COLOUR:
        return set_colour(c, value) ? NULL : "three whole numbers 0..255";
    case DB_KEY_KIND:
        word = find_word(kind_names, 4, value);
        c->kind = word < 0 ? DB_KIND_GROUND : (enum db_class_kind)word;
        return word >= 0 ? NULL : "ground, water, structure or trees";
    case DB_KEY_LIMITS:
        return set_limits(c, value) ? NULL : "two numbers of dB, the lower first, -100..60";
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

static int finish_section(const struct db_text_file *f, struct section *s)
{
    if (!s->c) {
        return 0;
    }
    for (int i = 0; i < KEYS_REQUIRED; i++) {
        if (!s->has_key[i]) {
            return db_text_error(f, "add it to the section", "class [%s] ends here without `%s`",
                                 s->c->name, key_names[i]);
        }
    }
    if (!s->has_key[DB_KEY_BORDERS]) {
        s->c->is_natural = s->c->kind != DB_KIND_STRUCTURE;
    }
    if (s->c->gamma_db < s->c->low_db || s->c->gamma_db > s->c->high_db) {
        return db_text_error(f, "widen limits_db or move gamma_db",
                             "class [%s] has its mean %g dB outside its limits %g..%g dB",
                             s->c->name, s->c->gamma_db, s->c->low_db, s->c->high_db);
    }
    return 0;
}

static bool is_name(const char *name, size_t length)
{
    return length > 0 && length < DB_NAME_SIZE &&
           strspn(name, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-") ==
               length;
}

static int start_section(const struct db_text_file *f, struct db_class_table *table,
                         struct section *s)
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
    *s = (struct section){.c = &table->items[table->count++]};
    *s->c = (struct db_class){.texture_shape = 1, .looks = 1};
    memcpy(s->c->name, name, length + 1);
    return 0;
}

static int read_key(const struct db_text_file *f, struct section *s)
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
    if (!s->c) {
        return db_text_error(f, "start with [name]", "`%s` stands before any class", name);
    }
    if (s->has_key[key]) {
        return db_text_error(f, "remove one of the two", "`%s` is given twice for [%s]", name,
                             s->c->name);
    }
    const char *expected = set_key(s->c, (enum db_class_key)key, value);
    if (expected) {
        return db_text_error(f, NULL, "`%s` needs %s, not `%s`", name, expected, value);
    }
    s->has_key[key] = true;
    _Static_assert(sizeof f->remark == DB_SOURCE_SIZE, "a remark fits as a source");
    strcpy(s->c->source[key], f->remark);
    return 0;
}

static int read_sections(struct db_text_file *f, struct db_class_table *table)
{
    struct section s = {0};
    int more;
    while ((more = db_text_next(f)) > 0) {
        if (f->line[0] == '[') {
            if (finish_section(f, &s) != 0 || start_section(f, table, &s) != 0) {
                return -1;
            }
        } else if (read_key(f, &s) != 0) {
            return -1;
        }
    }
    if (more < 0 || finish_section(f, &s) != 0) {
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
    return result;
}

static void write_value(FILE *out, const struct db_class *c, enum db_class_key key)
{
    char value[80] = "";
    double number;
    switch (key) {
    case DB_KEY_COLOUR:
        snprintf(value, sizeof value, "%d %d %d", c->colour[0], c->colour[1], c->colour[2]);
        break;
    case DB_KEY_KIND:
        snprintf(value, sizeof value, "%s", kind_names[c->kind]);
        break;
    case DB_KEY_LIMITS:
        snprintf(value, sizeof value, "%.17g %.17g", c->low_db, c->high_db);
        break;
    case DB_KEY_TEXTURE:
        snprintf(value, sizeof value, "%s", texture_names[c->texture]);
        break;
    case DB_KEY_BORDERS:
        snprintf(value, sizeof value, "%s", border_names[c->is_natural]);
        break;
    default:
        memcpy(&number, (const char *)c + number_keys[key].offset, sizeof number);
        snprintf(value, sizeof value, "%.17g", number);
        break;
    }
    const char *source = c->source[key];
    fprintf(out, source[0] ? "%s = %s   # %s\n" : "%s = %s\n", key_names[key], value, source);
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
            write_value(file.stream, &table->items[i], (enum db_class_key)key);
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
