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
                        const struct build_tile *tile)
{
    const struct build_detail_record detail =
        build_detail_of_tile(&p->b->detail, tile->record.row, tile->record.column);
    if (level == 0 && detail.units != 0) {
        image_writer_detail(p->writer, entry, detail.place, (uint8_t)detail.units);
        p->b->counts.detail_items += detail.items;
    }
}

static int make_row_tiles(struct pyramid *p, uint32_t number, const struct tile_row below[2],
                          struct tile_row *row)
{
    const struct lm_band *band = row->band;
    for (uint32_t i = 0; i < band->columns; i++) {
        const uint32_t column = (band->column0 + i) & round_mask(p, band);
        struct build_tile *const children[4] = {
            tile_at(p, &below[0], 2 * column), tile_at(p, &below[0], 2 * column + 1),
            tile_at(p, &below[1], 2 * column), tile_at(p, &below[1], 2 * column + 1)};
        if (build_tile_make(p->b, band->lod, band->zone, number, column, children,
                            &row->tiles[i]) != 0) {
            return -1;
        }
        const uint32_t entry = band->entry0 + (number - band->row0) * band->columns + i;
        if (row->tiles[i]) {
            name_detail(p, band->lod, entry, row->tiles[i]);
            if (image_writer_tile(p->writer, entry, &row->tiles[i]->record) != 0) {
                return -1;
            }
            p->counts->tiles[band->lod]++;
        }
        hs_progress_update(&p->progress, ++p->entries_done);
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
    struct pyramid p = {.b = b, .writer = writer, .counts = counts};
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
