/* Image header: the first 1024 bytes of the flash image. Format: docs/FORMATS.md, 1.1.
 *
 *     0               1024
 *     +----------------+---------+------- ------+---------+
 *     | header         | section |     ...      | section |     sections lie in any order, at
 *     +----------------+---------+------- ------+---------+     multiples of 64 bytes
 *       sections[] --------^
 *
 * Tools that write or inspect an image share it with the firmware. Records of the sections are in
 * lm/db.h, lm/target.h and lm/signature.h. The firmware uses none of these numbers before
 * lm_db_open has checked them. */
#ifndef LM_IMAGE_H
#define LM_IMAGE_H

#include <stdint.h>

#include "lm/db.h"

/* Types of sections. */
enum lm_image_section_type {
    LM_IMAGE_CLASSES = 1,
    LM_IMAGE_BANDS,
    LM_IMAGE_DIRECTORY,
    LM_IMAGE_TILES,
    LM_IMAGE_MANIFEST,    /* the last one that every image must have */
    LM_IMAGE_TARGETS,     /* optional */
    LM_IMAGE_SIGNATURES,  /* optional, as all that follow */
    LM_IMAGE_GEOID,       /* grid of heights of mean sea level */
    LM_IMAGE_DETAIL,      /* vector detail of tiles */
    LM_IMAGE_RADAR,       /* radar table: lm/radar_record.h */
    LM_IMAGE_SEAL,        /* cryptographic signature */
    LM_IMAGE_BUS,         /* bus table: lm/bus_record.h */
    LM_IMAGE_GEOID_PAGES, /* finer grids of them */
    LM_IMAGE_SECTION_TYPES
};

enum {
    LM_IMAGE_SECTIONS_MAX = 32,
    LM_IMAGE_SECTION_ALIGNMENT = 64, /* bytes */
    LM_IMAGE_TITLE_BYTES = 32,
    LM_IMAGE_TOP_PLAIN = 0, /* the coarsest LOD is found like every other */
};

/* Place of a section. */
struct lm_image_section {
    uint32_t type, crc;     /* enum lm_image_section_type; CRC-32C of its bytes */
    uint64_t offset, bytes; /* from the start of the image */
};

/* Image header. Members are in an order that needs no padding. */
struct lm_image_header {
    char magic[8];                  /* "LANDMASS" */
    uint32_t version, header_bytes; /* LM_DB_VERSION, LM_DB_HEADER_BYTES */
    uint64_t image_bytes;           /* of the whole image */
    uint8_t shift0, lod_count;      /* the grid: lm/db.h */
    uint16_t band_count;
    uint32_t entry_count, record_count, record_bytes; /* record_bytes is LM_TILE_BYTES */
    int32_t mean_elevation_m_q6, geoid_m_q6;          /* as in struct lm_db */
    uint32_t centre_latitude, centre_longitude;       /* BAM */
    uint32_t section_count;                           /* 0..LM_IMAGE_SECTIONS_MAX */
    uint8_t top;                                      /* LM_IMAGE_TOP_PLAIN */
    uint8_t sensor;                                   /* enum lm_sensor: of the reflectivity */
    uint8_t reserved0[2];
    struct lm_image_section sections[LM_IMAGE_SECTIONS_MAX];
    char title[LM_IMAGE_TITLE_BYTES]; /* zero-padded; may fill all 32 */
    uint8_t reserved1[156];
    uint32_t crc; /* CRC-32C of all bytes before it */
};
_Static_assert(sizeof(struct lm_image_header) == LM_DB_HEADER_BYTES,
               "the header must be what FORMATS.md says");

#endif
