#include "image/unpacked.h"

#include "image/pack.h"

#include <stdlib.h>

struct slot {
    uint64_t last_use; /* 0: free */
    uint32_t entry;
};

struct image_unpacked {
    uint64_t clock;
    uint32_t *slot_of; /* of each entry: its slot and 1, or 0 */
    struct slot slots[IMAGE_UNPACKED_TILES];
    struct lm_tile tiles[IMAGE_UNPACKED_TILES];
};

struct image_unpacked *image_unpacked_new(uint32_t entries)
{
    struct image_unpacked *u = calloc(1, sizeof *u);
    uint32_t *slot_of = calloc((size_t)entries + 1, sizeof *slot_of);
    if (!u || !slot_of) {
        free(u);
        free(slot_of);
        return NULL;
    }
    u->slot_of = slot_of;
    return u;
}

void image_unpacked_free(struct image_unpacked *u)
{
    if (u) {
        free(u->slot_of);
        free(u);
    }
}

/* The slot used longest ago, which any free one is. */
static uint32_t oldest_slot(const struct image_unpacked *u)
{
    uint32_t oldest = 0;
    for (uint32_t i = 1; i < IMAGE_UNPACKED_TILES; i++) {
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
