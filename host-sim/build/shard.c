#include "build/shard.h"

#include "hs/error.h"

/* How much of first..first + count - 1 lies in 0..most - 1. */
static uint64_t common(int64_t first, int64_t count, int64_t most)
{
    const int64_t begin = first > 0 ? first : 0;
    const int64_t end = first + count < most ? first + count : most;
    return end > begin ? (uint64_t)(end - begin) : 0;
}

uint64_t build_shard_tiles(const struct build_plan *plan, const struct build_shard *s, int level)
{
    const int down = s->level - level;
    uint64_t tiles = 0;
    for (int i = 0; i < plan->band_count; i++) {
        const struct lm_band *band = &plan->bands[i];
        if (band->lod != level || band->zone != s->zone || down < 0) {
            continue;
        }
        const int64_t round =
            image_columns_round((uint8_t)(plan->shift0 + (unsigned)level), band->zone);
        const int64_t column0 = ((int64_t)s->column0 << down) - band->column0;
        const int64_t east = (column0 % round + round) % round;
        const int64_t columns = (int64_t)s->columns << down;
        const uint64_t across =
            common(east, columns, band->columns) + common(east - round, columns, band->columns);
        tiles += across * common(((int64_t)s->row0 << down) - band->row0, (int64_t)s->rows << down,
                                 band->rows);
    }
    return tiles;
}

uint64_t build_shard_tiles_all(const struct build_plan *plan, const struct build_shard *s)
{
    uint64_t tiles = 0;
    for (int level = 0; level <= s->level; level++) {
        tiles += build_shard_tiles(plan, s, level);
    }
    return tiles;
}

bool build_shard_holds(const struct build_plan *plan, const struct build_shard *s, int level,
                       uint32_t row, uint32_t column)
{
    const int down = s->level - level;
    const uint8_t shift = (uint8_t)(plan->shift0 + s->level);
    if (down < 0 || (row >> down) - s->row0 >= s->rows) {
        return false;
    }
    const uint32_t mask = image_columns_round(shift, s->zone) - 1;
    return (((column >> down) - s->column0) & mask) < s->columns;
}

struct image_area build_shard_area(const struct build_plan *plan, const struct build_shard *s)
{
    const uint8_t shift = (uint8_t)(plan->shift0 + s->level);
    const struct image_frame first = image_frame_of(shift, s->zone, s->row0, s->column0);
    const struct image_area tile = image_frame_area(&first);
    return (struct image_area){.south = tile.south,
                               .north = tile.south + (tile.north - tile.south) * s->rows,
                               .west = tile.west,
                               .width = tile.width * s->columns};
}

/* The bands of a level as shards. Returns how many. */
static int take_bands(const struct build_plan *plan, int level, struct build_shard *shards)
{
    int count = 0;
    for (int i = 0; i < plan->band_count; i++) {
        const struct lm_band *band = &plan->bands[i];
        if (band->lod == level) {
            shards[count++] = (struct build_shard){.level = (uint8_t)level,
                                                   .zone = band->zone,
                                                   .row0 = band->row0,
                                                   .rows = band->rows,
                                                   .column0 = band->column0,
                                                   .columns = band->columns};
        }
    }
    return count;
}

/* Cut a shard across its longer side. Returns false when it is a single tile. */
static bool halve(const struct build_plan *plan, struct build_shard *s, struct build_shard *rest)
{
    if (s->rows == 1 && s->columns == 1) {
        return false;
    }
    *rest = *s;
    if (s->rows >= s->columns) {
        s->rows /= 2;
        rest->row0 += s->rows;
        rest->rows -= s->rows;
    } else {
        const uint32_t mask =
            image_columns_round((uint8_t)(plan->shift0 + (unsigned)s->level), s->zone) - 1;
        s->columns /= 2;
        rest->column0 = (rest->column0 + s->columns) & mask;
        rest->columns -= s->columns;
    }
    return true;
}

/* The coarsest level that can be parted finely enough: a tile of it and all below it are not more
 * than `tiles_most`, and there are enough of them that shards come out alike. */
static int choose_level(const struct build_plan *plan, int count, uint64_t tiles_most)
{
    for (int level = plan->level_count - 1; level > 0; level--) {
        uint64_t here = 0;
        for (int i = 0; i < plan->band_count; i++) {
            const struct lm_band *band = &plan->bands[i];
            here += band->lod == level ? (uint64_t)band->rows * band->columns : 0;
        }
        const uint64_t below = level < 15 ? ((uint64_t)4 << (2 * level)) / 3 : UINT64_MAX;
        if (below <= tiles_most && here >= (count > 1 ? 4 * (uint64_t)count : 1)) {
            return level;
        }
    }
    return 0;
}

int build_shards_cut(const struct build_plan *plan, int count, uint64_t tiles_most,
                     struct build_shard shards[BUILD_SHARDS_MAX])
{
    static uint64_t tiles[BUILD_SHARDS_MAX];
    int made = take_bands(plan, choose_level(plan, count, tiles_most), shards);
    for (int i = 0; i < made; i++) {
        tiles[i] = build_shard_tiles_all(plan, &shards[i]);
    }
    for (;;) {
        int most = 0;
        for (int i = 1; i < made; i++) {
            most = tiles[i] > tiles[most] ? i : most;
        }
        if (made >= count && tiles[most] <= tiles_most) {
            return made;
        }
        if (made == BUILD_SHARDS_MAX) {
            return hs_error("plan", "choose larger cells, or let a shard be larger",
                            "there would be more than %d shards", BUILD_SHARDS_MAX);
        }
        if (!halve(plan, &shards[most], &shards[made])) {
            return made;
        }
        tiles[most] = build_shard_tiles_all(plan, &shards[most]);
        tiles[made] = build_shard_tiles_all(plan, &shards[made]);
        made++;
    }
}
