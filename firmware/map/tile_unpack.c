#include "lm/tile_unpack.h"

#include <stddef.h>

#include "fx/mem.h"
#include "lm/kernels_map.h"

enum { HEAD_BYTES = offsetof(struct lm_tile, points) };
_Static_assert(LM_TILE_POINTS % LM_TILE_UNPACK_ROWS == 0, "all parts are as long");

int lm_tile_unpack_begin(struct lm_tile_unpack *u, struct lm_tile *tile, uint16_t size)
{
    *u = (struct lm_tile_unpack){.tile = tile};
    /* A stored record is at least one unit shorter than a raw one: its head lies behind the
     * tile's. */
    memcpy(tile, lm_tile_unpack_place(tile, size), HEAD_BYTES);
    const uint32_t block_bytes = tile->block_bytes;
    if (block_bytes > (uint32_t)LM_DB_PLACE_BYTES * size - HEAD_BYTES) {
        return LM_ERR_CORRUPT;
    }
    tile->block_bytes = 0;
    lm_lz4_begin(&u->lz4, (uint8_t *)tile->points, sizeof tile->points,
                 LM_TILE_BYTES - HEAD_BYTES - block_bytes, block_bytes);
    return LM_BUSY;
}

/* Make the points of a row where its strips stand; row 0 rises from 0. */
static void put_right(struct lm_tile *tile, uint32_t row)
{
    static const struct lm_tile_point below[LM_TILE_POINTS];
    struct lm_k_strips strips;
    _Static_assert(sizeof strips == sizeof tile->points[0], "a row stays in its place");
    memcpy(&strips, tile->points[row], sizeof strips);
    lm_k_tile_row(tile->points[row], row > 0 ? tile->points[row - 1] : below, &strips);
}

int lm_tile_unpack_run(struct lm_tile_unpack *u)
{
    if (!u->is_decoded) {
        const int status = lm_lz4_run(&u->lz4, LM_TILE_UNPACK_SEQUENCES);
        u->is_decoded = status == LM_OK;
        return u->is_decoded ? LM_BUSY : status;
    }
    for (uint32_t i = 0; i < LM_TILE_UNPACK_ROWS; i++) {
        put_right(u->tile, u->row++);
    }
    if (u->row < LM_TILE_POINTS) {
        return LM_BUSY;
    }
    memset(u->tile->reserved3, 0, sizeof u->tile->reserved3);
    return LM_OK;
}
