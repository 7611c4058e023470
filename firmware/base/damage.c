#include "lm/damage.h"

#include "fx/bits.h"
#include "fx/mem.h"
#include "fx/sat.h"

enum { SIDE_PX = LM_BANDS * LM_BLOCK_HEIGHT_PX, BLOCKS = SIDE_PX / LM_BLOCK_WIDTH_PX };

/* The blocks of a rectangle: bits of each band, and bands. */
struct blocks {
    uint64_t bits;
    uint32_t first, end;
};

/* Bits `first` up to, not including, `end`; 0 <= first < end <= 64. The masks change nothing then,
 * and say so to those who cannot see it. */
static uint64_t bits_between(uint32_t first, uint32_t end)
{
    const uint32_t mask = BLOCKS - 1;
    return ~(uint64_t)0 >> ((BLOCKS - (end - first)) & mask) << (first & mask);
}

static struct blocks blocks_of(const struct lm_rectangle *r)
{
    const int32_t left = fx_max_i32(r->left, 0), right = fx_min_i32(r->right, SIDE_PX);
    const int32_t top = fx_max_i32(r->top, 0), bottom = fx_min_i32(r->bottom, SIDE_PX);
    if (left >= right || top >= bottom) {
        return (struct blocks){0, 0, 0};
    }
    return (struct blocks){
        .bits = bits_between((uint32_t)left / LM_BLOCK_WIDTH_PX,
                             ((uint32_t)right - 1) / LM_BLOCK_WIDTH_PX + 1),
        .first = (uint32_t)top / LM_BLOCK_HEIGHT_PX,
        .end = ((uint32_t)bottom - 1) / LM_BLOCK_HEIGHT_PX + 1,
    };
}

void lm_damage_mark(struct lm_damage *d, const struct lm_rectangle *r)
{
    const struct blocks b = blocks_of(r);
    for (uint32_t band = b.first; band < b.end; band++) {
        d->band[band] |= b.bits;
    }
}

void lm_damage_add(struct lm_damage *d, const struct lm_damage *more)
{
    for (uint32_t band = 0; band < LM_BANDS; band++) {
        d->band[band] |= more->band[band];
    }
}

void lm_damage_clear(struct lm_damage *d)
{
    memset(d, 0, sizeof *d);
}

bool lm_damage_is_empty(const struct lm_damage *d)
{
    uint64_t any = 0;
    for (uint32_t band = 0; band < LM_BANDS; band++) {
        any |= d->band[band];
    }
    return any == 0;
}

bool lm_damage_meets(const struct lm_damage *d, const struct lm_rectangle *r)
{
    const struct blocks b = blocks_of(r);
    uint64_t any = 0;
    for (uint32_t band = b.first; band < b.end; band++) {
        any |= d->band[band];
    }
    return (any & b.bits) != 0;
}

bool lm_damage_covers(const struct lm_damage *d, const struct lm_rectangle *r)
{
    const struct blocks b = blocks_of(r);
    uint64_t all = ~(uint64_t)0;
    for (uint32_t band = b.first; band < b.end; band++) {
        all &= d->band[band];
    }
    return (~all & b.bits) == 0;
}

struct lm_damage_walk lm_damage_walk(const struct lm_rectangle *within)
{
    const struct blocks b = blocks_of(within);
    return (struct lm_damage_walk){
        .within = *within, .bits = b.bits, .band = b.first, .end = b.end};
}

/* Go to the next bands that are marked, and join those that are marked alike. */
static void find_bands(const struct lm_damage *d, struct lm_damage_walk *w)
{
    while (w->band < w->end && (d->band[w->band] & w->bits) == 0) {
        w->band++;
    }
    w->top_px = (int32_t)w->band * LM_BLOCK_HEIGHT_PX;
    w->blocks = w->band < w->end ? d->band[w->band] & w->bits : 0;
    while (w->band < w->end && (d->band[w->band] & w->bits) == w->blocks) {
        w->band++;
    }
    w->bottom_px = (int32_t)w->band * LM_BLOCK_HEIGHT_PX;
}

bool lm_damage_next(const struct lm_damage *d, struct lm_damage_walk *walk, struct lm_rectangle *r)
{
    const struct lm_rectangle *const within = &walk->within;
    if (walk->blocks == 0) {
        find_bands(d, walk);
    }
    if (walk->blocks == 0) {
        return false;
    }
    const uint32_t first = (uint32_t)fx_ctz64(walk->blocks);
    const uint64_t gaps = ~(walk->blocks >> first);
    const uint32_t end = gaps == 0 ? BLOCKS : first + (uint32_t)fx_ctz64(gaps);
    walk->blocks &= ~bits_between(first, end);
    *r = (struct lm_rectangle){.left = fx_max_i32((int32_t)first * LM_BLOCK_WIDTH_PX, within->left),
                               .top = fx_max_i32(walk->top_px, within->top),
                               .right = fx_min_i32((int32_t)end * LM_BLOCK_WIDTH_PX, within->right),
                               .bottom = fx_min_i32(walk->bottom_px, within->bottom)};
    return true;
}
