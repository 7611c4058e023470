/* Format of a flash image, as far as the programs that write and check one need more than
 * lm/image.h. */
#ifndef IMAGE_FORMAT_H
#define IMAGE_FORMAT_H

#include "lm/image.h"

#include <stdint.h>

/* What every program says of an image of another version. */
#define IMAGE_OTHER_VERSION_REMEDY                                                                 \
    "`landmass-db convert OLD NEW` makes an image of this version from one of version 2"

/* CRC-32C that belongs to a directory entry as number `number`. */
uint32_t image_entry_crc(uint32_t number, const struct lm_tile_entry *entry);

/* "CLASSES" and so on; "unknown" for a type of a later version. */
const char *image_section_name(uint32_t type);

#endif
