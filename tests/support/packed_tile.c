#include "packed_tile.h"

#include <lz4hc.h>
#include <stdlib.h>
#include <string.h>

enum { HEAD = 32, BLOCK_BYTES_AT = 24, UNIT = 64, SIDE = LM_TILE_POINTS };
enum { ENTRY = 16, SIZE_AT = 4, ENCODING_AT = 6, NO_TILE = -1 };

/* What is left of a post, 0..65535: its difference from west + south - south-west, signs folded. */
static int post_left(const struct lm_tile *t, int r, int c)
{
    const int south = r > 0 ? t->points[r - 1][c].post : 0;
    const int west = c > 0 ? t->points[r][c - 1].post : 0;
    const int south_west = r > 0 && c > 0 ? t->points[r - 1][c - 1].post : 0;
    int left = (t->points[r][c].post - (west + south - south_west)) % 65536;
    left += left < -32768 ? 65536 : left > 32767 ? -65536 : 0;
    return left < 0 ? -2 * left - 1 : 2 * left;
}

uint16_t packed_tile(const struct lm_tile *tile, uint8_t record[LM_TILE_BYTES])
{
    uint8_t strips[4 * SIDE * SIDE], *to = strips;
    for (int r = 0; r < SIDE; r++, to += 4 * SIDE) {
        for (int c = 0; c < SIDE; c++) {
            const int left = post_left(tile, r, c);
            to[c] = (uint8_t)(tile->points[r][c].cell / 256);
            to[SIDE + c] = (uint8_t)(tile->points[r][c].cell % 256);
            to[2 * SIDE + c] = (uint8_t)(left % 256);
            to[3 * SIDE + c] = (uint8_t)(left / 256);
        }
    }
    char block[LM_TILE_BYTES];
    const int bytes = LZ4_compress_HC((const char *)strips, block, sizeof strips, sizeof block, 9);
    const int units = (HEAD + bytes + UNIT - 1) / UNIT;
    if (bytes <= 0 || units >= LM_TILE_BYTES / UNIT) {
        abort();
    }
    memset(record, 0, LM_TILE_BYTES);
    memcpy(record, tile, HEAD);
    record[BLOCK_BYTES_AT] = (uint8_t)(bytes % 256);
    record[BLOCK_BYTES_AT + 1] = (uint8_t)(bytes / 256);
    memcpy(record + units * UNIT - bytes, block, (size_t)bytes);
    return (uint16_t)units;
}

void tiny_image_pack(struct tiny_image *image)
{
    uint32_t *crcs = calloc(image->entry_count, sizeof *crcs);
    if (!crcs) {
        abort();
    }
    for (uint32_t i = 0; i < image->entry_count; i++) {
        uint8_t *entry = image->bytes + image->directory_offset + (size_t)i * ENTRY;
        int32_t place;
        memcpy(&place, entry, sizeof place);
        if (place != NO_TILE) {
            struct lm_tile tile;
            uint8_t *at = image->bytes + image->tiles_offset + (size_t)place * UNIT;
            memcpy(&tile, at, sizeof tile);
            const uint16_t units = packed_tile(&tile, at);
            memcpy(entry + SIZE_AT, &units, sizeof units);
            entry[ENCODING_AT] = LM_TILE_LZ4;
            crcs[i] = tile.crc;
        }
    }
    tiny_image_seal(image);
    for (uint32_t i = 0; i < image->entry_count; i++) { /* which is that of the unpacked tile */
        int32_t place;
        memcpy(&place, image->bytes + image->directory_offset + (size_t)i * ENTRY, sizeof place);
        if (place != NO_TILE) {
            memcpy(image->bytes + image->tiles_offset + (size_t)place * UNIT, &crcs[i], 4);
        }
    }
    free(crcs);
}
