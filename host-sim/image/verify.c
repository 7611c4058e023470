#include "image/verify.h"

#include "fx/crc32c.h"
#include "hs/progress.h"
#include "image/codes.h"
#include "image/grid.h"
#include "image/signatures.h"
#include "image/targets.h"

#include <inttypes.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

struct verify {
    struct image *image;
    struct image_findings *findings;
    struct image_verify_counts *counts;
    uint32_t *entry_of; /* of each record; UINT32_MAX while none is known */
};

/* ---- sections ---- */

static void check_section_crcs(struct verify *v)
{
    const struct lm_image_header *h = &v->image->header;
    for (uint32_t i = 0; i < h->section_count; i++) {
        const struct lm_image_section *s = &h->sections[i];
        if (fx_crc32c(0, v->image->bytes + s->offset, s->bytes) != s->crc) {
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

static bool is_unused(const struct lm_class *c)
{
    static const struct lm_class zero;
    return memcmp(c, &zero, sizeof zero) == 0;
}

static void check_class(struct verify *v, int number)
{
    const struct lm_class *c = &v->image->db.classes.entry[number];
    const uint64_t at = v->image->sections[LM_IMAGE_CLASSES]->offset + (uint64_t)number * sizeof *c;
    if (is_unused(c)) {
        return;
    }
    bool has_remains = false;
    for (size_t i = 0; i < sizeof c->reserved; i++) {
        has_remains |= c->reserved[i] != 0;
    }
    for (size_t i = strnlen(c->name, sizeof c->name); i < sizeof c->name; i++) {
        has_remains |= c->name[i] != 0;
    }
    if (c->kind > LM_KIND_TREES || c->name[0] == '\0' || c->looks == 0 || has_remains) {
        image_find(v->findings, at, "class %d: its kind, name, looks or unused bytes are wrong",
                   number);
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

static void check_directory(struct verify *v)
{
    const struct image *image = v->image;
    const uint64_t at = image->db.directory_offset;
    for (uint32_t i = 0; i < image->header.entry_count; i++) {
        const struct image_entry e = image->entries[i];
        const uint64_t offset = at + (uint64_t)i * sizeof e;
        v->counts->entries++;
        if (image_entry_crc(i, e.record) != e.crc) {
            image_find(v->findings, offset, "entry %" PRIu32 ": its checksum does not fit it", i);
        } else if (e.record != UINT32_MAX && e.record >= image->header.record_count) {
            image_find(v->findings, offset,
                       "entry %" PRIu32 " points to record %" PRIu32 " of %" PRIu32, i, e.record,
                       image->header.record_count);
        } else if (e.record != UINT32_MAX && v->entry_of[e.record] != UINT32_MAX) {
            image_find(v->findings, offset,
                       "entry %" PRIu32 " points to the record of entry %" PRIu32, i,
                       v->entry_of[e.record]);
        } else if (e.record != UINT32_MAX) {
            v->entry_of[e.record] = i;
        }
    }
}

/* ---- tiles ---- */

static bool posts_are_in_bounds(const struct lm_tile *t)
{
    uint16_t highest = 0;
    for (int i = 0; i < LM_TILE_POSTS * LM_TILE_POSTS; i++) {
        const uint16_t p = t->points[i / LM_TILE_POSTS][i % LM_TILE_POSTS].post;
        highest = p > highest ? p : highest;
    }
    return t->base_m_q6 + ((int64_t)highest << t->post_shift) <= IMAGE_ELEVATION_LIMIT_Q6;
}

static int count_bad_cells(const struct image *image, const struct lm_tile *t)
{
    int bad = 0;
    for (int i = 0; i < LM_TILE_CELLS * LM_TILE_CELLS; i++) {
        const uint16_t cell = t->points[i / LM_TILE_CELLS][i % LM_TILE_CELLS].cell;
        const uint8_t k = image_cell_class(cell);
        bad += k == LM_DB_CLASS_NONE ? cell != IMAGE_CELL_NONE
                                     : is_unused(&image->db.classes.entry[k]);
    }
    return bad;
}

static bool tile_reserved_is_zero(const struct lm_tile *t)
{
    uint32_t any = t->reserved0;
    for (int i = 0; i < LM_TILE_POSTS; i++) {
        any |= (uint32_t)t->points[i][LM_TILE_CELLS].cell | t->points[LM_TILE_CELLS][i].cell;
    }
    for (size_t i = 0; i < sizeof t->reserved1; i++) {
        any |= t->reserved1[i];
    }
    for (size_t i = 0; i < sizeof t->reserved2; i++) {
        any |= t->reserved2[i];
    }
    return any == 0;
}

/* What the record says of itself. Returns whether its identity can be used further on. */
static bool check_tile(struct verify *v, uint32_t record, const struct lm_tile *t)
{
    const struct image *image = v->image;
    const uint64_t at = image_record_offset(image, record);
    const uint64_t before = v->findings->count;
    if (fx_crc32c(0, &t->lod, LM_TILE_BYTES - sizeof t->crc) != t->crc) {
        image_find(v->findings, at, "record %" PRIu32 ": its checksum does not fit it", record);
    }
    if (!tile_reserved_is_zero(t)) {
        image_find(v->findings, at, "record %" PRIu32 ": unused bytes are not zero", record);
    }
    if (t->base_m_q6 < -IMAGE_ELEVATION_LIMIT_Q6 || t->base_m_q6 > IMAGE_ELEVATION_LIMIT_Q6 ||
        t->post_shift > LM_TILE_POST_SHIFT_MAX || !posts_are_in_bounds(t)) {
        image_find(v->findings, at, "record %" PRIu32 ": elevations out of range", record);
    }
    const int bad_cells = count_bad_cells(image, t);
    if (bad_cells > 0) {
        image_find(v->findings, at, "record %" PRIu32 ": %d cells of a class that is not described",
                   record, bad_cells);
    }
    const int64_t entry = lm_db_entry(&image->db, t->lod, t->row, t->column);
    const struct lm_band *band = entry >= 0 ? image_band(image, t->lod, t->row) : NULL;
    if (entry < 0 || (uint32_t)entry != v->entry_of[record] || band->zone != t->zone) {
        image_find(v->findings, at,
                   "record %" PRIu32 ": says it is level %u zone %u row %" PRIu32 " column %" PRIu32
                   ", which is not what the directory takes it for",
                   record, t->lod, t->zone, t->row, t->column);
        return false;
    }
    return v->findings->count == before;
}

/* Metres x 64 that two readings of one post may differ by: each was cut to its own tile's steps. */
static int64_t coarser_step(const struct lm_tile *a, const struct lm_tile *b)
{
    return (int64_t)1 << (a->post_shift > b->post_shift ? a->post_shift : b->post_shift);
}

static bool posts_agree(const struct lm_tile *a, int ra, int ca, const struct lm_tile *b, int rb,
                        int cb)
{
    const int64_t difference = image_post_q6(a, ra, ca) - image_post_q6(b, rb, cb);
    const int64_t step = coarser_step(a, b);
    return difference >= -step && difference <= step;
}

static const struct lm_tile *find_tile(const struct image *image, uint8_t level, uint32_t row,
                                       uint32_t column)
{
    const uint32_t record = image_record(image, level, row, column);
    const struct lm_tile *t = record == UINT32_MAX ? NULL : &image->tiles[record];
    return t && t->post_shift <= LM_TILE_POST_SHIFT_MAX ? t : NULL;
}

static void report_edge(struct verify *v, uint32_t record, const char *side, int bad)
{
    if (bad > 0) {
        image_find(v->findings, image_record_offset(v->image, record),
                   "record %" PRIu32 ": %d posts of its %s edge differ from the neighbour's",
                   record, bad, side);
    }
}

static void check_east_edge(struct verify *v, uint32_t record, const struct lm_tile *t)
{
    const uint8_t shift = (uint8_t)(v->image->header.shift0 + t->lod);
    const uint32_t mask = image_columns_round(shift, t->zone) - 1;
    const struct lm_tile *east = find_tile(v->image, t->lod, t->row, (t->column + 1) & mask);
    int bad = 0;
    for (int r = 0; east && r < LM_TILE_POSTS; r++) {
        bad += !posts_agree(t, r, LM_TILE_CELLS, east, r, 0);
    }
    v->counts->edges += east != NULL;
    report_edge(v, record, "east", bad);
}

/* The row north of a tile may be in another zone, with tiles twice as wide or half as wide. */
static void check_north_edge(struct verify *v, uint32_t record, const struct lm_tile *t)
{
    const struct image *image = v->image;
    const struct lm_band *band = image_band(image, t->lod, t->row + 1);
    if (!band) {
        return;
    }
    const uint8_t shift = (uint8_t)(image->header.shift0 + t->lod);
    const int cell_shift = shift + band->zone;
    const struct lm_tile *north = NULL;
    uint32_t north_column = UINT32_MAX;
    int bad = 0;
    for (int c = 0; c < LM_TILE_POSTS; c++) {
        const uint64_t post = (uint64_t)t->column * LM_TILE_CELLS + (uint64_t)c;
        const uint32_t longitude = (uint32_t)(post << (shift + t->zone));
        if (longitude & ((1u << cell_shift) - 1)) {
            continue; /* The wider cells have no post here. */
        }
        const uint32_t column = longitude >> (cell_shift + LM_TILE_CELLS_LOG2);
        if (column != north_column) {
            north_column = column;
            north = find_tile(image, t->lod, t->row + 1, column);
            v->counts->edges += north != NULL;
        }
        const int north_post = (int)(longitude >> cell_shift & (LM_TILE_CELLS - 1));
        bad += north && !posts_agree(t, LM_TILE_CELLS, c, north, 0, north_post);
    }
    report_edge(v, record, "north", bad);
}

/* ---- levels ---- */

/* Does the parent hold what its child reduces to? */
static bool child_fits(const struct image *image, const struct lm_tile *parent,
                       const struct lm_tile *child)
{
    enum { HALF = LM_TILE_CELLS / 2 };
    uint16_t cells[LM_TILE_CELLS][LM_TILE_CELLS], reduced[HALF][HALF],
        own[LM_TILE_CELLS][LM_TILE_CELLS];
    const int row = (int)(child->row & 1) * HALF, column = (int)(child->column & 1) * HALF;
    image_cells_decode(parent, own);
    image_cells_decode(child, cells);
    image_reduce(&cells[0][0], LM_TILE_CELLS, 2, &reduced[0][0], HALF, HALF,
                 image->db.classes.height_dm);
    for (int r = 0; r < HALF; r++) {
        if (memcmp(reduced[r], &own[row + r][column], sizeof reduced[r]) != 0) {
            return false;
        }
    }
    for (int r = 0; r <= HALF; r++) {
        for (int c = 0; c <= HALF; c++) {
            if (!posts_agree(parent, row + r, column + c, child, 2 * r, 2 * c)) {
                return false;
            }
        }
    }
    return true;
}

static void check_parent(struct verify *v, uint32_t record, const struct lm_tile *t)
{
    if (t->lod + 1 >= v->image->header.lod_count) {
        return;
    }
    const uint64_t at = image_record_offset(v->image, record);
    const struct lm_tile *parent =
        find_tile(v->image, (uint8_t)(t->lod + 1), t->row >> 1, t->column >> 1);
    if (!parent) {
        image_find(v->findings, at, "record %" PRIu32 ": there is no tile above it", record);
        return;
    }
    v->counts->children++;
    if (!child_fits(v->image, parent, t)) {
        image_find(v->findings, at, "record %" PRIu32 ": the tile above it does not hold its mean",
                   record);
    }
}

static void check_tiles(struct verify *v)
{
    const struct image *image = v->image;
    struct hs_progress progress;
    hs_progress_begin(&progress, "verifying", image->header.record_count);
    for (uint32_t i = 0; i < image->header.record_count; i++) {
        v->counts->tiles++;
        /* All were set before. NOLINTNEXTLINE(clang-analyzer-core.UndefinedBinaryOperatorResult) */
        if (v->entry_of[i] == UINT32_MAX) {
            image_find(v->findings, image_record_offset(image, i),
                       "record %" PRIu32 ": no directory entry points to it", i);
        } else if (check_tile(v, i, &image->tiles[i])) {
            check_east_edge(v, i, &image->tiles[i]);
            check_north_edge(v, i, &image->tiles[i]);
            check_parent(v, i, &image->tiles[i]);
        }
        hs_progress_update(&progress, i + 1);
    }
    hs_progress_end(&progress);
}

int image_verify(struct image *image, struct image_findings *findings,
                 struct image_verify_counts *counts)
{
    struct verify v = {image, findings, counts, NULL};
    *counts = (struct image_verify_counts){0};
    if (image_read_tables(image, findings) != 0) {
        return -1;
    }
    check_section_crcs(&v);
    check_layout(&v);
    check_classes(&v);
    image_targets_check(image, findings);
    image_signatures_check(image, findings);
    if (check_bands(&v) != 0) {
        return -1;
    }
    const size_t records = image->header.record_count;
    v.entry_of = malloc((records ? records : 1) * sizeof *v.entry_of);
    if (!v.entry_of) {
        image_find(findings, image->db.records_offset, "not enough memory to check the records");
        return -1;
    }
    memset(v.entry_of, 0xff, records * sizeof *v.entry_of);
    check_directory(&v);
    check_tiles(&v);
    free(v.entry_of);
    return 0;
}
