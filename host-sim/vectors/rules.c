#include "vectors/rules.h"

#include "hs/error.h"
#include "hs/number.h"
#include "hs/text_file.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *const shape_names[VECTOR_SHAPES] = {"point", "line", "area"};
static const char *const detail_names[VECTOR_DETAILS] = {"none",  "building", "part",    "wall",
                                                         "fence", "rail",     "railing", "wire",
                                                         "mast",  "surface",  "coast"};

/* ---- tags ---- */

const char *vector_tag(const struct vector_tags *tags, const char *key)
{
    for (size_t i = 0; i < tags->count; i++) {
        if (strcmp(tags->texts[2 * i], key) == 0) {
            return tags->texts[2 * i + 1];
        }
    }
    return NULL;
}

/* Is a value one of "a|b|c"? */
static bool is_among(const char *values, const char *value)
{
    const size_t length = strlen(value);
    for (const char *at = values; *at;) {
        const size_t word = strcspn(at, "|");
        if (word == length && memcmp(at, value, length) == 0) {
            return true;
        }
        at += word + (at[word] == '|');
    }
    return false;
}

bool vector_conditions_hold(const struct vector_conditions *c, const struct vector_tags *tags)
{
    for (int i = 0; i < c->count; i++) {
        const struct vector_condition *one = &c->items[i];
        const char *value = vector_tag(tags, one->key);
        const bool fits = value && (!one->values[0] || is_among(one->values, value));
        if (fits == one->is_negated) {
            return false;
        }
    }
    return true;
}

int vector_rules_find(const struct vector_rules *rules, unsigned shapes,
                      const struct vector_tags *tags)
{
    for (int i = 0; i < rules->count; i++) {
        if ((shapes & 1u << rules->items[i].from) &&
            vector_conditions_hold(&rules->items[i].where, tags)) {
            return i;
        }
    }
    return -1;
}

/* Metres of "12", "12.5 m", "40 ft", "40'" or 6'2"; false when it is none of these. */
static bool read_metres(const char *text, double *metres)
{
    static const double foot_m = 0.3048;
    double inches;
    const char *end = hs_number_begin(text, metres);
    if (!end) {
        return false;
    }
    end += strspn(end, " ");
    if (strcmp(end, "ft") == 0 || strcmp(end, "feet") == 0 || strcmp(end, "'") == 0) {
        *metres *= foot_m;
        return true;
    }
    if (*end == '\'') {
        end = hs_number_begin(end + 1, &inches);
        if (!end || strcmp(end, "\"") != 0) {
            return false;
        }
        *metres = (*metres + inches / 12) * foot_m;
        return true;
    }
    return *end == '\0' || strcmp(end, "m") == 0;
}

struct vector_measured vector_measure_of(const struct vector_measure *m,
                                         const struct vector_tags *tags)
{
    struct vector_measured found = {.term = VECTOR_NO_TERM};
    for (int i = 0; i < m->count; i++) {
        const struct vector_term *t = &m->terms[i];
        double metres = 1;
        const char *value = t->tag[0] ? vector_tag(tags, t->tag) : "";
        if (!value) {
            continue;
        }
        if ((t->tag[0] && !read_metres(value, &metres)) || metres < 0 ||
            !(t->factor * metres <= VECTOR_METRES_MAX)) {
            found.is_odd = true;
            continue;
        }
        found.metres = t->factor * metres;
        found.term = i;
        break;
    }
    return found;
}

/* ---- values of the file ---- */

/* What a section has had so far. */
struct reading {
    struct db_text_file file;
    struct vector_rules *rules;
    const struct db_class_table *table;
    struct vector_rule *rule; /* NULL before the first [name] */
    uint32_t keys;            /* bit of each key that was given */
};

static int copy_text(const struct reading *r, char *to, size_t size, const char *from)
{
    if ((size_t)snprintf(to, size, "%s", from) >= size) {
        return db_text_error(&r->file, "shorten it", "`%.20s...` is longer than %zu bytes", from,
                             size - 1);
    }
    return 0;
}

static int find_word(const char *const *words, int count, const char *word)
{
    for (int i = 0; i < count; i++) {
        if (strcmp(words[i], word) == 0) {
            return i;
        }
    }
    return -1;
}

/* "key=value", "key=a|b", "key=*", "key!=value", "!key" or "key". */
static int read_condition(const struct reading *r, char *word, struct vector_condition *c)
{
    char *equals = strchr(word, '=');
    *c = (struct vector_condition){.is_negated = false};
    if (word[0] == '!') {
        c->is_negated = true;
        word++;
    } else if (equals && equals > word && equals[-1] == '!') {
        c->is_negated = true;
        equals[-1] = '\0';
    }
    const char *values = equals ? equals + 1 : "*";
    if (equals) {
        *equals = '\0';
    }
    if (!word[0] || !values[0]) {
        return db_text_error(&r->file, "write key=value, key=a|b, key=*, key!=value or !key",
                             "a condition without a key or a value");
    }
    return copy_text(r, c->key, sizeof c->key, word) != 0 ||
                   copy_text(r, c->values, sizeof c->values,
                             strcmp(values, "*") == 0 ? "" : values) != 0
               ? -1
               : 0;
}

static int read_conditions(const struct reading *r, char *value, struct vector_conditions *c)
{
    char *words[VECTOR_CONDITIONS_MAX];
    c->count = db_text_words(value, words, VECTOR_CONDITIONS_MAX);
    if (c->count > VECTOR_CONDITIONS_MAX) {
        c->count = 0;
        return db_text_error(&r->file, "write two rules", "more than %d conditions",
                             VECTOR_CONDITIONS_MAX);
    }
    for (int i = 0; i < c->count; i++) {
        if (read_condition(r, words[i], &c->items[i]) != 0) {
            return -1;
        }
    }
    return 0;
}

/* "tag", "tag x FACTOR" or a number. */
static int read_term(const struct reading *r, char *text, struct vector_term *t)
{
    char *words[3];
    double unused;
    const int count = db_text_words(text, words, 3);
    *t = (struct vector_term){.factor = 1};
    if (count == 1 && hs_number_within(words[0], 0, VECTOR_METRES_MAX, &t->factor)) {
        return 0;
    }
    t->factor = 1;
    if ((count == 1 || (count == 3 && strcmp(words[1], "x") == 0 &&
                        hs_number_within(words[2], 0.001, 1000, &t->factor))) &&
        !hs_number_begin(words[0], &unused)) {
        return copy_text(r, t->tag, sizeof t->tag, words[0]);
    }
    return db_text_error(&r->file, "write tag, tag x FACTOR, or metres, with commas between",
                         "`%s` is none of a measure", words[0]);
}

static int read_measure(const struct reading *r, char *value, struct vector_measure *m)
{
    char *rest = NULL;
    m->count = 0;
    for (char *one = strtok_r(value, ",", &rest); one; one = strtok_r(NULL, ",", &rest)) {
        if (m->count == VECTOR_TERMS_MAX) {
            return db_text_error(&r->file, "leave some out", "more than %d ways to measure",
                                 VECTOR_TERMS_MAX);
        }
        if (read_term(r, one, &m->terms[m->count++]) != 0) {
            return -1;
        }
    }
    for (int i = 0; i < m->count; i++) {
        if ((m->terms[i].tag[0] == '\0') != (i + 1 == m->count)) {
            return db_text_error(&r->file, "end with what holds where no tag does",
                                 "a measure has one number, the last");
        }
    }
    return m->count > 0 ? 0 : db_text_error(&r->file, "write a number", "the measure is empty");
}

static int read_class(const struct reading *r, const char *name, int *index)
{
    char names[DB_CLASS_MAX * DB_NAME_SIZE];
    *index = db_class_find(r->table, name);
    if (*index >= 0) {
        return 0;
    }
    db_class_names(r->table, names, sizeof names);
    return db_text_error(&r->file, "name one of them, or take classes/landcover.classes",
                         "there is no class `%s` in the class table; it has %s", name, names);
}

static int read_word(const struct reading *r, const char *value, const char *const *words,
                     int count)
{
    const int word = find_word(words, count, value);
    return word >= 0 ? word
                     : db_text_error(&r->file, "see docs/FORMATS.md, \"Rules for vectors\"",
                                     "`%s` is none of the words for this key", value);
}

enum key {
    KEY_FROM,
    KEY_WHERE,
    KEY_LEAVE_OUT,
    KEY_CLASS,
    KEY_LAND,
    KEY_WIDTH,
    KEY_HEIGHT,
    KEY_MIN_HEIGHT,
    KEY_DETAIL,
    KEY_GABLED,
    KEY_ORDER,
    KEYS
};

static const char *const key_names[KEYS] = {"from",   "where",  "leave_out", "class",
                                            "land",   "width",  "height",    "min_height",
                                            "detail", "gabled", "order"};

static int read_order(const struct reading *r, const char *value, int *order)
{
    double number;
    if (!hs_number_within(value, 0, 99, &number) || number != floor(number)) {
        return db_text_error(&r->file, "write a whole number 0..99", "`%s` is no order", value);
    }
    *order = (int)number;
    return 0;
}

static int set_key(const struct reading *r, enum key key, char *value)
{
    struct vector_rule *rule = r->rule;
    int word = 0;
    switch (key) {
    case KEY_FROM:
        word = read_word(r, value, shape_names, VECTOR_SHAPES);
        rule->from = word < 0 ? VECTOR_POINT : (enum vector_shape)word;
        return word < 0 ? -1 : 0;
    case KEY_DETAIL:
        word = read_word(r, value, detail_names, VECTOR_DETAILS);
        rule->detail = word < 0 ? VECTOR_PLAIN : (enum vector_detail)word;
        return word < 0 ? -1 : 0;
    case KEY_WHERE:
        return read_conditions(r, value, &rule->where);
    case KEY_GABLED:
        return read_conditions(r, value, &rule->gabled);
    case KEY_LEAVE_OUT:
        return copy_text(r, rule->leave_out, sizeof rule->leave_out, value);
    case KEY_CLASS:
        return read_class(r, value, &rule->class_index);
    case KEY_LAND:
        return read_class(r, value, &rule->land_index);
    case KEY_WIDTH:
        return read_measure(r, value, &rule->width);
    case KEY_HEIGHT:
        return read_measure(r, value, &rule->height);
    case KEY_MIN_HEIGHT:
        return read_measure(r, value, &rule->min_height);
    default:
        return read_order(r, value, &rule->order);
    }
}

/* ---- sections ---- */

/* What a rule lacks, or NULL. */
static const char *missing(const struct vector_rule *rule, uint32_t keys)
{
    const bool is_built = rule->detail == VECTOR_BUILDING || rule->detail == VECTOR_PART;
    const bool is_high = is_built || rule->detail == VECTOR_WALL || rule->detail == VECTOR_MAST;
    if (!(keys & 1u << KEY_FROM) || !(keys & 1u << KEY_WHERE)) {
        return "`from` and `where`";
    }
    if (rule->leave_out[0]) {
        return NULL;
    }
    if (rule->class_index < 0 && rule->detail == VECTOR_PLAIN) {
        return "`class`, `detail` or `leave_out`";
    }
    if (is_built && (rule->from != VECTOR_AREA || rule->class_index < 0)) {
        return "`from = area` and `class`, which a building needs";
    }
    if (rule->detail == VECTOR_COAST &&
        (rule->from != VECTOR_LINE || rule->class_index < 0 || rule->land_index < 0)) {
        return "`from = line`, `class` and `land`, which a coast needs";
    }
    if ((rule->detail == VECTOR_MAST) != (rule->from == VECTOR_POINT)) {
        return "`from = point` and `detail = mast`, which go together";
    }
    if (is_high && rule->height.count == 0) {
        return "`height`";
    }
    if (rule->detail == VECTOR_SURFACE && (rule->from != VECTOR_LINE || rule->class_index < 0)) {
        return "`from = line`, `class` and `width`, which a surface needs";
    }
    const bool is_burnt_line =
        rule->from == VECTOR_LINE && rule->class_index >= 0 && rule->detail != VECTOR_COAST;
    return is_burnt_line && rule->width.count == 0 ? "`width`, which a line with a class needs"
                                                   : NULL;
}

static int finish_section(const struct reading *r)
{
    const char *lack = r->rule ? missing(r->rule, r->keys) : NULL;
    return lack ? db_text_error(&r->file, "add it to the section", "rule [%s] ends without %s",
                                r->rule->name, lack)
                : 0;
}

static bool is_name(const char *name, size_t length)
{
    return length > 0 && length < DB_NAME_SIZE &&
           strspn(name, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-") ==
               length;
}

static int start_section(struct reading *r)
{
    char *name = r->file.line + 1;
    const size_t length = strcspn(name, "]");
    if (name[length] != ']' || name[length + 1] != '\0') {
        return db_text_error(&r->file, "write [name]", "this is not a heading");
    }
    name[length] = '\0';
    if (!is_name(name, length)) {
        return db_text_error(&r->file, "use at most 31 letters, digits, '_' or '-'",
                             "`%s` is not a name", name);
    }
    for (int i = 0; i < r->rules->count; i++) {
        if (strcmp(r->rules->items[i].name, name) == 0) {
            return db_text_error(&r->file, "remove one of the two",
                                 "rule [%s] is here a second time", name);
        }
    }
    if (r->rules->count == VECTOR_RULES_MAX) {
        return db_text_error(&r->file, "join some", "there are more than %d rules",
                             VECTOR_RULES_MAX);
    }
    r->rule = &r->rules->items[r->rules->count++];
    r->keys = 0;
    *r->rule = (struct vector_rule){.class_index = -1, .land_index = -1, .order = 50};
    memcpy(r->rule->name, name, length + 1);
    return 0;
}

static int read_key(struct reading *r)
{
    char *name, *value;
    if (db_text_split(r->file.line, &name, &value) != 0) {
        return db_text_error(&r->file, "write key = value   # remark",
                             "this line is neither a heading nor a value");
    }
    const int key = find_word(key_names, KEYS, name);
    if (key < 0) {
        return db_text_error(&r->file, "see docs/FORMATS.md, \"Rules for vectors\"",
                             "`%s` is not a known key", name);
    }
    if (!r->rule) {
        return db_text_error(&r->file, "start with [name]", "`%s` stands before any rule", name);
    }
    if (r->keys & 1u << key) {
        return db_text_error(&r->file, "remove one of the two", "`%s` is given twice for [%s]",
                             name, r->rule->name);
    }
    r->keys |= 1u << key;
    return set_key(r, (enum key)key, value);
}

int vector_rules_read(struct vector_rules *rules, const char *path,
                      const struct db_class_table *table)
{
    struct reading r = {.rules = rules, .table = table};
    rules->count = 0;
    int more = db_text_open(&r.file, path) == 0 ? 1 : -1;
    while (more > 0) {
        more = db_text_next(&r.file);
        if (more > 0 && r.file.line[0] == '[') {
            more = finish_section(&r) == 0 && start_section(&r) == 0 ? 1 : -1;
        } else if (more > 0 && read_key(&r) != 0) {
            more = -1;
        }
    }
    if (more == 0 && finish_section(&r) != 0) {
        more = -1;
    }
    db_text_close(&r.file);
    if (more == 0 && rules->count == 0) {
        return hs_error(path, "start from classes/osm.rules", "holds no rule");
    }
    return more;
}
