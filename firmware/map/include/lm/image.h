/* The header of the flash image as it lies there: docs/FORMATS.md, 1.1. Who writes, inspects and
 * reads an image shares it; what it points at is in lm/db.h, lm/target.h and lm/signature.h.
 * Nothing here is believed before lm_db_open has checked it. */
#ifndef LM_IMAGE_H
#define LM_IMAGE_H

#include <stdint.h>

#include "lm/db.h"

enum lm_image_section_type {
    LM_IMAGE_CLASSES = 1,
    LM_IMAGE_BANDS,
    LM_IMAGE_DIRECTORY,
    LM_IMAGE_TILES,
    LM_IMAGE_MANIFEST, /* the last one that every image has */
    LM_IMAGE_TARGETS,
    LM_IMAGE_SIGNATURES,
    LM_IMAGE_SECTION_TYPES
};

enum {
    LM_IMAGE_SECTIONS_MAX = 16,
    LM_IMAGE_SECTION_ALIGNMENT = 64,
    LM_IMAGE_TITLE_BYTES = 32,
};

struct lm_image_section {
    uint32_t type, crc;
    uint64_t offset, bytes;
};

/* Laid out so that no compiler pads it. */
struct lm_image_header {
    char magic[8];
    uint32_t version, header_bytes;
    uint64_t image_bytes;
    uint8_t shift0, lod_count;
    uint16_t band_count;
    uint32_t entry_count, record_count, record_bytes;
    int32_t mean_elevation_m_q6, geoid_m_q6;
    uint32_t centre_latitude, centre_longitude;
    uint32_t section_count, reserved0;
    struct lm_image_section sections[LM_IMAGE_SECTIONS_MAX];
    char title[LM_IMAGE_TITLE_BYTES];
    uint8_t reserved1[28];
    uint32_t crc;
};
_Static_assert(sizeof(struct lm_image_header) == LM_DB_HEADER_BYTES,
               "the header must be what FORMATS.md says");

#endif
