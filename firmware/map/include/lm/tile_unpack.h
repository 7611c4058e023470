/* Compressed tile records: from flash to the tile, in the tile's own memory.
 *
 * A stored record is read into the end of the memory that its tile will fill. There it is decoded,
 * in parts, so that no step does the work of a whole tile:
 *
 *     tile                                                    tile + LM_TILE_BYTES
 *     +------+----------------------+------+--------+----------+
 *     | head | points, as decoded   | free | head   | block    |     read
 *     +------+----------------------+------+--------+----------+
 *        ^                                     |
 *        +----------- begin copies it ---------+
 *
 * The block is one of LZ4 (lm/lz4.h). It decodes to the 66 rows of the tile, each as four strips of
 * 66 bytes: reflectivity codes, class and height codes, and the lower and the upper bytes of what
 * is left of the posts (docs/FORMATS.md, 1.6). A row takes as many bytes so as it does as points,
 * and is put right in its place.
 *
 * Nothing here judges the tile: call lm_tile_check when it is whole.
 *
 * Example:
 *
 *     read(offset, lm_tile_unpack_place(tile, entry.size), LM_DB_PLACE_BYTES * entry.size);
 *     int status = lm_tile_unpack_begin(&unpack, tile, entry.size);
 *     while (status == LM_BUSY) {
 *         status = lm_tile_unpack_run(&unpack);
 *     } */
#ifndef LM_TILE_UNPACK_H
#define LM_TILE_UNPACK_H

#include <stdbool.h>
#include <stdint.h>

#include "lm/db.h"
#include "lm/lz4.h"

/* Work of one part: sequences of the block, or rows put right. A record has up to 4,357 sequences
 * and 66 rows, hence up to 131 parts; one of the built-in scene has 22 and 22 parts on average.
 * Cost on the A53: about 3,600 and 2,600 instructions a part (docs/zcu102.md). */
enum { LM_TILE_UNPACK_SEQUENCES = 40, LM_TILE_UNPACK_ROWS = 3 };

/* Record being unpacked. All members are private. */
struct lm_tile_unpack {
    struct lm_tile *tile; /* borrowed from begin to end */
    struct lm_lz4 lz4;
    uint32_t row; /* the next one to be put right */
    bool is_decoded;
};

/* Where in a tile's memory its record is read to; `size` is that of the directory entry, which has
 * passed lm_db_entry_check. A raw record fills the tile. */
static inline void *lm_tile_unpack_place(struct lm_tile *tile, uint16_t size)
{
    return (uint8_t *)tile + LM_TILE_BYTES - (uint32_t)LM_DB_PLACE_BYTES * size;
}

/* Start to unpack the compressed record that was read to lm_tile_unpack_place; `size` is below that
 * of a raw record. Returns LM_BUSY: go on with lm_tile_unpack_run; or LM_ERR_CORRUPT: the block is
 * longer than the record. */
int lm_tile_unpack_begin(struct lm_tile_unpack *u, struct lm_tile *tile, uint16_t size);

/* Do one part. Returns LM_BUSY: call again; LM_OK: the tile has the bytes of its raw record;
 * LM_ERR_CORRUPT: the block decodes to no tile. The tile is unspecified before LM_OK. */
int lm_tile_unpack_run(struct lm_tile_unpack *u);

#endif
