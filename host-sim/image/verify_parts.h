/* Inside of image_verify: what its files share. */
#ifndef IMAGE_VERIFY_PARTS_H
#define IMAGE_VERIFY_PARTS_H

#include "image/verify.h"

#include <stdbool.h>
#include <string.h>

struct rung;
struct scratch;
struct trees;

/* One thread's view of the work. */
struct verify {
    struct image *image;
    struct image_findings *findings;
    struct image_verify_counts *counts;
    uint32_t *entries;    /* those that have a record, by its place */
    uint32_t entry_count; /* of them */
    uint8_t *sound;       /* by entry: 1 and the level, if its tile passes lm_tile_check; else 0 */
    struct rung *spare;   /* owned: a list of those that are used again */
    struct scratch *scratch; /* for verify_levels; owned by it */
    struct trees *trees;     /* checked beforehand; NULL: none */
};

/* A part of the work that a thread does by itself, and what came of it. */
struct verify_part {
    struct image_findings findings;
    struct image_kept kept;
    struct image_verify_counts counts;
};

/* Let a worker of `v` work on a part. */
void verify_part_begin(struct verify_part *part, const struct verify *v, struct verify *worker);

/* Tell and count what came of a part. */
void verify_part_tell(const struct verify *v, struct verify_part *part);

/* Check the record of an entry by itself and against its neighbours, and note whether it is sound.
 */
void verify_tile(struct verify *v, uint32_t number);

/* Check that each level holds the mean of the one below, with so many threads. */
void verify_levels(struct verify *v, uint32_t threads);

static inline bool class_is_unused(const struct lm_class *c)
{
    static const struct lm_class zero;
    return memcmp(c, &zero, sizeof zero) == 0;
}

/* Metres x 64 that two readings of one post may differ by: each was cut to its own tile's steps. */
static inline int64_t coarser_step(const struct lm_tile *a, const struct lm_tile *b)
{
    return (int64_t)1 << (a->post_shift > b->post_shift ? a->post_shift : b->post_shift);
}

static inline const struct lm_tile *find_tile(const struct image *image, uint8_t level,
                                              uint32_t row, uint32_t column)
{
    const struct lm_tile *t = image_find_tile(image, level, row, column);
    return t && t->post_shift <= LM_TILE_POST_SHIFT_MAX ? t : NULL;
}

#endif
