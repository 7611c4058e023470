/* Traced records: what is accepted can be expanded, put into cells and followed to its parents. The
 * checksums are put right first, or nothing but the first byte would ever be looked at. */
#include "fuzz.h"
#include "fx/crc32c.h"
#include "tracer/ends.h"
#include "tracer/records.h"

const uint32_t fuzz_mutations = 15000;

enum { HEAD = 1280, COUNTS = 104, CRCS = 124, CRC = HEAD - 4 };

static void put_u32(uint8_t *at, uint32_t value)
{
    memcpy(at, &value, sizeof value);
}

/* docs/FORMATS.md, "Traced records". */
static void seal(uint8_t *file, size_t size)
{
    size_t at = HEAD;
    for (uint32_t b = 0; size >= HEAD && b < TRACE_BOUNCES_MAX; b++) {
        uint32_t count;
        memcpy(&count, file + COUNTS + 4 * b, sizeof count);
        if (count > (size - at) / TRACE_RECORD_BYTES) {
            break;
        }
        put_u32(file + CRCS + 4 * b, fx_crc32c(0, file + at, count * TRACE_RECORD_BYTES));
        at += count * TRACE_RECORD_BYTES;
    }
    if (size >= HEAD) {
        put_u32(file + CRC, fx_crc32c(0, file, CRC));
    }
}

static void use(const struct trace_records *r)
{
    const size_t rays = (size_t)r->sensor.columns * r->sensor.rows;
    float *image = rays <= 1 << 16 ? malloc(rays * sizeof *image) : NULL;
    for (uint32_t b = 0; b < r->bounce_count; b++) {
        for (int channel = 0; image && channel < TRACE_CHANNELS; channel++) {
            trace_image(r, b, (enum trace_channel)channel, image);
        }
        for (uint32_t i = 0; i < r->bounces[b].count; i++) {
            const struct trace_record *t = &r->bounces[b].records[i];
            FUZZ_ASSERT(trace_cell(&r->grid, t->across_m, t->range_m) <
                        (int32_t)(r->grid.cells_across * r->grid.cells_range));
            FUZZ_ASSERT(!(ends_echo_m2(r, b, t) < 0));
            FUZZ_ASSERT(b == 0 || r->bounces[b - 1].records[t->parent].ray == t->ray);
        }
    }
    free(image);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct fuzz_file file;
    struct trace_records r;
    uint8_t *sealed = malloc(size + 1);
    FUZZ_ASSERT(sealed);
    memcpy(sealed, data, size);
    seal(sealed, size);
    fuzz_file_open(&file, sealed, size);
    if (trace_records_read(&r, file.path) == 0) {
        use(&r);
        trace_records_free(&r);
    }
    fuzz_file_close(&file);
    free(sealed);
    return 0;
}
