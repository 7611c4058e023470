/* The class table of landmass-db: what is accepted keeps the limits of class_table.h. */
#include "fuzz.h"
#include "hs/class_table.h"

#include <math.h>

const uint32_t fuzz_mutations = 20000;

static void check_class(const struct db_class *c)
{
    FUZZ_ASSERT(c->name[0] && memchr(c->name, 0, sizeof c->name));
    FUZZ_ASSERT(c->kind <= DB_KIND_TREES && c->texture <= DB_TEXTURE_K);
    FUZZ_ASSERT(c->texture_shape >= 0.1 && c->texture_shape <= 1000);
    FUZZ_ASSERT(c->height_m >= 0 && c->height_m <= 500);
    FUZZ_ASSERT(c->looks >= 1 && c->looks <= 64);
    for (int i = 0; i < DB_KEY_COUNT; i++) {
        FUZZ_ASSERT(memchr(c->source[i], 0, sizeof c->source[i]));
    }
}

static void check_chosen(const struct db_class *c, enum hs_sensor sensor)
{
    FUZZ_ASSERT(c->gamma_db >= -80 && c->gamma_db <= 40);
    FUZZ_ASSERT(c->low_db <= c->gamma_db && c->gamma_db <= c->high_db);
    FUZZ_ASSERT(c->spread_db >= 0 && c->spread_db <= 20);
    if (sensor == HS_SENSOR_IR) {
        const struct db_thermal *t = &c->thermal;
        FUZZ_ASSERT(c->high_db <= 0);
        FUZZ_ASSERT(t->emissivity >= 0.05 && t->emissivity <= 0.999);
        FUZZ_ASSERT(t->emissivity_spread >= 0 && t->emissivity_spread <= 0.2);
        FUZZ_ASSERT(t->albedo >= 0 && t->albedo <= 0.95);
        FUZZ_ASSERT(t->albedo_spread >= 0 && t->albedo_spread <= 0.3);
        FUZZ_ASSERT(t->conductivity >= 0.01 && t->conductivity <= 10000);
        FUZZ_ASSERT(t->conductivity_spread >= 0 && t->conductivity_spread <= 5000);
        FUZZ_ASSERT(t->heat_capacity >= 0.01 && t->heat_capacity <= 10);
        FUZZ_ASSERT(t->wetness >= 0 && t->wetness <= 1);
        FUZZ_ASSERT(t->roughness_m >= 1e-6 && t->roughness_m <= 5);
    }
}

/* Each sensor has levels within its limits, or is refused. */
static void check_sensors(struct db_class_table *table, const char *path)
{
    for (int s = 0; s < HS_SENSOR_COUNT; s++) {
        const enum hs_sensor sensor = (enum hs_sensor)s;
        if (db_class_table_choose(table, path, sensor) == 0) {
            for (int i = 0; i < table->count; i++) {
                check_chosen(&table->items[i], sensor);
            }
        } else {
            FUZZ_ASSERT(s != HS_SENSOR_X);
        }
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
        check_sensors(table, file.path);
        db_class_names(table, names, sizeof names);
        FUZZ_ASSERT(memchr(names, 0, sizeof names));
    }
    fuzz_file_close(&file);
    free(table);
    return 0;
}
