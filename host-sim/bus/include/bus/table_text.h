/* Bus table: the profile of a bus as text, which an integrator writes (docs/bus.md, "A table of
 * your own"). */
#ifndef BUS_TABLE_TEXT_H
#define BUS_TABLE_TEXT_H

#include "lm/bus_profile.h"

#include <stdio.h>

enum { BUS_NAME_BYTES = 64 };

struct bus_table {
    struct lm_bus_profile profile; /* points into this struct */
    struct lm_bus_row rows[LM_BUS_ROWS_MAX];
    char name[BUS_NAME_BYTES];
    char row_names[LM_BUS_ROWS_MAX][BUS_NAME_BYTES];
};

/* Read a table from `in`, called `path` in messages, and check all that the firmware takes for
 * granted of a profile. 0, or -1 with the first error reported by file and line. The table points
 * into itself: it must not be copied. */
int bus_table_read(struct bus_table *table, FILE *in, const char *path);

/* The same of a file. */
int bus_table_load(struct bus_table *table, const char *path);

#endif
