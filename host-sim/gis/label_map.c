#include "gis/label_map.h"

#include "hs/error.h"
#include "hs/text_file.h"

#include <string.h>

static const char ignore[] = "ignore";

static int add(struct db_label_map *map, const char *label, int class_index)
{
    strncpy(map->items[map->count].label, label, DB_LABEL_SIZE - 1);
    map->items[map->count++].class_index = class_index;
    return 0;
}

static int find_item(const struct db_label_map *map, const char *label)
{
    for (int i = 0; i < map->count; i++) {
        if (strcmp(map->items[i].label, label) == 0) {
            return i;
        }
    }
    return -1;
}

static int read_line(const struct db_text_file *f, struct db_label_map *map,
                     const struct db_class_table *table)
{
    char *label, *class_name;
    if (db_text_split(f->line, &label, &class_name) != 0) {
        return db_text_error(f, "write source-label = class", "this line maps nothing");
    }
    const int class_index = db_class_find(table, class_name);
    if (class_index < 0 && strcmp(class_name, ignore) != 0) {
        char names[DB_CLASS_MAX * DB_NAME_SIZE];
        db_class_names(table, names, sizeof names);
        return db_text_error(f, NULL,
                             "there is no class `%s` in the class table; it has %s, ignore",
                             class_name, names);
    }
    if (strlen(label) >= DB_LABEL_SIZE) {
        return db_text_error(f, "shorten it in the source", "the label is longer than %d",
                             DB_LABEL_SIZE - 1);
    }
    if (find_item(map, label) >= 0) {
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
        return find_item(map, ignore) < 0 ? add(map, ignore, -1) : 0;
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

int db_label_map_ignore(struct db_label_map *map, const char *label)
{
    const int i = find_item(map, label);
    if (i >= 0) {
        map->items[i].class_index = -1;
        return 0;
    }
    if (strlen(label) >= DB_LABEL_SIZE || map->count == DB_MAP_MAX) {
        return hs_error("--ignore", "shorten the label, or the map",
                        "`%s` is too long, or one label too many", label);
    }
    return add(map, label, -1);
}

int db_label_map_find(const struct db_label_map *map, const char *label)
{
    const int i = find_item(map, label);
    return i < 0 ? -1 : map->items[i].class_index;
}

bool db_label_map_is_ignored(const struct db_label_map *map, const char *label)
{
    const int i = find_item(map, label);
    return i >= 0 && map->items[i].class_index < 0;
}

/* Letters to insert, remove or replace (Wagner and Fischer, Journal of the ACM 21, 1974, p. 168).
 */
static int distance(const char *a, const char *b)
{
    int row[DB_LABEL_SIZE];
    const int width = (int)strlen(b);
    for (int j = 0; j <= width; j++) {
        row[j] = j;
    }
    for (int i = 0; a[i]; i++) {
        int diagonal = row[0];
        row[0] = i + 1;
        for (int j = 1; j <= width; j++) {
            int best = diagonal + (a[i] != b[j - 1]);
            best = row[j] + 1 < best ? row[j] + 1 : best;
            best = row[j - 1] + 1 < best ? row[j - 1] + 1 : best;
            diagonal = row[j];
            row[j] = best;
        }
    }
    return row[width];
}

const char *db_label_map_nearest(const struct db_label_map *map, const char *label)
{
    const char *nearest = NULL;
    int least = strlen(label) < 5 ? 2 : 3;
    for (int i = 0; i < map->count; i++) {
        const int d = distance(label, map->items[i].label);
        if (d < least) {
            least = d;
            nearest = map->items[i].label;
        }
    }
    return nearest;
}
