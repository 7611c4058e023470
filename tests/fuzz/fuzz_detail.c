/* Detail as text: what is accepted becomes records that the firmware takes. */
#include "build/detail.h"
#include "fuzz.h"

const uint32_t fuzz_mutations = 15000;

enum { SHIFT0 = 9 };

/* Made for the first input and kept: every input is read with the same classes. Their spread takes
 * most of the time of a long wall and is not what is tried here, so that few inputs have it. */
static const struct build_detail_settings *settings(bool has_spread)
{
    static struct db_class_table table, flat_table;
    static struct db_reflect_law laws[DB_CLASS_MAX], flat_laws[DB_CLASS_MAX];
    static struct build_facing facing;
    static const struct build_detail_settings made = {
        .shift0 = SHIFT0, .seed = 1, .table = &table, .laws = laws, .facing = &facing};
    static const struct build_detail_settings flat = {
        .shift0 = SHIFT0, .seed = 1, .table = &flat_table, .laws = flat_laws, .facing = &facing};
    if (table.count == 0) {
        FUZZ_ASSERT(db_class_table_read(&table, "host-sim/programs/db/classes/heaton6.classes") ==
                    0);
        flat_table = table;
        for (int i = 0; i < table.count; i++) {
            flat_table.items[i].spread_db = 0;
            db_reflect_law_init(&laws[i], &table.items[i], 10);
            db_reflect_law_init(&flat_laws[i], &flat_table.items[i], 10);
        }
    }
    return has_spread ? &made : &flat;
}

static void check_record(const struct build_detail *d, const struct build_detail_record *r)
{
    const size_t at = (size_t)r->place * LM_DETAIL_UNIT_BYTES;
    const uint32_t bytes = r->units * LM_DETAIL_UNIT_BYTES;
    struct lm_detail record;
    FUZZ_ASSERT(bytes <= sizeof record && at + bytes <= d->section_bytes);
    memcpy(&record, d->section + at, bytes);
    FUZZ_ASSERT(lm_detail_check(&record, bytes, 0, r->row, r->column) == LM_OK);
    FUZZ_ASSERT(record.count == r->items);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct fuzz_file file;
    struct build_detail d;
    fuzz_file_open(&file, data, size);
    if (build_detail_read(&d, file.path, settings(size % 64 == 0)) == 0) {
        for (uint32_t i = 0; i < d.record_count; i++) {
            check_record(&d, &d.records[i]);
        }
        build_detail_free(&d);
    }
    fuzz_file_close(&file);
    return 0;
}
