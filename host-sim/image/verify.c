#include "image/verify.h"

#include "hs/crc32c.h"
#include "hs/progress.h"
#include "hs/team.h"
#include "image/grid.h"
#include "image/signatures.h"
#include "image/targets.h"
#include "verify_parts.h"

#include <inttypes.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

/* ---- sections ---- */

static void check_section_crcs(struct verify *v)
{
    const struct lm_image_header *h = &v->image->header;
    for (uint32_t i = 0; i < h->section_count; i++) {
        const struct lm_image_section *s = &h->sections[i];
        if (hs_crc32c(0, v->image->bytes + s->offset, s->bytes) != s->crc) {
            image_find(v->findings, s->offset, "section %s: its checksum does not fit it",
                       image_section_name(s->type));
        }
    }
}

static int by_offset(const void *a, const void *b)
{
    const struct lm_image_section *x = a, *y = b;
    if (x->offset != y->offset) {
        return x->offset < y->offset ? -1 : 1;
    }
    return (x->bytes > y->bytes) - (x->bytes < y->bytes);
}

static void check_gap(struct verify *v, uint64_t from, uint64_t to)
{
    for (uint64_t i = from; i < to; i++) {
        if (v->image->bytes[i] != 0) {
            image_find(v->findings, i, "a byte between the sections is not zero");
        }
    }
}

static void check_layout(struct verify *v)
{
    const struct lm_image_header *h = &v->image->header;
    struct lm_image_section sorted[LM_IMAGE_SECTIONS_MAX];
    memcpy(sorted, h->sections, sizeof sorted);
    qsort(sorted, h->section_count, sizeof sorted[0], by_offset);
    uint64_t end = sizeof *h;
    for (uint32_t i = 0; i < h->section_count; i++) {
        if (sorted[i].offset < end) {
            image_find(v->findings, sorted[i].offset, "section %s begins inside the one before it",
                       image_section_name(sorted[i].type));
        }
        check_gap(v, end, sorted[i].offset);
        const uint64_t section_end = sorted[i].offset + sorted[i].bytes;
        end = section_end > end ? section_end : end;
    }
    check_gap(v, end, v->image->size_bytes);
}

/* ---- classes and bands ---- */

static void check_class(struct verify *v, int number)
{
    const struct lm_class *c = &v->image->db.classes.entry[number];
    const uint64_t at = v->image->sections[LM_IMAGE_CLASSES]->offset + (uint64_t)number * sizeof *c;
    if (class_is_unused(c)) {
        return;
    }
    bool has_remains = false;
    has_remains |= (c->reserved1[0] | c->reserved1[1]) != 0 || c->flags > LM_CLASS_NATURAL;
    for (size_t i = strnlen(c->name, sizeof c->name); i < sizeof c->name; i++) {
        has_remains |= c->name[i] != 0;
    }
    if (c->kind > LM_KIND_TREES || c->name[0] == '\0' || c->looks == 0 || c->facing > LM_FACINGS ||
        has_remains) {
        image_find(v->findings, at,
                   "class %d: its kind, name, looks, facing or unused bytes are wrong", number);
    }
}

static void check_classes(struct verify *v)
{
    const struct lm_classes *c = &v->image->db.classes;
    for (int i = 0; i < LM_DB_CLASSES; i++) {
        check_class(v, i);
    }
    bool is_rising = c->height_dm[0] == 0;
    for (int i = 1; i < 16; i++) {
        is_rising = is_rising && c->height_dm[i] >= c->height_dm[i - 1];
    }
    if (!is_rising) {
        image_find(v->findings,
                   v->image->sections[LM_IMAGE_CLASSES]->offset +
                       offsetof(struct lm_classes, height_dm),
                   "the heights do not rise from 0");
    }
}

static bool bands_overlap(const struct image *image, const struct lm_band *a,
                          const struct lm_band *b)
{
    if (a->lod != b->lod || a->row0 >= b->row0 + b->rows || b->row0 >= a->row0 + a->rows) {
        return false;
    }
    const uint32_t mask =
        image_columns_round((uint8_t)(image->header.shift0 + a->lod), a->zone) - 1;
    return ((b->column0 - a->column0) & mask) < a->columns ||
           ((a->column0 - b->column0) & mask) < b->columns;
}

/* Bands must share neither tiles nor entries; then, their entries adding up, each entry is one
 * tile's. */
static int check_bands(struct verify *v)
{
    const struct image *image = v->image;
    uint64_t entries = 0;
    int result = 0;
    for (uint32_t i = 0; i < image->header.band_count; i++) {
        const struct lm_band *a = &image->db.bands[i];
        const uint64_t at = image->sections[LM_IMAGE_BANDS]->offset + i * sizeof *a;
        entries += (uint64_t)a->rows * a->columns;
        for (uint32_t k = 0; k < i; k++) {
            const struct lm_band *b = &image->db.bands[k];
            const bool share_entries = a->entry0 < b->entry0 + (uint64_t)b->rows * b->columns &&
                                       b->entry0 < a->entry0 + (uint64_t)a->rows * a->columns;
            if (bands_overlap(image, a, b) || share_entries) {
                image_find(v->findings, at, "band %" PRIu32 " overlaps band %" PRIu32, i, k);
                result = -1;
            }
        }
    }
    if (entries != image->header.entry_count) {
        image_find(v->findings, image->sections[LM_IMAGE_BANDS]->offset,
                   "the bands have %" PRIu64 " entries, the directory %" PRIu32, entries,
                   image->header.entry_count);
    }
    return result;
}

/* ---- directory ---- */

/* What one entry says, apart from the record. Returns whether it has one that can be read. */
static bool check_entry(struct verify *v, uint32_t number)
{
    const struct image *image = v->image;
    const struct lm_tile_entry *e = &image->entries[number];
    const uint64_t at = lm_db_entry_offset(&image->db, number);
    if (image_entry_crc(number, e) != e->crc) {
        image_find(v->findings, at, "entry %" PRIu32 ": its checksum does not fit it", number);
        return false;
    }
    if (e->place == LM_TILE_ABSENT) {
        if (e->size || e->encoding || e->detail_size || e->detail_place != LM_TILE_ABSENT) {
            image_find(v->findings, at, "entry %" PRIu32 ": has no tile, but a size or detail",
                       number);
        }
        return false;
    }
    if (e->encoding != LM_TILE_RAW && e->encoding != LM_TILE_LZ4) {
        image_find(v->findings, at, "entry %" PRIu32 ": encoding %u is not known here", number,
                   e->encoding);
        return false;
    }
    if (lm_db_entry_check(&image->db, number, e) != LM_OK) {
        image_find(v->findings, at,
                   "entry %" PRIu32 ": %u units from %" PRIu32
                   " are no record inside TILES, or its detail lies outside DETAIL",
                   number, e->size, e->place);
        return false;
    }
    return true;
}

/* Records must share no byte, and leave none of TILES to nobody. */
static void check_places(struct verify *v)
{
    const struct image *image = v->image;
    const uint64_t tiles_at = image->db.records_offset;
    uint32_t end = 0;
    for (uint32_t i = 0; i < v->entry_count; i++) {
        const struct lm_tile_entry *e = &image->entries[v->entries[i]];
        if (e->place < end) {
            image_find(v->findings, lm_db_entry_offset(&image->db, v->entries[i]),
                       "entry %" PRIu32 " points into the record of entry %" PRIu32, v->entries[i],
                       v->entries[i - 1]);
        } else if (e->place > end) {
            image_find(v->findings, tiles_at + (uint64_t)end * LM_DB_PLACE_BYTES,
                       "no directory entry points to these bytes");
        }
        end = e->place + e->size > end ? e->place + e->size : end;
    }
    if (end != image->db.tiles_size) {
        image_find(v->findings, tiles_at + (uint64_t)end * LM_DB_PLACE_BYTES,
                   "no directory entry points to these bytes");
    }
    if (v->entry_count != image->header.record_count) {
        image_find(v->findings, offsetof(struct lm_image_header, record_count),
                   "the header says %" PRIu32 " records, the directory has %" PRIu32,
                   image->header.record_count, v->entry_count);
    }
}

static void check_directory(struct verify *v)
{
    for (uint32_t i = 0; i < v->image->header.entry_count; i++) {
        v->counts->entries++;
        if (check_entry(v, i)) {
            v->entries[v->entry_count++] = i;
        }
    }
    image_sort_by_place(v->image, v->entries, v->entry_count);
    check_places(v);
}

/* ---- parts ---- */

void verify_part_begin(struct verify_part *part, const struct verify *v, struct verify *worker)
{
    *part = (struct verify_part){0};
    part->findings = (struct image_findings){NULL, 0, v->findings->shown_max, false, &part->kept};
    worker->findings = &part->findings;
    worker->counts = &part->counts;
}

void verify_part_tell(const struct verify *v, struct verify_part *part)
{
    image_findings_tell(v->findings, &part->findings);
    v->counts->tiles += part->counts.tiles;
    v->counts->edges += part->counts.edges;
    v->counts->children += part->counts.children;
}

/* ---- tiles ---- */

/* What a thread takes at a time, and how many it keeps: neighbours are mostly unpacked once. */
enum { PART_TILES = 256, WORKER_TILES = 512 };

/* A worker and its view of the image, which has tiles of its own. */
struct worker {
    struct verify verify;
    struct image image;
};

struct tiles_work {
    struct verify *v;
    struct verify_part *parts; /* owned */
    struct hs_progress progress;
};

static void *begin_tiles(void *ctx)
{
    const struct verify *v = ((struct tiles_work *)ctx)->v;
    struct worker *w = malloc(sizeof *w);
    if (!w) {
        return NULL;
    }
    *w = (struct worker){*v, *v->image};
    w->verify.image = &w->image;
    if (w->image.unpacked) {
        w->image.unpacked = image_unpacked_new(w->image.header.entry_count, WORKER_TILES);
        if (!w->image.unpacked) {
            free(w);
            return NULL;
        }
    }
    return w;
}

static void check_some_tiles(void *ctx, void *own, uint32_t part)
{
    struct tiles_work *work = ctx;
    struct verify *worker = &((struct worker *)own)->verify;
    const uint32_t from = part * PART_TILES, left = worker->entry_count - from;
    verify_part_begin(&work->parts[part], work->v, worker);
    for (uint32_t i = 0; i < PART_TILES && i < left; i++) {
        verify_tile(worker, worker->entries[from + i]);
    }
}

static void end_tiles(void *ctx, void *own)
{
    (void)ctx;
    image_unpacked_free(((struct worker *)own)->image.unpacked);
    free(own);
}

static void tell_some_tiles(void *ctx, uint32_t part)
{
    struct tiles_work *work = ctx;
    verify_part_tell(work->v, &work->parts[part]);
    hs_progress_update(&work->progress, work->v->counts->tiles);
}

static int check_tiles(struct verify *v, uint32_t threads)
{
    const uint32_t parts = (v->entry_count + PART_TILES - 1) / PART_TILES;
    struct tiles_work work = {.v = v, .parts = calloc((size_t)parts + 1, sizeof *work.parts)};
    const struct hs_team team = {&work, begin_tiles, check_some_tiles, end_tiles, tell_some_tiles};
    if (!work.parts) {
        return -1;
    }
    hs_progress_begin(&work.progress, "verifying", v->entry_count);
    const int result = hs_team_run(&team, parts, threads);
    hs_progress_end(&work.progress);
    for (uint32_t i = 0; i < parts && result != 0; i++) {
        image_findings_drop(&work.parts[i].findings);
    }
    free(work.parts);
    return result;
}

static int check_entries(struct verify *v, uint32_t threads)
{
    const size_t entries = (size_t)v->image->header.entry_count + 1;
    v->entries = malloc(entries * sizeof *v->entries);
    v->sound = calloc(entries, sizeof *v->sound);
    if (!v->entries || !v->sound) {
        image_find(v->findings, v->image->db.directory_offset,
                   "not enough memory to check the directory");
        return -1;
    }
    check_directory(v);
    if (check_tiles(v, threads) != 0) {
        image_find(v->findings, v->image->db.records_offset,
                   "not enough memory to check the tiles");
        return -1;
    }
    verify_levels(v, threads);
    return 0;
}

int image_verify_with(struct image *image, struct image_findings *findings,
                      struct image_verify_counts *counts, uint32_t threads)
{
    struct verify v = {.image = image, .findings = findings, .counts = counts};
    *counts = (struct image_verify_counts){0};
    if (image_read_tables(image, findings) != 0) {
        return -1;
    }
    check_section_crcs(&v);
    check_layout(&v);
    check_classes(&v);
    image_targets_check(image, findings);
    image_signatures_check(image, findings);
    const int result = check_bands(&v) == 0 ? check_entries(&v, threads) : -1;
    free(v.entries);
    free(v.sound);
    return result;
}

int image_verify(struct image *image, struct image_findings *findings,
                 struct image_verify_counts *counts)
{
    return image_verify_with(image, findings, counts, hs_team_threads());
}
