#include "image/unpacked.h"

#include "image/pack.h"

#include <stdlib.h>
#include <sys/mman.h>

struct slot {
    uint64_t last_use; /* 0: free */
    uint32_t entry;
};

struct image_unpacked {
    uint64_t clock;
    uint32_t *slot_of; /* of each entry: its slot and 1, or 0 */
    uint32_t count;    /* of slots */
    struct slot *slots;
    struct lm_tile *tiles; /* one for each slot */
};

/* In large pages, where the system has them: each of the small ones would cost as much as half a
 * tile. */
static void *new_tiles(uint32_t count)
{
    const size_t page = (size_t)2 << 20;
    const size_t bytes = (count * sizeof(struct lm_tile) + page - 1) / page * page;
    void *tiles = aligned_alloc(page, bytes);
    if (tiles) {
        (void)madvise(tiles, bytes, MADV_HUGEPAGE);
    }
    return tiles;
}

struct image_unpacked *image_unpacked_new(uint32_t entries, uint32_t tiles)
{
    struct image_unpacked *u = calloc(1, sizeof *u);
    if (!u) {
        return NULL;
    }
    u->count = tiles;
    u->slot_of = calloc((size_t)entries + 1, sizeof *u->slot_of);
    u->slots = calloc(tiles, sizeof *u->slots);
    u->tiles = new_tiles(tiles);
    if (!u->slot_of || !u->slots || !u->tiles) {
        image_unpacked_free(u);
        return NULL;
    }
    return u;
}

void image_unpacked_free(struct image_unpacked *u)
{
    if (u) {
        free(u->slot_of);
        free(u->slots);
        free(u->tiles);
        free(u);
    }
}

/* The slot used longest ago, which any free one is. */
static uint32_t oldest_slot(const struct image_unpacked *u)
{
    uint32_t oldest = 0;
    for (uint32_t i = 1; i < u->count; i++) {
        oldest = u->slots[i].last_use < u->slots[oldest].last_use ? i : oldest;
    }
    return oldest;
}

static uint32_t take_slot(struct image_unpacked *u, uint32_t entry)
{
    const uint32_t i = oldest_slot(u);
    if (u->slots[i].last_use > 0) {
        u->slot_of[u->slots[i].entry] = 0;
    }
    u->slots[i].entry = entry;
    u->slot_of[entry] = i + 1;
    return i;
}

const struct lm_tile *image_unpacked_tile(struct image_unpacked *u, uint32_t entry,
                                          const uint8_t *record, uint16_t size)
{
    if (u->slot_of[entry] == 0) {
        (void)image_unpack(record, size, &u->tiles[take_slot(u, entry)]);
    }
    const uint32_t i = u->slot_of[entry] - 1;
    u->slots[i].last_use = ++u->clock;
    return &u->tiles[i];
}
