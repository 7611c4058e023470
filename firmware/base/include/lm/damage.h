/* Damage: the pixels of a glass that changed, in blocks. A block is 16 pixels wide and 8 high; a
 * band is a row of blocks, one bit for each.
 *
 *     band[b], bit k: columns 16 k .. 16 k + 15 of rows 8 b .. 8 b + 7
 *
 * Marking too much costs time; marking too little leaves old pixels on the glass. The caller owns
 * the struct; all zero is no damage. Nothing here fails. */
#ifndef LM_DAMAGE_H
#define LM_DAMAGE_H

#include <stdbool.h>
#include <stdint.h>

enum {
    LM_BLOCK_WIDTH_PX = 16,
    LM_BLOCK_HEIGHT_PX = 8,
    LM_BANDS = 1024 / LM_BLOCK_HEIGHT_PX /* of the largest glass */
};

struct lm_damage {
    uint64_t band[LM_BANDS];
};

/* A rectangle of pixels: from left and top up to, not including, right and bottom. */
struct lm_rectangle {
    int32_t left, top, right, bottom;
};

/* Mark the blocks of a rectangle. What lies beyond 0..1023 is left out. Cost: some 20 instructions
 * and 3 a band. */
void lm_damage_mark(struct lm_damage *d, const struct lm_rectangle *r);

/* Mark columns `left` up to, not including, `right` of one band; 0 <= left, right <= 1024. Nothing
 * if none is between. Cost: some 10 instructions. */
static inline void lm_damage_mark_band(struct lm_damage *d, uint32_t band, int32_t left,
                                       int32_t right)
{
    if (left < right) {
        const uint32_t first = (uint32_t)left / LM_BLOCK_WIDTH_PX;
        const uint32_t last = ((uint32_t)right - 1) / LM_BLOCK_WIDTH_PX;
        d->band[band] |= ~(uint64_t)0 >> (63 - (last - first)) << first;
    }
}

/* Mark all that another damage marks. */
void lm_damage_add(struct lm_damage *d, const struct lm_damage *more);

/* Make it no damage. */
void lm_damage_clear(struct lm_damage *d);

bool lm_damage_is_empty(const struct lm_damage *d);

/* True if any block of the rectangle is marked, or if all are. */
bool lm_damage_meets(const struct lm_damage *d, const struct lm_rectangle *r);
bool lm_damage_covers(const struct lm_damage *d, const struct lm_rectangle *r);

/* A walk over the marked blocks of a rectangle. */
struct lm_damage_walk {
    struct lm_rectangle within;
    uint64_t bits;             /* of the blocks of `within` in a band */
    uint32_t band, end;        /* bands that are not looked at yet */
    uint64_t blocks;           /* of the bands looked at last, which are not handed out yet */
    int32_t top_px, bottom_px; /* of those bands */
};

/* A walk over the blocks of *within. */
struct lm_damage_walk lm_damage_walk(const struct lm_rectangle *within);

/* Take the next rectangle that is marked, no part of which lies outside of `within`. They do not
 * overlap; bands with the same blocks are joined. False, and *r unchanged, at the end. */
bool lm_damage_next(const struct lm_damage *d, struct lm_damage_walk *walk, struct lm_rectangle *r);

#endif
