/* Tiles of compressed records, unpacked when they are asked for. A fixed number of them is kept;
 * the one asked for longest ago gives way. */
#ifndef IMAGE_UNPACKED_H
#define IMAGE_UNPACKED_H

#include "lm/db.h"

#include <stdint.h>

/* What a reader of pictures has: more than one row of tiles of any; 36 MB. */
enum { IMAGE_UNPACKED_TILES = 2048 };

struct image_unpacked; /* opaque */

/* Room for so many tiles, 2 or more, of an image of so many directory entries, or NULL without
 * memory. 4 bytes an entry besides the tiles. image_unpacked_free takes NULL too. */
struct image_unpacked *image_unpacked_new(uint32_t entries, uint32_t tiles);
void image_unpacked_free(struct image_unpacked *u);

/* The tile of a directory entry whose stored record, of `size` units, is given. All zeros if it
 * cannot be unpacked. Valid until one less than all other tiles that there is room for have been
 * asked for. */
const struct lm_tile *image_unpacked_tile(struct image_unpacked *u, uint32_t entry,
                                          const uint8_t *record, uint16_t size);

#endif
