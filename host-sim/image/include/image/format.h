/* Format of a flash image, as far as the programs that write and check one need more than
 * lm/image.h. */
#ifndef IMAGE_FORMAT_H
#define IMAGE_FORMAT_H

#include "lm/image.h"

#include <stdint.h>

struct image_entry {
    uint32_t record; /* UINT32_MAX: the image has no such tile */
    uint32_t crc;    /* CRC-32C of entry number and record */
};

/* CRC-32C that belongs to directory entry `entry` when it holds `record`. */
uint32_t image_entry_crc(uint32_t entry, uint32_t record);

/* "CLASSES" and so on; "unknown" for a type of a later version. */
const char *image_section_name(uint32_t type);

#endif
