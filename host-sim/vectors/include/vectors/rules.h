/* Rules of an import: what each tagged feature of a vector file becomes. A text file of sections,
 * `[name]` and `key = value   # remark` (docs/FORMATS.md, "Rules for vectors"):
 *
 *     from        area | line | point
 *     where       conditions, all of which must hold: key=value, key=a|b, key=*, key!=value, !key
 *     leave_out   why: the feature is known, and makes nothing
 *     class       class burnt into the class plane
 *     land        of a coast: class of what lies on its left
 *     width       measure of a line's class, or of the edges that a railing runs along
 *     height      measure of structures and trees, walls and masts
 *     min_height  measure of where a building begins above the ground
 *     detail      building | part | wall | fence | rail | railing | wire | mast | surface | coast
 *     gabled      conditions of a gabled roof
 *     order       0..99: higher ones are burnt over lower ones
 *
 * A measure is a list of `tag`, `tag x FACTOR` and, at its end, a number of metres that holds where
 * no tag does. The first rule of the file that fits decides. */
#ifndef VECTORS_RULES_H
#define VECTORS_RULES_H

#include "hs/class_table.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum {
    VECTOR_RULES_MAX = 128,
    VECTOR_CONDITIONS_MAX = 8,
    VECTOR_TERMS_MAX = 6,
    VECTOR_KEY_SIZE = 48,
    VECTOR_VALUES_SIZE = 320,
    VECTOR_NO_TERM = VECTOR_TERMS_MAX
};

enum vector_shape { VECTOR_POINT, VECTOR_LINE, VECTOR_AREA, VECTOR_SHAPES };

enum vector_detail {
    VECTOR_PLAIN, /* none: the class plane alone */
    VECTOR_BUILDING,
    VECTOR_PART, /* of a building: stands for the outline that holds it */
    VECTOR_WALL,
    VECTOR_FENCE,
    VECTOR_RAIL,
    VECTOR_RAILING,
    VECTOR_WIRE,
    VECTOR_MAST,
    VECTOR_SURFACE, /* straight paving of the line's class and width, with its verges */
    VECTOR_COAST,   /* land on the left */
    VECTOR_DETAILS
};

/* Key and value by turns, as a file gives them; borrowed. */
struct vector_tags {
    const char *const *texts;
    size_t count; /* pairs */
};

struct vector_condition {
    char key[VECTOR_KEY_SIZE];
    char values[VECTOR_VALUES_SIZE]; /* "a|b|c"; empty: any */
    bool is_negated;
};

struct vector_conditions {
    struct vector_condition items[VECTOR_CONDITIONS_MAX];
    int count;
};

/* One way to find a number: a tag times a factor, or the number itself. */
struct vector_term {
    char tag[VECTOR_KEY_SIZE]; /* empty: a number */
    double factor;             /* or the number, metres */
};

struct vector_measure {
    struct vector_term terms[VECTOR_TERMS_MAX];
    int count; /* 0: not given */
};

struct vector_rule {
    char name[DB_NAME_SIZE];
    enum vector_shape from;
    struct vector_conditions where, gabled;
    char leave_out[120];
    int class_index, land_index; /* of the class table, or -1 */
    struct vector_measure width, height, min_height;
    enum vector_detail detail;
    int order;
};

struct vector_rules {
    struct vector_rule items[VECTOR_RULES_MAX];
    int count;
};

/* Read a file of rules. Returns 0, or -1 with file, line, cause and remedy reported:
 * - the file cannot be read, or holds no rule or more than VECTOR_RULES_MAX,
 * - a line is neither a heading nor a value, a name or key stands twice or is unknown,
 * - a class is not in the table, or a condition, measure or number is none,
 * - a rule lacks what it needs: `from`, `where`, and `class`, `detail` or `leave_out`; a class of a
 *   line its width; a building, wall or mast its height; a coast its class and land. */
int vector_rules_read(struct vector_rules *rules, const char *path,
                      const struct db_class_table *table);

/* The first rule for a feature of these tags that can be had in these shapes (bits 1 << enum
 * vector_shape), or -1. */
int vector_rules_find(const struct vector_rules *rules, unsigned shapes,
                      const struct vector_tags *tags);

/* Whether all hold; true of none. */
bool vector_conditions_hold(const struct vector_conditions *c, const struct vector_tags *tags);

/* The value of a tag, or NULL. */
const char *vector_tag(const struct vector_tags *tags, const char *key);

/* What a measure gives for a feature. */
struct vector_measured {
    double metres;
    int term;    /* which one of the measure gave it; VECTOR_NO_TERM: none, and 0 m */
    bool is_odd; /* a tag before it was there, but was no number of 0 to VECTOR_METRES_MAX */
};

enum { VECTOR_METRES_MAX = 1000 };

/* Metres by the first term that has a number. A tag's number may have a unit: m, ft, ', or feet and
 * inches (6'2"). */
struct vector_measured vector_measure_of(const struct vector_measure *m,
                                         const struct vector_tags *tags);

#endif
