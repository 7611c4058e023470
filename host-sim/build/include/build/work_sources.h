/* Sources of a work plan, and the keys of its shards. A key is a digest of all that the tiles of a
 * shard are made from: of the options and tables that count everywhere, and of those sources that
 * reach there. As long as it stays, so do the shard's tiles. */
#ifndef BUILD_WORK_SOURCES_H
#define BUILD_WORK_SOURCES_H

#include "build/tile.h"
#include "build/work.h"

/* A file that is not a raster of the map. */
struct build_plain_file {
    const char *role, *path;
};

/* Enter `files` and every file of the context's rasters, with digests. A file of a raster counts
 * where its own georeference says that it lies, or else everywhere. Returns 0, or -1 with the error
 * reported. Cost: reads all. */
int build_work_find_sources(struct build_work *w, const struct build_context *b,
                            const struct build_plain_file *files, int count);

/* Cut the plan of the context into at least `count` shards that need at most `memory_mib` each, as
 * far as is known before, and enter them with their keys. `choices` are options that count
 * everywhere and that the context does not show. Returns 0, or -1 with the error reported. */
int build_work_cut(struct build_work *w, const struct build_context *b, int count,
                   uint32_t memory_mib, const char *choices);

/* The area from which sources reach into a shard. */
struct image_area build_work_reach(const struct build_context *b, const struct build_shard *s);

/* Which sources of the plan a shard is made from: counts[i] of each. */
void build_work_choose(const struct build_work *w, const struct build_context *b,
                       const struct build_shard *s, bool *counts);

enum { BUILD_WORK_CACHE_MIB = 256 }; /* that GDAL may take in a shard */

#endif
