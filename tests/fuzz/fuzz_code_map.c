/* The map from codes of a land cover to classes: what is accepted has codes in range, each with one
 * class that exists. */
#include "fuzz.h"
#include "gis/code_map.h"

const uint32_t fuzz_mutations = 20000;

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct fuzz_file file;
    static struct db_class_table made;
    static struct db_code_map read; /* no block: it takes longer to get one than to read a text */
    struct db_class_table *table = &made;
    struct db_code_map *map = &read;
    table->count = 2;
    strcpy(table->items[0].name, "soil");
    strcpy(table->items[1].name, "water");
    fuzz_file_open(&file, data, size);
    if (db_code_map_read(map, file.path, table) == 0) {
        FUZZ_ASSERT(map->count > 0 && map->count <= DB_CODE_LINES_MAX);
        for (int i = 0; i < map->count; i++) {
            const struct db_code_line *line = &map->lines[i];
            FUZZ_ASSERT(line->low >= 0 && line->low <= line->high && line->high < DB_CODES);
            FUZZ_ASSERT(memchr(line->legend, 0, sizeof line->legend));
            FUZZ_ASSERT(line->class_index == DB_CLASS_NODATA ||
                        (line->class_index >= 0 && line->class_index < 2));
            FUZZ_ASSERT(db_code_map_class(map, line->low) == line->class_index);
            FUZZ_ASSERT(db_code_map_class(map, line->high) == line->class_index);
        }
        FUZZ_ASSERT(db_code_map_class(map, -1) == DB_CODE_UNKNOWN);
        FUZZ_ASSERT(db_code_map_class(map, DB_CODES) == DB_CODE_UNKNOWN);
    }
    fuzz_file_close(&file);
    return 0;
}
