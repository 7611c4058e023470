#include "verify_parts.h"

#include "hs/crc32c.h"
#include "hs/zero_bytes.h"
#include "image/border.h"
#include "image/codes.h"
#include "image/grid.h"
#include "lm/detail.h"

#include <inttypes.h>
#include <stdbool.h>
#include <stddef.h>
#include <string.h>

/* ---- the record ---- */

static bool posts_are_in_bounds(const struct lm_tile *t)
{
    uint16_t highest = 0;
    for (int r = 0; r < LM_TILE_POINTS; r++) {
        for (int c = 0; c < LM_TILE_POINTS; c++) {
            const uint16_t p = t->points[r][c].post;
            highest = p > highest ? p : highest;
        }
    }
    return t->base_m_q6 + ((int64_t)highest << t->post_shift) <= IMAGE_ELEVATION_LIMIT_Q6;
}

/* Bit k: class k is described. */
static uint32_t described_classes(const struct image *image)
{
    uint32_t described = 0;
    for (int k = 0; k < LM_DB_CLASSES; k++) {
        const bool is_one = k != LM_DB_CLASS_NONE && !class_is_unused(&image->db.classes.entry[k]);
        described |= (uint32_t)is_one << k;
    }
    return described;
}

static bool is_bad_cell(uint32_t described, uint16_t cell)
{
    return !(described >> image_cell_class(cell) & 1) && cell != IMAGE_CELL_NONE;
}

/* Zero, or a sound cell without a height. */
static bool under_is_bad(const struct image *image, uint16_t under)
{
    return under != 0 &&
           (image_cell_height(under) != 0 || is_bad_cell(described_classes(image), under));
}

static int count_bad_cells(const struct image *image, const struct lm_tile *t)
{
    const uint32_t described = described_classes(image);
    int bad = 0;
    for (int r = 0; r < LM_TILE_CELLS; r++) {
        for (int c = 0; c < LM_TILE_CELLS; c++) {
            bad += is_bad_cell(described, image_tile_cell(t, r, c));
        }
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

/* What lm_tile_check asks of a head besides whose it is. */
static bool head_is_sound(const struct lm_tile *t)
{
    return t->post_shift <= LM_TILE_POST_SHIFT_MAX && t->base_m_q6 >= -IMAGE_ELEVATION_LIMIT_Q6 &&
           t->base_m_q6 <= IMAGE_ELEVATION_LIMIT_Q6 && image_cell_height(t->under) == 0;
}

/* What the record says of itself. Returns whether its identity can be used further on. */
static bool check_tile(struct verify *v, uint32_t number, const struct lm_tile *t)
{
    const struct image *image = v->image;
    const uint64_t at = image_record_offset(image, number);
    const uint64_t before = v->findings->count;
    const bool fits = hs_crc32c(0, &t->lod, LM_TILE_BYTES - sizeof t->crc) == t->crc;
    if (!fits) {
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
    const bool is_sound = entry == (int64_t)number && fits && head_is_sound(t);
    v->sound[number] = is_sound ? (uint8_t)(t->lod + 1) : 0;
    if (entry < 0 || (uint32_t)entry != number || band->zone != t->zone) {
        image_find(v->findings, at,
                   "tile of entry %" PRIu32 ": says it is level %u zone %u row %" PRIu32
                   " column %" PRIu32 ", which is not what the directory takes it for",
                   number, t->lod, t->zone, t->row, t->column);
        return false;
    }
    return v->findings->count == before;
}

static bool posts_agree(const struct lm_tile *a, int ra, int ca, const struct lm_tile *b, int rb,
                        int cb)
{
    const int64_t difference = image_post_q6(a, ra, ca) - image_post_q6(b, rb, cb);
    const int64_t step = coarser_step(a, b);
    return difference >= -step && difference <= step;
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

/* The neighbours of a tile: some of 16, by their row and column modulo 4. */
struct neighbours {
    const struct image *image;
    struct neighbour {
        const struct lm_tile *tile;
        uint32_t row, column;
        bool is_known;
    } slots[16];
};

/* A border asks for each of its neighbours again and again. */
static const struct lm_tile *find_neighbour(void *ctx, uint8_t level, uint32_t row, uint32_t column)
{
    struct neighbours *n = ctx;
    struct neighbour *slot = &n->slots[row % 4 * 4 + column % 4];
    if (!slot->is_known || slot->row != row || slot->column != column) {
        *slot = (struct neighbour){find_tile(n->image, level, row, column), row, column, true};
    }
    return slot->tile;
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
    struct neighbours around = {.image = v->image};
    const struct image_neighbours n = {find_neighbour, &around, v->image->header.shift0};
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

/* ---- what belongs to it ---- */

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

static void check_parent(struct verify *v, uint32_t number, const struct lm_tile *t)
{
    if (t->lod + 1 < v->image->header.lod_count &&
        !find_tile(v->image, (uint8_t)(t->lod + 1), t->row >> 1, t->column >> 1)) {
        image_find(v->findings, image_record_offset(v->image, number),
                   "tile of entry %" PRIu32 ": there is no tile above it", number);
    }
}

void verify_tile(struct verify *v, uint32_t number)
{
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
}
