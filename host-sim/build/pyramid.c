#include "build/pyramid.h"

#include "hs/error.h"
#include "hs/progress.h"

#include <stdlib.h>

/* The tiles of one row of one level. */
struct tile_row {
    const struct lm_band *band; /* NULL: the level has no tiles in this row */
    struct build_tile **tiles;  /* band->columns of them, NULL where there is none */
};

struct pyramid {
    struct build_context *b;
    struct image_writer *writer;
    struct build_level_counts *counts;
    const struct build_made *made; /* NULL: nothing is made */
    struct hs_progress progress;
    uint64_t entries_done;
};

static void free_row(struct tile_row *row)
{
    for (uint32_t i = 0; row->tiles && i < row->band->columns; i++) {
        free(row->tiles[i]);
    }
    free(row->tiles);
    row->tiles = NULL;
}

static uint32_t round_mask(const struct pyramid *p, const struct lm_band *band)
{
    return image_columns_round((uint8_t)(p->b->plan.shift0 + band->lod), band->zone) - 1;
}

static struct build_tile *tile_at(const struct pyramid *p, const struct tile_row *row,
                                  uint32_t column)
{
    if (!row->band) {
        return NULL;
    }
    const uint32_t east = (column - row->band->column0) & round_mask(p, row->band);
    return east < row->band->columns ? row->tiles[east] : NULL;
}

/* Enter where the detail of a tile of the finest level lies. */
static void name_detail(struct pyramid *p, uint8_t level, uint32_t entry,
                        const struct lm_tile *tile)
{
    const struct build_detail_record detail =
        build_detail_of_tile(&p->b->detail, tile->row, tile->column);
    if (level == 0 && detail.units != 0) {
        image_writer_detail(p->writer, entry, detail.place, (uint8_t)detail.units);
        p->b->counts.detail_items += detail.items;
    }
}

static int write_tile(struct pyramid *p, const struct lm_band *band, uint32_t entry,
                      const struct lm_tile *tile)
{
    name_detail(p, band->lod, entry, tile);
    p->counts->tiles[band->lod]++;
    return image_writer_tile(p->writer, entry, tile);
}

/* A tile that was made apart, into the image; *out is NULL below the level of the shards. */
static int take_made(struct pyramid *p, const struct lm_band *band, uint32_t row, uint32_t column,
                     uint32_t entry, struct build_tile **out)
{
    const bool is_top = band->lod == p->made->level;
    struct lm_tile record;
    struct build_tile *t = is_top ? calloc(1, sizeof *t) : NULL;
    if (is_top && !t) {
        return hs_error("tiles", "choose larger cells", "out of memory");
    }
    const int taken = p->made->take(p->made->ctx, band->lod, row, column, &record, t);
    if (taken <= 0) {
        free(t);
        return taken;
    }
    if (t) {
        t->record = record;
    }
    *out = t;
    return write_tile(p, band, entry, &record);
}

static int make_row_tiles(struct pyramid *p, uint32_t number, const struct tile_row below[2],
                          struct tile_row *row)
{
    const struct lm_band *band = row->band;
    for (uint32_t i = 0; i < band->columns; i++) {
        const uint32_t column = (band->column0 + i) & round_mask(p, band);
        const uint32_t entry = band->entry0 + (number - band->row0) * band->columns + i;
        hs_progress_update(&p->progress, ++p->entries_done);
        if (p->made && band->lod <= p->made->level) {
            if (take_made(p, band, number, column, entry, &row->tiles[i]) != 0) {
                return -1;
            }
            continue;
        }
        struct build_tile *const children[4] = {
            tile_at(p, &below[0], 2 * column), tile_at(p, &below[0], 2 * column + 1),
            tile_at(p, &below[1], 2 * column), tile_at(p, &below[1], 2 * column + 1)};
        if (build_tile_make(p->b, band->lod, band->zone, number, column, children,
                            &row->tiles[i]) != 0) {
            return -1;
        }
        if (row->tiles[i] && write_tile(p, band, entry, &row->tiles[i]->record) != 0) {
            return -1;
        }
    }
    return 0;
}

/* Make a row and all rows below it. The caller frees it, after a failure too. */
static int make_row(struct pyramid *p, int level, uint32_t number, struct tile_row *row)
{
    *row = (struct tile_row){.band = build_plan_band(&p->b->plan, level, number)};
    if (!row->band) {
        return 0;
    }
    row->tiles = calloc(row->band->columns, sizeof(struct build_tile *));
    if (!row->tiles) {
        return hs_error("tiles", "choose larger cells", "out of memory");
    }
    struct tile_row below[2] = {{0}, {0}};
    int result = 0;
    for (uint32_t k = 0; k < 2 && result == 0 && level > 0; k++) {
        result = make_row(p, level - 1, 2 * number + k, &below[k]);
    }
    if (result == 0) {
        result = make_row_tiles(p, number, below, row);
    }
    free_row(&below[0]);
    free_row(&below[1]);
    return result;
}

static int make_band(struct pyramid *p, const struct lm_band *band)
{
    for (uint32_t r = 0; r < band->rows; r++) {
        struct tile_row row;
        const int result = make_row(p, band->lod, band->row0 + r, &row);
        free_row(&row);
        if (result != 0) {
            return -1;
        }
    }
    return 0;
}

int build_pyramid(struct build_context *b, struct image_writer *writer,
                  struct build_level_counts *counts)
{
    return build_pyramid_join(b, NULL, writer, counts);
}

int build_pyramid_join(struct build_context *b, const struct build_made *made,
                       struct image_writer *writer, struct build_level_counts *counts)
{
    struct pyramid p = {.b = b, .writer = writer, .counts = counts, .made = made};
    *counts = (struct build_level_counts){0};
    hs_progress_begin(&p.progress, "building", b->plan.entry_count);
    int result = 0;
    for (int i = 0; result == 0 && i < b->plan.band_count; i++) {
        if (b->plan.bands[i].lod == b->plan.level_count - 1) {
            result = make_band(&p, &b->plan.bands[i]);
        }
    }
    hs_progress_end(&p.progress);
    return result;
}

/* ---- a shard ---- */

struct shard_tree {
    struct build_context *b;
    const struct build_sink *sink;
    int top;
    struct hs_progress progress;
    uint64_t entries_done;
};

/* The directory entry of a tile, or false where the plan has none. */
static bool entry_of(const struct build_plan *plan, int level, uint32_t row, uint32_t column,
                     const struct lm_band **band, uint32_t *entry)
{
    *band = build_plan_band(plan, level, row);
    if (!*band) {
        return false;
    }
    const uint32_t mask =
        image_columns_round((uint8_t)(plan->shift0 + (unsigned)level), (*band)->zone) - 1;
    const uint32_t east = (column - (*band)->column0) & mask;
    *entry = (*band)->entry0 + (row - (*band)->row0) * (*band)->columns + east;
    return east < (*band)->columns;
}

/* Make a tile and all below it; *out is NULL where there is none. The caller frees it. */
static int make_tree(struct shard_tree *t, int level, uint32_t row, uint32_t column,
                     struct build_tile **out)
{
    struct build_tile *children[4] = {NULL, NULL, NULL, NULL};
    const struct lm_band *band;
    uint32_t entry;
    *out = NULL;
    if (!entry_of(&t->b->plan, level, row, column, &band, &entry)) {
        return 0;
    }
    int result = 0;
    for (uint32_t i = 0; i < 4 && result == 0 && level > 0; i++) {
        result = make_tree(t, level - 1, 2 * row + i / 2, 2 * column + i % 2, &children[i]);
    }
    if (result == 0) {
        result = build_tile_make(t->b, level, band->zone, row, column, children, out);
    }
    for (int i = 0; i < 4; i++) {
        free(children[i]);
    }
    hs_progress_update(&t->progress, ++t->entries_done);
    return result == 0 && *out ? t->sink->put(t->sink->ctx, entry, *out, level == t->top) : result;
}

int build_pyramid_shard(struct build_context *b, const struct build_shard *shard,
                        const struct build_sink *sink)
{
    struct shard_tree t = {.b = b, .sink = sink, .top = shard->level};
    const uint32_t mask =
        image_columns_round((uint8_t)(b->plan.shift0 + (unsigned)shard->level), shard->zone) - 1;
    int result = 0;
    hs_progress_begin(&t.progress, "building", build_shard_tiles_all(&b->plan, shard));
    for (uint32_t r = 0; r < shard->rows && result == 0; r++) {
        for (uint32_t c = 0; c < shard->columns && result == 0; c++) {
            struct build_tile *tile;
            result =
                make_tree(&t, shard->level, shard->row0 + r, (shard->column0 + c) & mask, &tile);
            free(tile);
        }
    }
    hs_progress_end(&t.progress);
    return result;
}
