/* The header of the flash image as a C struct, for the programs that write and inspect it
 * (docs/FORMATS.md, 1.1). The records behind it are those of lm/db.h. */
#ifndef IMAGE_FORMAT_H
#define IMAGE_FORMAT_H

#include "lm/db.h"

#include <stdint.h>

enum image_section_type {
    IMAGE_CLASSES = 1,
    IMAGE_BANDS,
    IMAGE_DIRECTORY,
    IMAGE_TILES,
    IMAGE_MANIFEST, /* the last one that every image has */
    IMAGE_TARGETS,
    IMAGE_SECTION_TYPES
};

enum { IMAGE_SECTIONS_MAX = 16, IMAGE_SECTION_ALIGNMENT = 64, IMAGE_TITLE_BYTES = 32 };

struct image_section {
    uint32_t type, crc;
    uint64_t offset, bytes;
};

struct image_header {
    char magic[8];
    uint32_t version, header_bytes;
    uint64_t image_bytes;
    uint8_t shift0, level_count;
    uint16_t band_count;
    uint32_t entry_count, record_count, record_bytes;
    int32_t mean_elevation_q6, geoid_q6;
    uint32_t centre_latitude, centre_longitude;
    uint32_t section_count, reserved0;
    struct image_section sections[IMAGE_SECTIONS_MAX];
    char title[IMAGE_TITLE_BYTES];
    uint8_t reserved1[28];
    uint32_t crc;
};
_Static_assert(sizeof(struct image_header) == LM_DB_HEADER_BYTES,
               "the header must be what FORMATS.md says");

struct image_entry {
    uint32_t record; /* UINT32_MAX: the image has no such tile */
    uint32_t crc;    /* CRC-32C of entry number and record */
};

/* CRC-32C that belongs to directory entry `entry` when it holds `record`. */
uint32_t image_entry_crc(uint32_t entry, uint32_t record);

/* "CLASSES" and so on; "unknown" for a type of a later version. */
const char *image_section_name(uint32_t type);

#endif
