#include "unpack.h"

#include <lz4.h>
#include <string.h>

enum { HEAD = 32, BLOCK_BYTES_AT = 24, SIDE = LM_TILE_POINTS };

static int post_left(int low, int high)
{
    const int folded = high * 256 + low;
    return folded % 2 ? -(folded + 1) / 2 : folded / 2;
}

bool ref_unpack(const uint8_t *record, uint32_t bytes, struct lm_tile *tile)
{
    uint8_t strips[SIDE][4][SIDE];
    const uint32_t block_bytes =
        (uint32_t)record[BLOCK_BYTES_AT] + 256u * record[BLOCK_BYTES_AT + 1];
    if (block_bytes > bytes - HEAD ||
        LZ4_decompress_safe((const char *)record + bytes - block_bytes, (char *)strips,
                            (int)block_bytes, sizeof strips) != (int)sizeof strips) {
        return false;
    }
    memset(tile, 0, sizeof *tile);
    memcpy(tile, record, HEAD);
    tile->block_bytes = 0;
    int post[SIDE] = {0};
    for (int r = 0; r < SIDE; r++) {
        int rise = 0;
        for (int c = 0; c < SIDE; c++) {
            rise += post_left(strips[r][2][c], strips[r][3][c]);
            post[c] += rise;
            tile->points[r][c].cell = (uint16_t)(strips[r][0][c] * 256 + strips[r][1][c]);
            tile->points[r][c].post = (uint16_t)post[c];
        }
    }
    return true;
}
