/* Label map: which class each label of a source stands for, from a text file of `source-label =
 * class` lines. The word `ignore` in place of a class, unless a class is called so, means that what
 * lies under the label, clouds say, is not to be looked at. */
#ifndef GIS_LABEL_MAP_H
#define GIS_LABEL_MAP_H

#include "gis/polygons.h"
#include "hs/class_table.h"

#include <stdbool.h>

enum { DB_MAP_MAX = 256 };

struct db_label_map {
    struct {
        char label[DB_LABEL_SIZE];
        int class_index; /* -1: ignored */
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

/* Ignore a label, whatever the map says of it. Returns 0, or -1 reported: too long, or too many. */
int db_label_map_ignore(struct db_label_map *map, const char *label);

/* The class of a label, or -1 when the map leaves it out or ignores it. */
int db_label_map_find(const struct db_label_map *map, const char *label);

/* Whether the map says that the label is to be ignored. Without a file the label `ignore` is. */
bool db_label_map_is_ignored(const struct db_label_map *map, const char *label);

/* The label of the map that `label` may be a misspelling of: one or, of five letters or more, two
 * letters too many, too few or other. NULL when there is none. */
const char *db_label_map_nearest(const struct db_label_map *map, const char *label);

#endif
