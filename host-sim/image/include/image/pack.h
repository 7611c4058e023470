/* Tile records as they are stored: raw, or compressed where that pays (docs/FORMATS.md, 1.6). */
#ifndef IMAGE_PACK_H
#define IMAGE_PACK_H

#include "lm/db.h"

#include <stdbool.h>
#include <stdint.h>

/* How the records of an image are stored; IMAGE_COMPRESSION_QUICK is for records that are read
 * again soon: LZ4 without the search for the shortest. */
enum image_compression { IMAGE_COMPRESSION_LZ4, IMAGE_COMPRESSION_NONE, IMAGE_COMPRESSION_QUICK };
#define IMAGE_COMPRESSION_WORDS "lz4|none"

/* The encoder and its version, which decide the bytes of compressed records: "LZ4 1.9.4, level 9".
 */
const char *image_pack_encoder(void);

/* Store a tile as it is, its checksum too, in `record`. It is compressed if the result is shorter
 * than the raw record and the firmware unpacks it to the same bytes. Returns its size in units of
 * LM_DB_PLACE_BYTES: that of a raw record says that it is one. The bytes depend on the tile and on
 * image_pack_encoder() alone. Cost: 0.3 ms on a PC. */
uint16_t image_pack(const struct lm_tile *tile, enum image_compression how,
                    uint8_t record[LM_TILE_BYTES]);

/* The tile of a stored record of `size` units. False, with the tile all zeros, if it cannot be
 * unpacked; a tile of zeros fails lm_tile_check. */
bool image_unpack(const uint8_t *record, uint16_t size, struct lm_tile *tile);

#endif
