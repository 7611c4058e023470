#include "gis/label_map.h"

#include "hs/text_file.h"

#include <string.h>

static int add(struct db_label_map *map, const char *label, int class_index)
{
    strncpy(map->items[map->count].label, label, DB_LABEL_SIZE - 1);
    map->items[map->count++].class_index = class_index;
    return 0;
}

static int read_line(const struct db_text_file *f, struct db_label_map *map,
                     const struct db_class_table *table)
{
    char *label, *class_name;
    if (db_text_split(f->line, &label, &class_name) != 0) {
        return db_text_error(f, "write source-label = class", "this line maps nothing");
    }
    const int class_index = db_class_find(table, class_name);
    if (class_index < 0) {
        char names[DB_CLASS_MAX * DB_NAME_SIZE];
        db_class_names(table, names, sizeof names);
        return db_text_error(f, NULL, "there is no class `%s` in the class table; it has %s",
                             class_name, names);
    }
    if (strlen(label) >= DB_LABEL_SIZE) {
        return db_text_error(f, "shorten it in the source", "the label is longer than %d",
                             DB_LABEL_SIZE - 1);
    }
    if (db_label_map_find(map, label) >= 0) {
        return db_text_error(f, "remove one of the two", "label `%s` is mapped twice", label);
    }
    if (map->count == DB_MAP_MAX) {
        return db_text_error(f, "leave out those that are not used", "more than %d labels",
                             DB_MAP_MAX);
    }
    return add(map, label, class_index);
}

int db_label_map_read(struct db_label_map *map, const char *path,
                      const struct db_class_table *table)
{
    *map = (struct db_label_map){0};
    if (!path) {
        map->is_default = true;
        for (int i = 0; i < table->count; i++) {
            add(map, table->items[i].name, i);
        }
        return 0;
    }
    struct db_text_file f;
    if (db_text_open(&f, path) != 0) {
        return -1;
    }
    int more;
    while ((more = db_text_next(&f)) > 0) {
        if (read_line(&f, map, table) != 0) {
            more = -1;
            break;
        }
    }
    db_text_close(&f);
    return more;
}

int db_label_map_find(const struct db_label_map *map, const char *label)
{
    for (int i = 0; i < map->count; i++) {
        if (strcmp(map->items[i].label, label) == 0) {
            return map->items[i].class_index;
        }
    }
    return -1;
}
