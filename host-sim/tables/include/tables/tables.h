/* Constant tables that go into the firmware as generated C. To add one: write the function that
 * gives an entry, name it in a set (sets.c), and declare the array in the set's header. */
#ifndef TABLES_H
#define TABLES_H

#include <stdint.h>
#include <stdio.h>

struct table {
    const char *name;    /* of the array in C */
    const char *type;    /* of an entry: "uint16_t" */
    const char *content; /* one line of comment: what an entry is, in which format */
    int rows;            /* 0 for an array of one dimension */
    int columns;
    int64_t (*entry)(int row, int column);
};

/* One generated file. */
struct table_set {
    const char *name;   /* on the command line */
    const char *file;   /* where the build looks for it, below its folder gen/ */
    const char *header; /* which declares the arrays, so that the compiler compares both */
    const struct table *tables;
    int table_count;
};

extern const struct table_set table_sets[];
extern const int table_set_count;

/* The set called `name`, or NULL. */
const struct table_set *table_set_find(const char *name);

/* Write the set as a C file. Returns 0, or -1 when an entry does not fit its type, which is
 * reported; errors of the stream are left for its owner to find. */
int table_set_print(FILE *out, const struct table_set *set);

#endif
