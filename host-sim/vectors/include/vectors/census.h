/* Census of an import: each element of a file has one fate, so that what came in is what was made
 * plus what was left out, each with its reason. */
#ifndef VECTORS_CENSUS_H
#define VECTORS_CENSUS_H

#include <stdint.h>

/* What is counted: the elements of OpenStreetMap (in the order of enum osm_kind), or the features
 * of other formats. */
enum vector_kind { VECTOR_NODES, VECTOR_WAYS, VECTOR_RELATIONS, VECTOR_FEATURES, VECTOR_KINDS };

enum vector_fate {
    VECTOR_MADE,
    VECTOR_NO_TAGS,     /* a vertex, or a part of others */
    VECTOR_NO_RULE,     /* no rule fits */
    VECTOR_LEFT_OUT,    /* a rule says so */
    VECTOR_OUTSIDE,     /* of the area */
    VECTOR_IN_RELATION, /* the relation that it is the ring of was made in its place */
    VECTOR_TOO_SMALL,   /* narrower than half a cell, and no detail */
    VECTOR_REPEATED,    /* the file has it more than once: the first counts */
    VECTOR_DANGLING,    /* what it is made of is not in the file */
    VECTOR_OPEN,        /* an area whose ring does not close */
    VECTOR_NO_AREA,     /* nothing is left of its geometry */
    VECTOR_FATES
};

/* Fates from here on are losses. */
enum { VECTOR_FIRST_LOSS = VECTOR_DANGLING };

struct vector_census {
    uint64_t read[VECTOR_KINDS];
    uint64_t fates[VECTOR_KINDS][VECTOR_FATES];
    uint64_t shortened; /* lines that lack nodes, made of the pieces that are there */
    uint64_t holed;     /* areas that lack a ring, made of the others */
    uint64_t repaired;  /* areas that crossed themselves */
    uint64_t missing;   /* references of ways to nodes that are not in the file */
    uint64_t late;      /* elements that stand before one they should follow */
};

/* Print a table of kinds and fates, and what was mended. `name` is the file's. */
void vector_census_print(const struct vector_census *c, const char *name);

/* The same as the next item of the array that is open in the report (hs/report.h). */
void vector_census_report(const struct vector_census *c, const char *name);

/* Returns 0 when every element read has one fate, or -1 with the error reported: a fault of this
 * program. */
int vector_census_check(const struct vector_census *c, const char *name);

/* Warn of losses, if there are any. */
void vector_census_warn(const struct vector_census *c, const char *name);

#endif
