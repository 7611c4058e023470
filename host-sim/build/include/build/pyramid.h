/* Pyramid of an image: all its tiles, from the finest level to the coarsest. Memory holds few tile
 * rows at a time: a row is made as soon as the two rows below it are, and only then are those
 * freed. */
#ifndef BUILD_PYRAMID_H
#define BUILD_PYRAMID_H

#include "build/shard.h"
#include "build/tile.h"
#include "image/writer.h"

struct build_level_counts {
    uint32_t tiles[LM_DB_LODS_MAX];
};

/* Make the tiles of b->plan and append them to the writer. Memory: two tile rows a level, 38 kB a
 * tile. Returns 0, or -1 with the error reported. */
int build_pyramid(struct build_context *b, struct image_writer *writer,
                  struct build_level_counts *counts);

/* Tiles that were made apart: those of `level` and below. */
struct build_made {
    void *ctx;
    int level;
    /* The record of a tile; at `level` also what the tiles above it need, into `tile`, which is
     * NULL below. Returns 1, 0 where there is no such tile, or -1 with the error reported. */
    int (*take)(void *ctx, int level, uint32_t row, uint32_t column, struct lm_tile *record,
                struct build_tile *tile);
};

/* The same tiles in the same order, those of `made` taken from there. Memory: two tile rows of each
 * level above made->level, 130 kB a tile. */
int build_pyramid_join(struct build_context *b, const struct build_made *made,
                       struct image_writer *writer, struct build_level_counts *counts);

/* Where the tiles of a shard go. */
struct build_sink {
    void *ctx;
    /* A tile of a level, `is_top` of that of the shard. Returns 0, or -1 with the error reported.
     */
    int (*put)(void *ctx, uint32_t entry, const struct build_tile *tile, bool is_top);
};

/* Make the tiles of a shard. Memory: four tiles a level. Returns 0, or -1 with the error reported.
 */
int build_pyramid_shard(struct build_context *b, const struct build_shard *shard,
                        const struct build_sink *sink);

#endif
