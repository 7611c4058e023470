/* Rules for vectors: what is accepted has classes, orders and measures in range, and can be asked
 * about any tags. */
#include "fuzz.h"
#include "vectors/rules.h"

#include <math.h>

const uint32_t fuzz_mutations = 20000;

static void check_measure(const struct vector_measure *m, const struct vector_tags *tags)
{
    FUZZ_ASSERT(m->count >= 0 && m->count <= VECTOR_TERMS_MAX);
    const struct vector_measured found = vector_measure_of(m, tags);
    FUZZ_ASSERT(found.metres >= 0 && found.metres <= VECTOR_METRES_MAX);
    FUZZ_ASSERT(m->count == 0 || found.term < m->count); /* the last one always holds */
}

static void check_rule(const struct vector_rule *r, const struct vector_tags *tags)
{
    FUZZ_ASSERT(r->name[0] && memchr(r->name, 0, sizeof r->name));
    FUZZ_ASSERT(r->from < VECTOR_SHAPES && r->detail < VECTOR_DETAILS);
    FUZZ_ASSERT(r->class_index >= -1 && r->class_index < 2);
    FUZZ_ASSERT(r->land_index >= -1 && r->land_index < 2);
    FUZZ_ASSERT(r->order >= 0 && r->order <= 99);
    check_measure(&r->width, tags);
    check_measure(&r->height, tags);
    check_measure(&r->min_height, tags);
    vector_conditions_hold(&r->gabled, tags);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const char *const texts[] = {"building", "yes", "height", "12 ft", "width", "x", "", ""};
    const struct vector_tags tags = {texts, 4};
    struct fuzz_file file;
    struct db_class_table *table = calloc(1, sizeof *table);
    struct vector_rules *rules = malloc(sizeof *rules);
    FUZZ_ASSERT(table && rules);
    table->count = 2;
    strcpy(table->items[0].name, "structure");
    strcpy(table->items[1].name, "water");
    fuzz_file_open(&file, data, size);
    if (vector_rules_read(rules, file.path, table) == 0) {
        FUZZ_ASSERT(rules->count > 0 && rules->count <= VECTOR_RULES_MAX);
        for (int i = 0; i < rules->count; i++) {
            check_rule(&rules->items[i], &tags);
        }
        FUZZ_ASSERT(vector_rules_find(rules, 7, &tags) < rules->count);
    }
    fuzz_file_close(&file);
    free(rules);
    free(table);
    return 0;
}
