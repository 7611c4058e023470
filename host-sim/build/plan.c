#include "build/plan.h"

#include "hs/error.h"

#include <math.h>
#include <stddef.h>

enum { COARSEST_TILES = 4 };

/* 64 Mi entries: half a gigabyte of directory. */
static const uint64_t entries_max = 64u << 20;

/* Add the bands that cover an area at a level. Returns the number of tiles in them, or -1 when the
 * table is full. */
static int64_t add_bands(struct build_plan *plan, int level, const struct image_area *area)
{
    const uint8_t shift = (uint8_t)(plan->shift0 + level);
    const uint32_t last =
        image_row_of(shift, area->north > area->south ? area->north - 1 : area->south);
    uint32_t row = image_row_of(shift, area->south);
    uint64_t tiles = 0;
    while (row <= last) {
        if (plan->band_count == LM_DB_BANDS_MAX) {
            return -1;
        }
        const uint8_t zone = image_row_zone(shift, row);
        const int tile_shift = shift + LM_TILE_CELLS_LOG2 + zone;
        const uint32_t round = image_columns_round(shift, zone);
        const int64_t into_tile = area->west & (((int64_t)1 << tile_shift) - 1);
        const int64_t columns = ((into_tile + area->width - 1) >> tile_shift) + 1;
        struct lm_band *band = &plan->bands[plan->band_count++];
        *band = (struct lm_band){.lod = (uint8_t)level,
                                 .zone = zone,
                                 .row0 = row,
                                 .column0 = area->west >> tile_shift,
                                 .columns = columns < round ? (uint32_t)columns : round,
                                 .entry0 = plan->entry_count};
        while (row <= last && image_row_zone(shift, row) == zone) {
            row++;
        }
        band->rows = row - band->row0;
        tiles += (uint64_t)band->rows * band->columns;
        if (plan->entry_count + tiles > entries_max) {
            return -1;
        }
        plan->entry_count = band->entry0 + band->rows * band->columns;
    }
    return (int64_t)tiles;
}

static int too_many(void)
{
    return hs_error("--cell", "choose larger cells or fewer inputs",
                    "the image would have more tiles than one image can");
}

int build_plan_make(struct build_plan *plan, uint8_t shift0, struct build_extent *extents,
                    int count)
{
    *plan = (struct build_plan){.shift0 = shift0};
    int last_level = 0;
    for (int i = 0; i < count; i++) {
        last_level = extents[i].level > last_level ? extents[i].level : last_level;
    }
    const int end = LM_DB_SHIFT_MAX + 1 - shift0 < LM_DB_LODS_MAX ? LM_DB_SHIFT_MAX + 1 - shift0
                                                                  : LM_DB_LODS_MAX;
    last_level = last_level < end - 1 ? last_level : end - 1;
    for (int level = 0; level < end; level++) {
        struct image_area area = {0};
        for (int i = 0; i < count; i++) {
            extents[i].level = extents[i].level < last_level ? extents[i].level : last_level;
            if (extents[i].level <= level) {
                image_area_add(&area, &extents[i].area);
            }
        }
        const struct build_plan before = *plan;
        const int64_t tiles = add_bands(plan, level, &area);
        if (tiles < 0) {
            /* A picture of the whole Earth needs seven bands a level: it does with fewer levels. */
            *plan = before;
            return level > last_level ? 0 : too_many();
        }
        plan->level_count = (uint8_t)(level + 1);
        if (tiles <= COARSEST_TILES && level >= last_level) {
            break;
        }
    }
    return 0;
}

const struct lm_band *build_plan_band(const struct build_plan *plan, int level, uint32_t row)
{
    for (int i = 0; i < plan->band_count; i++) {
        const struct lm_band *b = &plan->bands[i];
        if (b->lod == level && row >= b->row0 && row - b->row0 < b->rows) {
            return b;
        }
    }
    return NULL;
}

int build_plan_level(uint8_t shift0, double pixel_bam)
{
    /* A whisker for pixels that are a power of two but for rounding. */
    return (int)floor(log2(pixel_bam) + 1e-6) - shift0;
}
