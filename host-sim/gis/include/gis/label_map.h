/* Label map: which class each label of a source stands for, from a text file of `source-label =
 * class` lines. */
#ifndef GIS_LABEL_MAP_H
#define GIS_LABEL_MAP_H

#include "gis/polygons.h"
#include "hs/class_table.h"

#include <stdbool.h>

enum { DB_MAP_MAX = 256 };

struct db_label_map {
    struct {
        char label[DB_LABEL_SIZE];
        int class_index;
    } items[DB_MAP_MAX];
    int count;
    bool is_default; /* each class stands for itself, and need not occur */
};

/* Read the map; `path` may be NULL: then each class stands for itself. Returns 0, or -1 with file,
 * line, cause and remedy reported:
 * - the file cannot be read, or a line has no '=',
 * - a class is not in the table,
 * - a label is too long, or there are more than DB_MAP_MAX. */
int db_label_map_read(struct db_label_map *map, const char *path,
                      const struct db_class_table *table);

/* The class of a label, or -1 when the map leaves it out. */
int db_label_map_find(const struct db_label_map *map, const char *label);

#endif
