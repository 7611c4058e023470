/* The map from labels to classes: what is accepted names classes that exist. */
#include "fuzz.h"
#include "gis/label_map.h"

const uint32_t fuzz_mutations = 40000;

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct fuzz_file file;
    struct db_class_table *table = calloc(1, sizeof *table);
    struct db_label_map *map = malloc(sizeof *map);
    FUZZ_ASSERT(table && map);
    table->count = 3;
    strcpy(table->items[0].name, "soil");
    strcpy(table->items[1].name, "trees");
    strcpy(table->items[2].name, "water");
    fuzz_file_open(&file, data, size);
    if (db_label_map_read(map, file.path, table) == 0) {
        FUZZ_ASSERT(map->count >= 0 && map->count <= DB_MAP_MAX);
        for (int i = 0; i < map->count; i++) {
            const char *label = map->items[i].label;
            FUZZ_ASSERT(map->items[i].class_index >= -1 && map->items[i].class_index < 3);
            FUZZ_ASSERT((db_label_map_find(map, label) >= 0) ==
                        !db_label_map_is_ignored(map, label));
            FUZZ_ASSERT(db_label_map_nearest(map, label) != NULL);
        }
    }
    fuzz_file_close(&file);
    free(map);
    free(table);
    return 0;
}
