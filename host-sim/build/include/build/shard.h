/* Shard: a rectangle of tiles of one level, with all tiles below them. The tiles of a plan up to
 * that level are cut into shards, which are made apart; coarser tiles are made when they are
 * joined. */
#ifndef BUILD_SHARD_H
#define BUILD_SHARD_H

#include "build/plan.h"

enum { BUILD_SHARDS_MAX = 4096 };

struct build_shard {
    uint8_t level, zone;
    uint32_t row0, rows, column0, columns; /* of tiles of `level`; columns wrap */
};

/* Cut the tiles of `plan` into at least `count` shards (1..BUILD_SHARDS_MAX) of at most
 * `tiles_most` tiles each, as far as tiles can be parted. Each shard lies in one zone of latitude,
 * so that there may be more. Returns how many there are, or -1 with the error reported: they are
 * more than BUILD_SHARDS_MAX. */
int build_shards_cut(const struct build_plan *plan, int count, uint64_t tiles_most,
                     struct build_shard shards[BUILD_SHARDS_MAX]);

/* How many tiles of a level, or of all, the bands of the plan have in a shard. */
uint64_t build_shard_tiles(const struct build_plan *plan, const struct build_shard *s, int level);
uint64_t build_shard_tiles_all(const struct build_plan *plan, const struct build_shard *s);

/* Does a tile lie in the shard, at its level or below? */
bool build_shard_holds(const struct build_plan *plan, const struct build_shard *s, int level,
                       uint32_t row, uint32_t column);

struct image_area build_shard_area(const struct build_plan *plan, const struct build_shard *s);

#endif
