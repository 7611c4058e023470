/* The class table of landmass-db: what is accepted keeps the limits of class_table.h. */
#include "fuzz.h"
#include "hs/class_table.h"

#include <math.h>

const uint32_t fuzz_mutations = 20000;

static void check_class(const struct db_class *c)
{
    FUZZ_ASSERT(c->name[0] && memchr(c->name, 0, sizeof c->name));
    FUZZ_ASSERT(c->kind <= DB_KIND_TREES && c->texture <= DB_TEXTURE_K);
    FUZZ_ASSERT(c->gamma_db >= -80 && c->gamma_db <= 40);
    FUZZ_ASSERT(c->low_db <= c->gamma_db && c->gamma_db <= c->high_db);
    FUZZ_ASSERT(c->spread_db >= 0 && c->spread_db <= 20);
    FUZZ_ASSERT(c->texture_shape >= 0.1 && c->texture_shape <= 1000);
    FUZZ_ASSERT(c->height_m >= 0 && c->height_m <= 500);
    FUZZ_ASSERT(c->looks >= 1 && c->looks <= 64);
    for (int i = 0; i < DB_KEY_COUNT; i++) {
        FUZZ_ASSERT(memchr(c->source[i], 0, sizeof c->source[i]));
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct fuzz_file file;
    struct db_class_table *table = malloc(sizeof *table);
    FUZZ_ASSERT(table);
    fuzz_file_open(&file, data, size);
    if (db_class_table_read(table, file.path) == 0) {
        char names[64];
        FUZZ_ASSERT(table->count >= 1 && table->count <= DB_CLASS_MAX);
        for (int i = 0; i < table->count; i++) {
            check_class(&table->items[i]);
            FUZZ_ASSERT(db_class_find(table, table->items[i].name) == i);
        }
        db_class_names(table, names, sizeof names);
        FUZZ_ASSERT(memchr(names, 0, sizeof names));
    }
    fuzz_file_close(&file);
    free(table);
    return 0;
}
