/* The database image in flash: its parts as the firmware sees them, and what is checked before any
 * is believed. docs/FORMATS.md, "Flash image", is the description of every byte; the offsets here
 * are the same ones.
 *
 * Numbers are little-endian, as on every machine the firmware is built for (checked at compile time
 * in db.c).
 *
 * The grid. Latitude and longitude are binary angles (2^32 = 360 degrees). A cell of level L is
 * 2^(shift0 + L) units of latitude high; in longitude it is wider by 2^zone, where the zone depends
 * on latitude only (lm_db_zone). A tile is 64 x 64 cells; tile row = (latitude + 90 degrees) >>
 * (shift + 6) counts from the south pole, tile column = longitude >> (shift + zone + 6) from
 * Greenwich eastward and wraps at the antimeridian by itself. The parent of a tile is (level + 1,
 * row / 2, column / 2): zone borders fall on tile borders at every level because they are multiples
 * of 2^26 and shift + 6 <= 26. */
#ifndef LM_DB_H
#define LM_DB_H

#include <stdbool.h>
#include <stdint.h>

#include "fx/types.h"
#include "lm/class_kind.h"
#include "lm/port.h"
#include "lm/tile_point.h"

enum {
    LM_DB_VERSION = 2,
    LM_DB_HEADER_BYTES = 512,
    LM_DB_LODS_MAX = 12,
    LM_DB_BANDS_MAX = 64,
    LM_DB_SHIFT_MIN = 4,       /* a level-0 cell of 0.15 m */
    LM_DB_SHIFT_MAX = 20,      /* a cell of the coarsest level: 9.8 km */
    LM_DB_SIXTEENTH_LOG2 = 26, /* of a quarter turn, BAM: where zones may begin */
    LM_DB_CLASSES = 16,
    LM_DB_CLASS_NONE = 15,      /* no data: drawn as nothing */
    LM_TILE_POST_SHIFT_MAX = 4, /* relief in one tile: 16.4 km */
    LM_TILE_BYTES = 16960,
    LM_TARGET_BYTES = 640, /* a record of TARGETS: lm/target.h */
    LM_DB_TARGETS_MAX = 1024,
    LM_SIGNATURE_BYTES = 1152, /* a record of SIGNATURES, and a chip of it: lm/signature.h */
    LM_CHIP_BYTES = 4672,
    LM_DB_SIGNATURES_MAX = 16,
    LM_DB_CHIPS_MAX = LM_DB_SIGNATURES_MAX * 128 * 8
};

/* A tile record, in flash and in the cache alike. 16,960 bytes. */
struct lm_tile {
    uint32_t crc; /* CRC-32C of all bytes after this field */
    uint8_t lod, zone;
    uint16_t reserved0;
    uint32_t row,
        column; /* the record says which tile it is; an answer to another question is refused */
    int32_t base_m_q6;  /* elevation of post code 0, metres * 64 */
    uint8_t post_shift; /* one post step is 2^post_shift / 64 metres; 0..4 */
    uint8_t reserved1[11];
    /* Row 0 is the southernmost, column 0 the westernmost. Row and column 64 have no cells of their
     * own, but the posts of the neighbours' row and column 0. */
    struct lm_tile_point points[LM_TILE_POSTS][LM_TILE_POSTS];
    uint8_t reserved2[28];
};
_Static_assert(sizeof(struct lm_tile) == LM_TILE_BYTES, "the record must be what FORMATS.md says");

/* A rectangle of tiles of one level in one latitude zone, with its run of directory entries. */
struct lm_band {
    uint8_t lod, zone;
    uint16_t reserved;
    uint32_t row0, rows;       /* rows >= 1 */
    uint32_t column0, columns; /* columns >= 1; column0 + columns may pass the antimeridian */
    uint32_t entry0;           /* directory entry of (row0, column0); row by row from there */
};
_Static_assert(sizeof(struct lm_band) == 24, "the record must be what FORMATS.md says");

struct lm_class {
    char name[16];       /* zero-padded; may fill all 16 */
    uint8_t kind;        /* enum lm_class_kind */
    uint8_t colour[3];   /* for host pictures */
    int16_t gamma_db_q8; /* mean reflectivity, dB * 256 */
    uint16_t spread_db_q8;
    uint16_t height_dm;
    uint16_t looks;
    uint8_t reserved[36];
};
_Static_assert(sizeof(struct lm_class) == 64, "the record must be what FORMATS.md says");

struct lm_classes {
    struct lm_class entry[LM_DB_CLASSES];
    uint16_t height_dm[16]; /* what the height codes mean; [0] is 0 */
};
_Static_assert(sizeof(struct lm_classes) == 1056, "the record must be what FORMATS.md says");

/* The image after its header, class table and band table were read and checked. */
struct lm_db {
    const struct lm_flash *flash; /* borrowed */
    uint8_t lod_count, shift0;
    uint16_t band_count;
    uint32_t entry_count, record_count;
    uint32_t target_count;                /* 0 when the image has no section TARGETS */
    uint32_t signature_count, chip_count; /* 0 when it has no section SIGNATURES */
    uint64_t directory_offset, records_offset, targets_offset; /* of the first record each */
    uint64_t signatures_offset, chips_offset;
    int32_t mean_elevation_m_q6; /* of the land in the image, metres * 64 */
    int32_t geoid_m_q6; /* height of mean sea level above the ellipsoid here, metres * 64 */
    fx_bam_t centre_latitude, centre_longitude;
    char title[33]; /* as the builder named it; ends in a zero */
    struct lm_classes classes;
    struct lm_band bands[LM_DB_BANDS_MAX];
};

/* Head of the section TARGETS; target_count records (lm/target.h) follow it. */
struct lm_targets_head {
    uint32_t count, record_bytes;
    uint8_t reserved[52];
    uint32_t crc; /* CRC-32C of the bytes before it */
};
_Static_assert(sizeof(struct lm_targets_head) == 64, "the record must be what FORMATS.md says");

/* Head of the section SIGNATURES; signature_count records and chip_count chips (lm/signature.h)
 * follow it. */
struct lm_signatures_head {
    uint32_t count, record_bytes, chip_count, chip_bytes;
    uint8_t reserved[44];
    uint32_t crc; /* CRC-32C of the bytes before it */
};
_Static_assert(sizeof(struct lm_signatures_head) == 64, "the record must be what FORMATS.md says");

/* Read from the flash and wait for it, polling at most `poll_limit` times: for start-up, when no
 * other read is under way. LM_OK, or LM_ERR_IO with *destination unspecified. */
int lm_db_read(const struct lm_flash *flash, uint64_t offset, void *destination, uint32_t length,
               uint32_t poll_limit);

/* Read and check header, class table, band table and the heads of targets and signatures. Polls
 * each read at most `poll_limit` times. LM_OK, or LM_ERR_IO, LM_ERR_CORRUPT, LM_ERR_VERSION with
 * *db unspecified. After LM_OK every offset and count in *db has been checked against the size of
 * the flash. */
int lm_db_open(struct lm_db *db, const struct lm_flash *flash, uint32_t poll_limit);

/* Zone of a latitude, 0..3: cells are 2^zone wider in longitude. Borders at 61.875, 73.125
 * and 84.375 degrees (11, 13 and 15 sixteenths of a quarter turn), symmetric about the equator. */
static inline uint32_t lm_db_zone(fx_bam_t latitude)
{
    /* Two bits for each sixteenth from pole to pole; the north pole itself, behind the last one, is
     * answered by the first. */
    const uint64_t zone_of_sixteenth = 0xE94000000000016B;
    const uint32_t sixteenth = (latitude + FX_BAM_90) >> LM_DB_SIXTEENTH_LOG2;
    return (uint32_t)(zone_of_sixteenth >> (2 * sixteenth & 63)) & 3;
}

/* Directory entry of a tile, or -1 when no band holds it. Cost: one pass over the level's bands. */
int64_t lm_db_entry(const struct lm_db *db, uint8_t lod, uint32_t row, uint32_t column);

/* Check 8 bytes read from the directory against the entry they should be. LM_OK and *record
 * (UINT32_MAX for a tile that the image leaves out); LM_ERR_CORRUPT when the checksum or the bound
 * does not hold. */
int lm_db_entry_check(const struct lm_db *db, uint32_t entry, const uint8_t bytes[8],
                      uint32_t *record);

/* Check a record read from flash: checksum, identity, bounds. LM_OK or LM_ERR_CORRUPT.
 * Cost: one CRC over 17 kB. */
int lm_tile_check(const struct lm_tile *tile, uint8_t lod, uint32_t row, uint32_t column);

/* Cell height of a level in millimetres along the meridian (2^shift * 9.31506 mm). */
uint32_t lm_db_cell_mm(const struct lm_db *db, uint8_t lod);

#endif
