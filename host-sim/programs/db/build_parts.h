/* The parts of an image, put together: tiles and sums of the shards of a work plan, as
 * build_pyramid_join takes them. */
#ifndef DB_BUILD_PARTS_H
#define DB_BUILD_PARTS_H

#include "build/part.h"
#include "build/pyramid.h"
#include "build/work.h"

struct build_parts {
    const struct build_work *work; /* borrowed, as is its path */
    const char *plan;
    struct build_context *b;  /* borrowed: opened for the same plan */
    struct build_part *parts; /* owned; by shard */
    int last;                 /* where the last tile was found */
    uint32_t taken;           /* tiles since the parts' memory was given back */
};

/* Returns 0, or -1 with the error reported; end either way. */
int build_parts_begin(struct build_parts *p, const struct build_work *work, const char *plan,
                      struct build_context *b);

/* Add the part in `path`, a name that stays until the end. Returns 0, or -1 with the error
 * reported: as build_part_open, it is of another plan, or of a shard that is there already. Cost:
 * reads all of it. */
int build_parts_add(struct build_parts *p, const char *path);

/* When all have been added: their sums to those of the context, and their tiles into *made. Returns
 * 0, or -1 with the shard reported that is missing. */
int build_parts_join(struct build_parts *p, struct build_made *made);

/* Harmless on a zeroed struct. */
void build_parts_end(struct build_parts *p);

#endif
