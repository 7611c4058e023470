#include "image/pack.h"

#include "lm/tile_unpack.h"

#include <lz4.h>
#include <lz4hc.h>
#include <stdio.h>
#include <string.h>

/* Higher levels save 0.4 % and take more than twice the time. */
enum { LEVEL = LZ4HC_CLEVEL_DEFAULT, HEAD_BYTES = offsetof(struct lm_tile, points) };
enum { RAW_SIZE = LM_TILE_BYTES / LM_DB_PLACE_BYTES };

const char *image_pack_encoder(void)
{
    static char text[64];
    snprintf(text, sizeof text, "LZ4 %s, level %d", LZ4_versionString(), LEVEL);
    return text;
}

/* Signs into bit 0: 0, -1, 1, -2 ... become 0, 1, 2, 3 ... */
static uint16_t fold(uint16_t difference)
{
    const bool is_negative = difference & 0x8000;
    return (uint16_t)(is_negative ? ~(difference << 1) : difference << 1);
}

/* The rows of a tile as strips: reflectivity, class and height, what is left of the posts. */
static void make_strips(const struct lm_tile *tile,
                        uint8_t strips[LM_TILE_POINTS][4][LM_TILE_POINTS])
{
    for (int r = 0; r < LM_TILE_POINTS; r++) {
        uint16_t rise_before = 0;
        for (int c = 0; c < LM_TILE_POINTS; c++) {
            const struct lm_tile_point p = tile->points[r][c];
            const uint16_t rise = (uint16_t)(p.post - (r > 0 ? tile->points[r - 1][c].post : 0));
            const uint16_t left = fold((uint16_t)(rise - rise_before));
            strips[r][0][c] = (uint8_t)(p.cell >> 8);
            strips[r][1][c] = (uint8_t)p.cell;
            strips[r][2][c] = (uint8_t)left;
            strips[r][3][c] = (uint8_t)(left >> 8);
            rise_before = rise;
        }
    }
}

/* Returns the units of the compressed record, 0 if it would not be shorter than the raw one. */
static uint16_t compress_tile(const struct lm_tile *tile, enum image_compression how,
                              uint8_t record[LM_TILE_BYTES])
{
    enum { ROOM = LM_TILE_BYTES - LM_DB_PLACE_BYTES - HEAD_BYTES };
    uint8_t strips[LM_TILE_POINTS][4][LM_TILE_POINTS];
    char block[ROOM];
    make_strips(tile, strips);
    const char *const from = (const char *)strips;
    const int bytes = how == IMAGE_COMPRESSION_QUICK
                          ? LZ4_compress_default(from, block, sizeof strips, sizeof block)
                          : LZ4_compress_HC(from, block, sizeof strips, sizeof block, LEVEL);
    if (bytes <= 0) {
        return 0;
    }
    struct lm_tile head = *tile;
    head.block_bytes = (uint16_t)bytes;
    const int size = (HEAD_BYTES + bytes + LM_DB_PLACE_BYTES - 1) / LM_DB_PLACE_BYTES;
    memset(record, 0, LM_TILE_BYTES);
    memcpy(record, &head, HEAD_BYTES);
    memcpy(record + size * LM_DB_PLACE_BYTES - bytes, block, (size_t)bytes);
    return (uint16_t)size;
}

uint16_t image_pack(const struct lm_tile *tile, enum image_compression how,
                    uint8_t record[LM_TILE_BYTES])
{
    if (how != IMAGE_COMPRESSION_NONE) {
        struct lm_tile unpacked;
        const uint16_t size = compress_tile(tile, how, record);
        if (size > 0 && image_unpack(record, size, &unpacked) &&
            memcmp(&unpacked, tile, sizeof unpacked) == 0) {
            return size;
        }
    }
    memcpy(record, tile, LM_TILE_BYTES);
    return RAW_SIZE;
}

bool image_unpack(const uint8_t *record, uint16_t size, struct lm_tile *tile)
{
    memcpy(lm_tile_unpack_place(tile, size), record, (size_t)size * LM_DB_PLACE_BYTES);
    if (size == RAW_SIZE) {
        return true;
    }
    struct lm_tile_unpack unpack;
    int status = lm_tile_unpack_begin(&unpack, tile, size);
    while (status == LM_BUSY) {
        status = lm_tile_unpack_run(&unpack);
    }
    if (status != LM_OK) {
        memset(tile, 0, sizeof *tile);
    }
    return status == LM_OK;
}
