/* Misses of the first cache while a patch is read from tiles, by the order of the points in a tile:
 * what docs/TRIED.md says of it. 256 lines of 256 places each, in the direction given; between two
 * lines the other stages pass over buffers of their own. Every place reads the four points around
 * it: two loads of two points in rows, four loads in blocks, one of both rows in pairs.
 *
 *   tile_order [BUFFERS-KiB]     24 without */
#include "cache_model.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { LINES = 256, PLACES = 256, TILE = 64, POINTS = 66, POINT_BYTES = 4, SLOT_BYTES = 17472 };

/* What the buffers are read from, far from the pool. */
static const uint64_t buffers_at = 1ULL << 40, pool_at = 1ULL << 30;

struct order {
    const char *name;
    uint32_t slot_bytes;
    void (*read)(struct cache_levels *levels, uint64_t tile, uint32_t row, uint32_t column,
                 struct cache_counts *counts);
};

static void read_rows(struct cache_levels *levels, uint64_t tile, uint32_t row, uint32_t column,
                      struct cache_counts *counts)
{
    for (uint32_t r = row; r <= row + 1; r++) {
        cache_model_data(levels, tile + (r * POINTS + column) * POINT_BYTES, 2 * POINT_BYTES,
                         counts);
    }
}

static void read_columns(struct cache_levels *levels, uint64_t tile, uint32_t row, uint32_t column,
                         struct cache_counts *counts)
{
    read_rows(levels, tile, column, row, counts);
}

/* Blocks of 16 points, which fill a line: `high` rows of them. */
static void read_blocks(struct cache_levels *levels, uint64_t tile, uint32_t row, uint32_t column,
                        uint32_t high, struct cache_counts *counts)
{
    const uint32_t wide = 16 / high, across = (POINTS + wide - 1) / wide;
    for (uint32_t r = row; r <= row + 1; r++) {
        for (uint32_t c = column; c <= column + 1; c++) {
            const uint32_t block = r / high * across + c / wide;
            const uint32_t at = block * 16 + r % high * wide + c % wide;
            cache_model_data(levels, tile + at * POINT_BYTES, POINT_BYTES, counts);
        }
    }
}

static void read_blocks_of_2(struct cache_levels *levels, uint64_t tile, uint32_t row,
                             uint32_t column, struct cache_counts *counts)
{
    read_blocks(levels, tile, row, column, 2, counts);
}

static void read_blocks_of_4(struct cache_levels *levels, uint64_t tile, uint32_t row,
                             uint32_t column, struct cache_counts *counts)
{
    read_blocks(levels, tile, row, column, 4, counts);
}

/* Each row with the one north of it, point by point: one load brings all four. */
static void read_pairs(struct cache_levels *levels, uint64_t tile, uint32_t row, uint32_t column,
                       struct cache_counts *counts)
{
    cache_model_data(levels, tile + (uint64_t)(row * POINTS + column) * 2 * POINT_BYTES,
                     4 * POINT_BYTES, counts);
}

static const struct order orders[] = {
    {"rows, as it is", SLOT_BYTES, read_rows},
    {"columns", SLOT_BYTES, read_columns},
    {"blocks of 2 x 8", 19200, read_blocks_of_2},
    {"blocks of 4 x 4", 18496, read_blocks_of_4},
    {"two rows side by side", 2 * SLOT_BYTES, read_pairs},
};

/* Misses of the first cache for each place, of a patch whose cells are `step` points wide. */
static double misses(const struct order *order, double degrees, double step, uint32_t buffer_bytes)
{
    static struct cache_levels levels;
    struct cache_counts counts = {0}, others = {0};
    const double along = degrees * 3.14159265358979 / 180;
    const double north_step = step * cos(along), east_step = step * sin(along);
    cache_model_levels(&levels);
    for (uint32_t line = 0; line < LINES; line++) {
        for (uint32_t place = 0; place < PLACES; place++) {
            const double north = 1000 + place * north_step - line * east_step;
            const double east = 1000 + place * east_step + line * north_step;
            const uint32_t row = (uint32_t)north, column = (uint32_t)east;
            const uint32_t slot = (row / TILE * 32 + column / TILE) % 384;
            order->read(&levels, pool_at + (uint64_t)slot * order->slot_bytes, row % TILE,
                        column % TILE, &counts);
        }
        for (uint64_t at = 0; at < buffer_bytes; at += CACHE_LINE_BYTES) {
            cache_model_data(&levels, buffers_at + at, 4, &others);
        }
    }
    return (double)counts.misses / (LINES * PLACES);
}

int main(int argc, char **argv)
{
    static const double steps[] = {1.04, 0.42}, directions[] = {0, 45, 90};
    const uint32_t kib = argc > 1 ? (uint32_t)strtoul(argv[1], NULL, 10) : 24;
    printf("misses of the first cache for each place, buffers of %u KiB between two lines\n", kib);
    printf("%-24s%28s%28s\n%-24s", "", "cells of 5 m", "cells of 2 m", "lines towards");
    for (uint32_t i = 0; i < 6; i++) {
        printf("%*.0f", i == 3 ? 12 : 8, directions[i % 3]);
    }
    for (uint32_t o = 0; o < sizeof orders / sizeof orders[0]; o++) {
        printf("\n%-24s", orders[o].name);
        for (uint32_t i = 0; i < 6; i++) {
            printf("%*.2f", i == 3 ? 12 : 8,
                   misses(&orders[o], directions[i % 3], steps[i / 3], kib << 10));
        }
    }
    printf("\n");
    return 0;
}
