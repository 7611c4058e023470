#include "image/verify.h"

#include "fx/crc32c.h"
#include "hs/progress.h"
#include "hs/zero_bytes.h"
#include "image/border.h"
#include "image/codes.h"
#include "image/grid.h"
#include "image/ground.h"
#include "image/signatures.h"
#include "image/targets.h"
#include "lm/detail.h"

#include <inttypes.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

struct verify {
    struct image *image;
    struct image_findings *findings;
    struct image_verify_counts *counts;
    uint32_t *entries;    /* those that have a record, by its place */
    uint32_t entry_count; /* of them */
    struct rung *spare;   /* owned: a list of those that are used again */
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

/* The detail of a tile, apart from where it lies. */
static void check_detail(struct verify *v, uint32_t number, const struct lm_tile *tile)
{
    const struct image *image = v->image;
    const struct lm_tile_entry *e = &image->entries[number];
    const uint64_t at = image->db.detail_offset + (uint64_t)e->detail_place * LM_DB_PLACE_BYTES;
    const struct lm_detail *detail = (const void *)(image->bytes + at);
    if (e->detail_size == 0) {
        return;
    }
    if (tile->lod != 0 || lm_detail_check(detail, e->detail_size * (uint32_t)LM_DB_PLACE_BYTES, 0,
                                          tile->row, tile->column) != LM_OK) {
        image_find(v->findings, at, "entry %" PRIu32 ": the detail of its tile is not sound",
                   number);
        return;
    }
    for (uint32_t i = 0; i < detail->count; i++) {
        const struct lm_detail_item *item = &detail->items[i];
        const uint8_t kind = image->db.classes.entry[item->class_number].kind;
        const bool is_surface = item->kind == LM_DETAIL_SURFACE;
        if (item->kind != LM_DETAIL_LINE && is_surface == (kind == LM_KIND_STRUCTURE)) {
            image_find(v->findings, at,
                       "entry %" PRIu32 ": item %" PRIu32
                       " of its detail has a class that is %s structure",
                       number, i, is_surface ? "a" : "no");
        }
    }
}

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

/* ---- tiles ---- */

static bool posts_are_in_bounds(const struct lm_tile *t)
{
    uint16_t highest = 0;
    for (int i = 0; i < LM_TILE_POINTS * LM_TILE_POINTS; i++) {
        const uint16_t p = t->points[i / LM_TILE_POINTS][i % LM_TILE_POINTS].post;
        highest = p > highest ? p : highest;
    }
    return t->base_m_q6 + ((int64_t)highest << t->post_shift) <= IMAGE_ELEVATION_LIMIT_Q6;
}

static bool is_bad_cell(const struct image *image, uint16_t cell)
{
    const uint8_t k = image_cell_class(cell);
    return k == LM_DB_CLASS_NONE ? cell != IMAGE_CELL_NONE : is_unused(&image->db.classes.entry[k]);
}

/* Zero, or a sound cell without a height. */
static bool under_is_bad(const struct image *image, uint16_t under)
{
    return under != 0 && (image_cell_height(under) != 0 || is_bad_cell(image, under));
}

static int count_bad_cells(const struct image *image, const struct lm_tile *t)
{
    int bad = 0;
    for (int i = 0; i < LM_TILE_CELLS * LM_TILE_CELLS; i++) {
        bad += is_bad_cell(image, image_tile_cell(t, i / LM_TILE_CELLS, i % LM_TILE_CELLS));
    }
    return bad;
}

static bool tile_reserved_is_zero(const struct lm_tile *t)
{
    uint32_t any = t->reserved0 | (uint32_t)t->reserved1 | t->block_bytes;
    for (size_t i = 0; i < sizeof t->reserved2; i++) {
        any |= t->reserved2[i];
    }
    for (size_t i = 0; i < sizeof t->reserved3; i++) {
        any |= t->reserved3[i];
    }
    return any == 0;
}

/* A compressed record is its head, zeros, and the block; it has no unit that only zeros fill. */
static void check_stored(struct verify *v, uint32_t number)
{
    const struct image *image = v->image;
    const struct lm_tile_entry *e = &image->entries[number];
    const uint64_t at = image_record_offset(image, number);
    const uint32_t head_bytes = offsetof(struct lm_tile, points);
    const uint32_t bytes = e->size * (uint32_t)LM_DB_PLACE_BYTES - head_bytes;
    struct lm_tile head;
    if (e->encoding == LM_TILE_RAW) {
        return;
    }
    memcpy(&head, image->bytes + at, head_bytes);
    if (head.block_bytes > bytes || bytes - head.block_bytes >= LM_DB_PLACE_BYTES) {
        image_find(v->findings, at,
                   "tile of entry %" PRIu32
                   ": its block has not the length of "
                   "its record",
                   number);
    } else if (!db_is_zero(image->bytes + at + head_bytes, bytes - head.block_bytes)) {
        image_find(v->findings, at, "tile of entry %" PRIu32 ": unused bytes are not zero", number);
    }
}

/* What the record says of itself. Returns whether its identity can be used further on. */
static bool check_tile(struct verify *v, uint32_t number, const struct lm_tile *t)
{
    const struct image *image = v->image;
    const uint64_t at = image_record_offset(image, number);
    const uint64_t before = v->findings->count;
    if (fx_crc32c(0, &t->lod, LM_TILE_BYTES - sizeof t->crc) != t->crc) {
        image_find(v->findings, at, "tile of entry %" PRIu32 ": its checksum does not fit it",
                   number);
    }
    if (!tile_reserved_is_zero(t)) {
        image_find(v->findings, at, "tile of entry %" PRIu32 ": unused bytes are not zero", number);
    }
    if (t->base_m_q6 < -IMAGE_ELEVATION_LIMIT_Q6 || t->base_m_q6 > IMAGE_ELEVATION_LIMIT_Q6 ||
        t->post_shift > LM_TILE_POST_SHIFT_MAX || !posts_are_in_bounds(t)) {
        image_find(v->findings, at, "tile of entry %" PRIu32 ": elevations out of range", number);
    }
    const int bad_cells = count_bad_cells(image, t);
    if (bad_cells > 0) {
        image_find(v->findings, at,
                   "tile of entry %" PRIu32 ": %d cells of a class that is not described", number,
                   bad_cells);
    }
    if (under_is_bad(image, t->under)) {
        image_find(v->findings, at,
                   "tile of entry %" PRIu32
                   ": the cell under its structures has a height or no class",
                   number);
    }
    const int64_t entry = lm_db_entry(&image->db, t->lod, t->row, t->column);
    const struct lm_band *band = entry >= 0 ? image_band(image, t->lod, t->row) : NULL;
    if (entry < 0 || (uint32_t)entry != number || band->zone != t->zone) {
        image_find(v->findings, at,
                   "tile of entry %" PRIu32 ": says it is level %u zone %u row %" PRIu32
                   " column %" PRIu32 ", which is not what the directory takes it for",
                   number, t->lod, t->zone, t->row, t->column);
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
    const struct lm_tile *t = image_find_tile(image, level, row, column);
    return t && t->post_shift <= LM_TILE_POST_SHIFT_MAX ? t : NULL;
}

static void report_edge(struct verify *v, uint32_t number, const char *side, int bad)
{
    if (bad > 0) {
        image_find(v->findings, image_record_offset(v->image, number),
                   "tile of entry %" PRIu32 ": %d posts of its %s edge differ from the neighbour's",
                   number, bad, side);
    }
}

static void check_east_edge(struct verify *v, uint32_t number, const struct lm_tile *t)
{
    const uint8_t shift = (uint8_t)(v->image->header.shift0 + t->lod);
    const uint32_t mask = image_columns_round(shift, t->zone) - 1;
    const struct lm_tile *east = find_tile(v->image, t->lod, t->row, (t->column + 1) & mask);
    int bad = 0;
    for (int r = 0; east && r < LM_TILE_POSTS; r++) {
        bad += !posts_agree(t, r, LM_TILE_CELLS, east, r, 0);
    }
    v->counts->edges += east != NULL;
    report_edge(v, number, "east", bad);
}

/* The row north of a tile may be in another zone, with tiles twice as wide or half as wide. */
static void check_north_edge(struct verify *v, uint32_t number, const struct lm_tile *t)
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
    report_edge(v, number, "north", bad);
}

/* ---- borders ---- */

static const struct lm_tile *find_neighbour(void *ctx, uint8_t level, uint32_t row, uint32_t column)
{
    return find_tile(ctx, level, row, column);
}

/* Does a border post to the south or west hold the neighbour's, as far as codes go? */
static bool border_post_fits(const struct image_neighbours *n, const struct lm_tile *t, int row,
                             int column)
{
    const struct image_border_post wanted = image_border_post(n, t, row, column);
    const uint16_t code = t->points[row][column].post;
    const int64_t step = (int64_t)1 << t->post_shift;
    const int64_t difference =
        image_post_q6(t, row - LM_TILE_BORDER, column - LM_TILE_BORDER) - wanted.q6;
    return !wanted.is_neighbours || (difference >= -2 * step && difference <= 2 * step) ||
           (code == 0 && difference > 0) || (code == UINT16_MAX && difference < 0);
}

static void check_border(struct verify *v, uint32_t number, const struct lm_tile *t)
{
    enum { LAST = LM_TILE_POINTS - 1 };
    const struct image_neighbours n = {find_neighbour, v->image, v->image->header.shift0};
    int cells = 0, posts = 0;
    for (int i = 0; i < LM_TILE_POINTS; i++) {
        const int points[4][2] = {{0, i}, {LAST, i}, {i, 0}, {i, LAST}};
        for (int side = 0; side < 4; side++) {
            const int r = points[side][0], c = points[side][1];
            cells += t->points[r][c].cell != image_border_cell(&n, t, r, c);
            posts += (r == 0 || c == 0) && !border_post_fits(&n, t, r, c);
        }
    }
    if (cells + posts > 0) {
        image_find(v->findings, image_record_offset(v->image, number),
                   "tile of entry %" PRIu32
                   ": %d cells and %d posts of its border are not the "
                   "neighbours'",
                   number, cells, posts);
    }
}

/* ---- levels ---- */

/* A tile of the pyramid, as it is made from those below it. */
struct rung {
    struct rung *next;   /* of the spare ones */
    struct lm_tile tile; /* a copy: the reader keeps only so many */
    uint32_t number;     /* of its entry */
    struct image_ground ground;
    int32_t posts_q6[LM_TILE_POSTS][LM_TILE_POSTS]; /* as they should be */
};

/* Do the posts of a quarter fit those below it? */
static bool posts_fit(const struct rung *made, const struct lm_tile *below, int quarter)
{
    enum { HALF = LM_TILE_CELLS / 2 };
    const int row = quarter / 2 * HALF, column = quarter % 2 * HALF;
    const int64_t step = coarser_step(&made->tile, below);
    for (int r = 0; r <= HALF; r++) {
        for (int c = 0; c <= HALF; c++) {
            const int64_t difference = image_post_q6(&made->tile, row + r, column + c) -
                                       made->posts_q6[row + r][column + c];
            if (difference < -step || difference > step) {
                return false;
            }
        }
    }
    return true;
}

/* Posts of a tile made again from those below it: every second one, smoothed. */
static void make_posts(struct rung *made, struct rung *const below[4])
{
    enum { HALF = LM_TILE_CELLS / 2 };
    int32_t fine[4][LM_TILE_POSTS][LM_TILE_POSTS];
    const int32_t(*posts[4])[LM_TILE_POSTS] = {NULL, NULL, NULL, NULL};
    image_posts_decode(&made->tile, made->posts_q6);
    for (int i = 0; i < 4; i++) {
        if (!below[i]) {
            continue;
        }
        image_posts_decode(&below[i]->tile, fine[i]);
        posts[i] = (const int32_t(*)[LM_TILE_POSTS])fine[i];
        for (int k = 0; k < (HALF + 1) * (HALF + 1); k++) {
            const int r = k / (HALF + 1), c = k % (HALF + 1);
            made->posts_q6[i / 2 * HALF + r][i % 2 * HALF + c] = fine[i][2 * r][2 * c];
        }
    }
    image_posts_smooth(posts, made->posts_q6);
}

static bool cells_fit(const struct rung *made, const struct lm_tile *encoded, int quarter)
{
    enum { HALF = LM_TILE_CELLS / 2 };
    const int row = quarter / 2 * HALF, column = quarter % 2 * HALF;
    for (int i = 0; i < HALF * HALF; i++) {
        const int r = row + i / HALF, c = column + i % HALF;
        if (image_tile_cell(&made->tile, r, c) != image_tile_cell(encoded, r, c)) {
            return false;
        }
    }
    return true;
}

/* They are large: the system would take and give their memory for each tile. */
static struct rung *rung_new(struct verify *v)
{
    struct rung *made = v->spare;
    if (!made) {
        return malloc(sizeof *made);
    }
    v->spare = made->next;
    return made;
}

/* `made` may be NULL. */
static void rung_put_back(struct verify *v, struct rung *made)
{
    if (made) {
        made->next = v->spare;
        v->spare = made;
    }
}

static void free_spare(struct verify *v)
{
    while (v->spare) {
        struct rung *next = v->spare->next;
        free(v->spare);
        v->spare = next;
    }
}

static int climb(struct verify *v, int level, uint32_t row, uint32_t column, struct rung **out);

/* Make a tile again from the four below it, and compare. */
static int check_below(struct verify *v, struct rung *made, struct rung *const below[4])
{
    const struct lm_classes *classes = &v->image->db.classes;
    struct lm_tile *encoded = malloc(sizeof *encoded);
    if (!encoded) {
        return -1;
    }
    *encoded = made->tile;
    for (int i = 0; i < 4; i++) {
        if (below[i]) {
            image_ground_take(&made->ground, &made->tile, &below[i]->ground, i, classes);
        }
    }
    image_ground_encode(&made->ground, encoded, classes->height_dm);
    make_posts(made, below);
    for (int i = 0; i < 4; i++) {
        if (!below[i]) {
            continue;
        }
        v->counts->children++;
        if (!posts_fit(made, &below[i]->tile, i) || !cells_fit(made, encoded, i)) {
            image_find(v->findings, image_record_offset(v->image, below[i]->number),
                       "tile of entry %" PRIu32 ": the tile above it does not hold its mean",
                       below[i]->number);
        }
    }
    free(encoded);
    return 0;
}

static int climb_to(struct verify *v, struct rung *made)
{
    const struct lm_tile *t = &made->tile;
    struct rung *below[4] = {NULL, NULL, NULL, NULL};
    int result = 0;
    image_cells_decode(t, made->ground.cells);
    image_ground_init(&made->ground, t);
    for (int i = 0; i < 4 && result == 0 && t->lod > 0; i++) {
        result = climb(v, t->lod - 1, 2 * t->row + (uint32_t)(i / 2),
                       2 * t->column + (uint32_t)(i % 2), &below[i]);
    }
    if (result == 0) {
        result = check_below(v, made, below);
    }
    for (int i = 0; i < 4; i++) {
        rung_put_back(v, below[i]);
    }
    return result;
}

/* Check a tile and all below it. *out is the caller's to put back, NULL without a sound tile.
 * Returns 0, or -1 without memory. */
static int climb(struct verify *v, int level, uint32_t row, uint32_t column, struct rung **out)
{
    const struct lm_tile *t = find_tile(v->image, (uint8_t)level, row, column);
    *out = NULL;
    if (!t || lm_tile_check(t, (uint8_t)level, row, column) != LM_OK) {
        return 0;
    }
    struct rung *made = rung_new(v);
    if (!made) {
        return -1;
    }
    made->tile = *t;
    made->number = (uint32_t)lm_db_entry(&v->image->db, (uint8_t)level, row, column);
    *out = made;
    return climb_to(v, made);
}

/* Tiles of the coarsest level, and with them all that have a parent. */
static void check_levels(struct verify *v)
{
    for (uint32_t i = 0; i < v->entry_count; i++) {
        const struct lm_tile *t = image_entry_tile(v->image, v->entries[i]);
        struct rung *top = NULL;
        const bool is_top = t->lod + 1 == v->image->header.lod_count;
        if (is_top && climb(v, t->lod, t->row, t->column, &top) != 0) {
            image_find(v->findings, image_record_offset(v->image, v->entries[i]),
                       "not enough memory to check the levels below it");
        }
        rung_put_back(v, top);
    }
    free_spare(v);
}

static void check_parent(struct verify *v, uint32_t number, const struct lm_tile *t)
{
    if (t->lod + 1 < v->image->header.lod_count &&
        !find_tile(v->image, (uint8_t)(t->lod + 1), t->row >> 1, t->column >> 1)) {
        image_find(v->findings, image_record_offset(v->image, number),
                   "tile of entry %" PRIu32 ": there is no tile above it", number);
    }
}

static void check_tiles(struct verify *v)
{
    struct hs_progress progress;
    hs_progress_begin(&progress, "verifying", v->entry_count);
    for (uint32_t i = 0; i < v->entry_count; i++) {
        const uint32_t number = v->entries[i];
        const struct lm_tile *t = image_entry_tile(v->image, number);
        v->counts->tiles++;
        check_stored(v, number);
        if (check_tile(v, number, t)) {
            check_east_edge(v, number, t);
            check_north_edge(v, number, t);
            check_border(v, number, t);
            check_parent(v, number, t);
            check_detail(v, number, t);
        }
        hs_progress_update(&progress, i + 1);
    }
    hs_progress_end(&progress);
}

int image_verify(struct image *image, struct image_findings *findings,
                 struct image_verify_counts *counts)
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
    if (check_bands(&v) != 0) {
        return -1;
    }
    v.entries = malloc(((size_t)image->header.entry_count + 1) * sizeof *v.entries);
    if (!v.entries) {
        image_find(findings, image->db.directory_offset,
                   "not enough memory to check the directory");
        return -1;
    }
    check_directory(&v);
    check_tiles(&v);
    check_levels(&v);
    free(v.entries);
    return 0;
}
