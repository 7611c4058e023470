/* The name of a tile of OGC CDB: what is accepted lies in its geocell and in the world. A digit
 * more in it names another tile or none. */
#include "fuzz.h"
#include "visual/cdb.h"

const uint32_t fuzz_mutations = 200000;

static void check_place(const struct cdb_tile *t)
{
    const struct cdb_area a = cdb_tile_area(t);
    const int width = cdb_geocell_width(t->latitude);
    FUZZ_ASSERT(t->latitude >= -90 && t->latitude < 90);
    FUZZ_ASSERT(t->longitude >= -180 && t->longitude < 180);
    FUZZ_ASSERT(t->level >= CDB_LEVEL_MIN && t->level <= CDB_LEVEL_MAX);
    FUZZ_ASSERT(a.south >= t->latitude && a.north <= t->latitude + 1);
    FUZZ_ASSERT(a.west >= t->longitude && a.east <= t->longitude + width);
    FUZZ_ASSERT(a.south < a.north && a.west < a.east);
}

/* A digit more, put in anywhere before the ending, is read otherwise or not at all. */
static void check_digit(const struct cdb_tile *t, const char *name, size_t at)
{
    char longer[80];
    struct cdb_tile other;
    snprintf(longer, sizeof longer, "%.*s1%s", (int)at, name, name + at);
    if (cdb_tile_read_name(&other, longer)) {
        check_place(&other);
        FUZZ_ASSERT(other.up != t->up || other.right != t->right || other.level != t->level);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char *name = malloc(size + 1);
    struct cdb_tile t = {.path = ""};
    FUZZ_ASSERT(name);
    memcpy(name, data, size);
    name[size] = '\0';
    if (cdb_tile_read_name(&t, name)) {
        const size_t length = strcspn(name, ".");
        FUZZ_ASSERT(length < 64);
        name[length] = '\0';
        check_place(&t);
        for (size_t at = 0; at <= length; at++) {
            check_digit(&t, name, at);
        }
    }
    free(name);
    return 0;
}
