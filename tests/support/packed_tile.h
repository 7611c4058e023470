/* Compressed tile records for tests, made with the library's encoder and by docs/FORMATS.md, 1.6,
 * alone: nothing is shared with the database builder. Programs that use it are linked with liblz4.
 */
#ifndef PACKED_TILE_H
#define PACKED_TILE_H

#include "tiny_image.h"

/* Compress a tile into `record`. Returns the units of 64 bytes that it takes, 1..272. The tile must
 * not be so noisy that it takes more. */
uint16_t packed_tile(const struct lm_tile *tile, uint8_t record[LM_TILE_BYTES]);

/* Compress every record of an image where it lies; each leaves a gap behind it. The checksum of
 * the section TILES alone, which the firmware does not look at, is left wrong. */
void tiny_image_pack(struct tiny_image *image);

#endif
