/* Compressed tile records, unpacked with the library of the LZ4 project and by
 * docs/FORMATS.md, 1.6: nothing is shared with the firmware's way. */
#ifndef REFERENCE_UNPACK_H
#define REFERENCE_UNPACK_H

#include "lm/db.h"

#include <stdbool.h>
#include <stdint.h>

/* Make the tile of a compressed record of `bytes` bytes, 64 or more. False if it cannot be; the
 * tile is unspecified then. */
bool ref_unpack(const uint8_t *record, uint32_t bytes, struct lm_tile *tile);

#endif
