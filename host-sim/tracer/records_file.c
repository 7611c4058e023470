/* The file of traced records: docs/FORMATS.md, "Traced records". */
#include "fx/crc32c.h"
#include "hs/atomic_file.h"
#include "hs/error.h"
#include "hs/input_file.h"
#include "tracer/ends.h"
#include "tracer/records.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

/* Version 2 has ends that are not plain. Whoever knows version 1 alone must not take them for
 * plain. */
enum { PLAIN_VERSION = 1, ENDS_VERSION = 2 };

struct file_head {
    char magic[8];
    uint32_t version, head_bytes;
    double azimuth_deg, depression_deg, wavelength_m;
    uint32_t cells_across, cells_range;
    double cell_m;
    uint32_t columns, rows;
    double step_across_m, step_up_m, low_across_m, low_up_m;
    uint32_t material_count, bounce_count;
    uint32_t record_count[TRACE_BOUNCES_MAX];
    uint32_t record_crc[TRACE_BOUNCES_MAX];
    char materials[TRACE_FILE_MATERIALS_MAX][TRACE_NAME_SIZE];
    double distance_m, receiver_azimuth_deg, receiver_depression_deg, receiver_distance_m;
    uint32_t is_apart;
    uint8_t reserved[72];
    uint32_t crc;
};
_Static_assert(sizeof(struct file_head) == 1280, "the head must be what FORMATS.md says");

static const char magic[8] = {'L', 'M', 'T', 'R', 'A', 'C', 'E', 'S'};

static uint32_t head_crc(const struct file_head *h)
{
    return fx_crc32c(0, h, offsetof(struct file_head, crc));
}

static uint32_t bounce_crc(const struct trace_bounce *b)
{
    return fx_crc32c(0, b->records, b->count * sizeof *b->records);
}

static struct file_head head_of(const struct trace_records *r)
{
    struct file_head h = {
        .version = ends_are_plain(&r->ends) ? PLAIN_VERSION : ENDS_VERSION,
        .head_bytes = sizeof h,
        .azimuth_deg = r->look.azimuth_deg,
        .depression_deg = r->look.depression_deg,
        .wavelength_m = r->look.wavelength_m,
        .cells_across = r->grid.cells_across,
        .cells_range = r->grid.cells_range,
        .cell_m = r->grid.cell_m,
        .columns = r->sensor.columns,
        .rows = r->sensor.rows,
        .step_across_m = r->sensor.step_across_m,
        .step_up_m = r->sensor.step_up_m,
        .low_across_m = r->sensor.low_across_m,
        .low_up_m = r->sensor.low_up_m,
        .material_count = r->material_count,
        .bounce_count = r->bounce_count,
        .distance_m = r->ends.distance_m,
        .receiver_azimuth_deg = r->ends.receiver_azimuth_deg,
        .receiver_depression_deg = r->ends.receiver_depression_deg,
        .receiver_distance_m = r->ends.receiver_distance_m,
        .is_apart = r->ends.is_apart,
    };
    memcpy(h.magic, magic, sizeof magic);
    for (uint32_t b = 0; b < r->bounce_count; b++) {
        h.record_count[b] = r->bounces[b].count;
        h.record_crc[b] = bounce_crc(&r->bounces[b]);
    }
    for (uint32_t m = 0; m < r->material_count; m++) {
        strncpy(h.materials[m], r->materials[m], TRACE_NAME_SIZE - 1);
    }
    h.crc = head_crc(&h);
    return h;
}

int trace_records_write(const struct trace_records *r, const char *path)
{
    struct hs_atomic_file file;
    if (trace_records_check(r, path) != 0) {
        return -1;
    }
    if (r->material_count > TRACE_FILE_MATERIALS_MAX) {
        return hs_error(path, "give parts of the model one material",
                        "has %u materials, more than %d", r->material_count,
                        TRACE_FILE_MATERIALS_MAX);
    }
    if (hs_atomic_open(&file, path) != 0) {
        return -1;
    }
    const struct file_head head = head_of(r);
    fwrite(&head, sizeof head, 1, file.stream);
    for (uint32_t b = 0; b < r->bounce_count; b++) {
        fwrite(r->bounces[b].records, TRACE_RECORD_BYTES, r->bounces[b].count, file.stream);
    }
    return hs_atomic_commit(&file); /* reports a failed fwrite too */
}

static struct trace_ends ends_in(const struct file_head *h)
{
    return (struct trace_ends){h->distance_m, h->is_apart != 0, h->receiver_azimuth_deg,
                               h->receiver_depression_deg, h->receiver_distance_m};
}

static const char *head_fault(const struct file_head *h, uint64_t file_bytes)
{
    if (memcmp(h->magic, magic, sizeof magic) != 0) {
        return "is no file of traced records";
    }
    if ((h->version != PLAIN_VERSION && h->version != ENDS_VERSION) || h->head_bytes != sizeof *h) {
        return "is of another version of landmass-target";
    }
    if (h->crc != head_crc(h)) {
        return "the checksum of its head is wrong";
    }
    const struct trace_ends ends = ends_in(h);
    if (h->is_apart > 1 || (h->version == PLAIN_VERSION) != ends_are_plain(&ends)) {
        return "where its transmitter and receiver stand does not go with its version";
    }
    if (h->material_count > TRACE_FILE_MATERIALS_MAX) {
        return "it counts more materials than it names";
    }
    uint64_t bytes = sizeof *h;
    for (uint32_t b = 0; b < TRACE_BOUNCES_MAX; b++) {
        bytes += (uint64_t)h->record_count[b] * TRACE_RECORD_BYTES;
        if (b >= h->bounce_count && h->record_count[b] != 0) {
            return "it counts records of a bounce that it has not";
        }
    }
    return bytes == file_bytes ? NULL : "its length is not what its head says";
}

static void take_head(struct trace_records *r, const struct file_head *h)
{
    *r = (struct trace_records){
        .look = {h->azimuth_deg, h->depression_deg, h->wavelength_m},
        .grid = {h->cells_across, h->cells_range, h->cell_m},
        .sensor = {h->columns, h->rows, h->step_across_m, h->step_up_m, h->low_across_m,
                   h->low_up_m},
        .material_count = h->material_count,
        .bounce_count = h->bounce_count,
        .ends = ends_in(h),
    };
    memcpy(r->materials, h->materials, sizeof h->materials);
}

static int read_bounce(struct trace_bounce *b, uint32_t count, uint32_t crc, FILE *in,
                       const char *path)
{
    if (count == 0) {
        return crc == 0 ? 0 : hs_error(path, "copy it again", "a checksum is wrong");
    }
    b->records = malloc((size_t)count * sizeof *b->records);
    if (!b->records) {
        return hs_error(path, NULL, "out of memory for %u records", count);
    }
    b->count = count;
    if (fread(b->records, sizeof *b->records, count, in) != count) {
        return hs_error(path, "copy it again", "cannot be read to its end");
    }
    return bounce_crc(b) == crc ? 0 : hs_error(path, "copy it again", "a checksum is wrong");
}

static int read_all(struct trace_records *r, FILE *in, const char *path)
{
    struct file_head head;
    struct stat status;
    if (fstat(fileno(in), &status) != 0 || fread(&head, sizeof head, 1, in) != 1) {
        return hs_error(path, "give a file that landmass-target trace made",
                        "is too short for traced records");
    }
    const char *fault = head_fault(&head, (uint64_t)status.st_size);
    if (fault) {
        return hs_error(path, "copy it again, or trace the target again", "%s", fault);
    }
    take_head(r, &head);
    for (uint32_t b = 0; b < TRACE_BOUNCES_MAX; b++) {
        if (read_bounce(&r->bounces[b], head.record_count[b], head.record_crc[b], in, path) != 0) {
            return -1;
        }
    }
    return trace_records_check(r, path);
}

int trace_records_read(struct trace_records *r, const char *path)
{
    *r = (struct trace_records){0};
    FILE *in = hs_input_open(path, "rb");
    if (!in) {
        return hs_error(path, "check the name", "cannot be opened: %s", strerror(errno));
    }
    const int result = read_all(r, in, path);
    fclose(in);
    if (result != 0) {
        trace_records_free(r);
    }
    return result;
}
