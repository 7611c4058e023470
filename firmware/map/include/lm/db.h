/* Database: the image in flash as the firmware reads it, and the checks before anything of it is
 * used. docs/FORMATS.md, "Flash image", describes every byte; records here have its offsets.
 *
 * Numbers are little-endian, as on every machine that the firmware is built for (checked at compile
 * time in db.c).
 *
 * The grid. Latitude and longitude are BAM. The shift of an LOD is shift0 + LOD.
 *
 * - A cell is 2^shift BAM of latitude high and 2^(shift + zone) BAM of longitude wide. The zone
 *   depends on the latitude alone (lm_db_zone).
 * - A tile is 64 x 64 cells.
 * - The tile row is (latitude + 90 degrees) >> (shift + 6), from the south pole.
 * - The tile column is longitude >> (shift + zone + 6), from Greenwich eastwards. It wraps at the
 *   antimeridian by itself.
 * - The parent of tile (LOD, row, column) is (LOD + 1, row / 2, column / 2). Borders of zones are
 *   borders of tiles in every LOD, because they are multiples of 2^26 and shift + 6 <= 26.
 *
 *          LOD 0                      LOD 1
 *        +----+----+               +---------+
 *     r+1|    |    |               |         |
 *        +----+----+  r, c even    |         |
 *     r  |    |    |  ---------->  | r/2,c/2 |
 *        +----+----+               +---------+
 *          c   c+1
 *
 * Example: open an image and find the directory entry of a tile.
 *
 *     static struct lm_db db;
 *     if (lm_db_open(&db, flash, 1000000) != LM_OK) {
 *         return;
 *     }
 *     const int64_t entry = lm_db_entry(&db, 0, row, column);      -1: not in the image
 *
 * Most users read cells and elevations through lm/scan_line.h instead. */
#ifndef LM_DB_H
#define LM_DB_H

#include <stdbool.h>
#include <stdint.h>

#include "fx/types.h"
#include "lm/class_kind.h"
#include "lm/geoid.h"
#include "lm/port.h"
#include "lm/tile_point.h"

enum {
    LM_DB_VERSION = 3,
    LM_DB_HEADER_BYTES = 1024,
    LM_DB_LODS_MAX = 16,
    LM_DB_BANDS_MAX = 128, /* seven for each LOD that goes round the Earth */
    LM_DB_SHIFT_MIN = 4,   /* a cell of 0.15 m */
    LM_DB_SHIFT_MAX = 20,  /* a cell of 9.8 km */
    LM_DB_SIXTEENTH_LOG2 =
        26, /* 1/16 of a quarter turn, BAM: borders of zones are multiples of it */
    LM_DB_CLASSES = 16,
    LM_DB_CLASS_NONE = 15,      /* no data: drawn as nothing */
    LM_TILE_POST_SHIFT_MAX = 4, /* relief in one tile: 16.4 km */
    LM_DB_PLACE_BYTES = 64,     /* unit of places and sizes in the directory */
    LM_TILE_BYTES = 17472,      /* a raw record: 273 units */
    LM_TILE_RAW = 0,            /* encoding of a record: as in the cache */
    LM_TILE_LZ4 = 1,            /* compressed: lm/tile_unpack.h */
    LM_FACINGS = 8,             /* facings of walls: struct lm_class */
    LM_TARGET_BYTES = 640,      /* a record of TARGETS: lm/target.h */
    LM_DB_TARGETS_MAX = 1024,
    LM_SIGNATURE_BYTES = 1152, /* a record of SIGNATURES: lm/signature.h */
    LM_CHIP_BYTES = 4672,      /* a chip of SIGNATURES: lm/signature.h */
    LM_DB_SIGNATURES_MAX = 16,
    LM_DB_CHIPS_MAX = LM_DB_SIGNATURES_MAX * 128 * 8
};

/* Tile record, in the cache and, where it is raw, in flash: 17,472 bytes. A compressed record has
 * the same head, with the same checksum; then zeros, and a block that ends it. */
struct lm_tile {
    uint32_t crc; /* CRC-32C of all bytes after this field */
    uint8_t lod, zone;
    uint16_t reserved0;
    uint32_t row, column; /* with lod the tile's identity: lm_tile_check refuses another tile */
    int32_t base_m_q6;    /* elevation of post 0 above mean sea level; within 2^20 */
    uint8_t post_shift;   /* one post step is 2^post_shift / 64 metres; 0..LM_TILE_POST_SHIFT_MAX */
    uint8_t reserved1;
    uint16_t under; /* cell that stands for structure cells where vector detail is drawn; height
                       code 0 */
    uint16_t block_bytes; /* of the block of a compressed record; 0 in a raw one and in the cache */
    uint8_t reserved2[6];
    /* Row 0 is the southernmost, column 0 the westernmost. Rows and columns 1..64 are the tile's
     * own, the others repeat the neighbours': lm/tile_point.h. */
    struct lm_tile_point points[LM_TILE_POINTS][LM_TILE_POINTS];
    uint8_t reserved3[16];
};
_Static_assert(sizeof(struct lm_tile) == LM_TILE_BYTES, "the record must be what FORMATS.md says");
_Static_assert(LM_TILE_BYTES % LM_DB_PLACE_BYTES == 0, "records are counted in these units");

/* Directory entry: where a tile's record and its vector detail lie. */
struct lm_tile_entry {
    uint32_t place;        /* of the record from the start of TILES; LM_TILE_ABSENT: no such tile */
    uint16_t size;         /* of the record. Places and sizes are in units of LM_DB_PLACE_BYTES */
    uint8_t encoding;      /* of the record: LM_TILE_RAW or LM_TILE_LZ4 */
    uint8_t detail_size;   /* of the detail; 0 if there is none */
    uint32_t detail_place; /* from the start of DETAIL; LM_TILE_ABSENT: none */
    uint32_t crc;          /* CRC-32C of u32 entry number and the bytes before this field */
};
_Static_assert(sizeof(struct lm_tile_entry) == 16, "the record must be what FORMATS.md says");

/* Place of what the image leaves out. */
#define LM_TILE_ABSENT UINT32_MAX

/* Band: a rectangle of tiles of one LOD in one zone, with its part of the directory. */
struct lm_band {
    uint8_t lod, zone;
    uint16_t reserved;
    uint32_t row0, rows;       /* southernmost row, and their number, 1 or more */
    uint32_t column0, columns; /* westernmost column, and their number, 1 or more; they may cross
                                  the antimeridian */
    uint32_t entry0; /* directory entry of (row0, column0); the others follow row by row */
};
_Static_assert(sizeof(struct lm_band) == 24, "the record must be what FORMATS.md says");

/* Flags of a class. */
enum {
    LM_CLASS_NATURAL = 1 /* its borders have grown: where both classes are natural, they may bend */
};

/* Class: one land cover of the image. */
struct lm_class {
    char name[16];         /* zero-padded; may fill all 16 */
    uint8_t kind;          /* enum lm_class_kind */
    uint8_t colour[3];     /* red, green, blue, for pictures on the host */
    int16_t gamma_db_q8;   /* mean reflectivity */
    uint16_t spread_db_q8; /* of the reflectivity; host tools alone use it */
    uint16_t height_dm;    /* typical height; host tools alone use it */
    uint16_t looks;        /* independent looks of a texture sample, from 1; host tools use it */
    uint8_t facing;        /* of walls: 0 none; n = 1..LM_FACINGS: (n - 1) * 11.25 degrees from
                              north, modulo 90 */
    uint8_t flags;         /* LM_CLASS_NATURAL */
    int16_t lod_gain_db_q8[LM_DB_LODS_MAX]; /* added to the reflectivity of its cells, by LOD */
    uint8_t reserved1[2];
};
_Static_assert(sizeof(struct lm_class) == 64, "the record must be what FORMATS.md says");

/* Section CLASSES: the classes, and the heights of the height codes. */
struct lm_classes {
    struct lm_class entry[LM_DB_CLASSES];
    uint16_t
        height_dm[16]; /* of the height codes 0..15; [0] is 0, and none is below the one before */
};
_Static_assert(sizeof(struct lm_classes) == 1056, "the record must be what FORMATS.md says");

/* An open image: header, class table and band table, read and checked by lm_db_open. Constant
 * afterwards. */
struct lm_db {
    const struct lm_flash *flash; /* borrowed as long as the image is in use */
    uint64_t base;                /* where the image begins in the flash, bytes */
    uint8_t lod_count, shift0;    /* LODs are 0..lod_count - 1, finest to coarsest */
    uint8_t finest; /* LOD that pictures of this place begin with: 0, but see lm/images.h */
    uint16_t band_count;
    uint32_t entry_count, record_count;   /* directory entries; tile records */
    uint32_t tiles_size, detail_size;     /* of TILES and DETAIL, in units of LM_DB_PLACE_BYTES */
    uint32_t target_count;                /* 0 if the image has no section TARGETS */
    uint32_t signature_count, chip_count; /* 0 if the image has no section SIGNATURES */
    /* Places in the flash, in bytes: of the first directory entry, tile, target, ... */
    uint64_t directory_offset, records_offset, detail_offset, targets_offset;
    uint64_t signatures_offset, chips_offset, radar_offset, bus_offset;
    uint32_t radar_bytes; /* of the radar table's record; 0 if the image has no section RADAR */
    uint32_t radar_crc;   /* of it, as the header says */
    uint32_t bus_bytes;   /* of the bus table's record; 0 if the image has no section BUS */
    uint8_t sensor;       /* enum lm_sensor: band of the reflectivity */
    int32_t mean_elevation_m_q6; /* of the land in the image; within 2^20 */
    int32_t geoid_m_q6; /* mean sea level above the ellipsoid, in the image's area; within 2^20 */
    struct lm_geoid geoid;             /* the same at each place; rows 0: geoid_m_q6 everywhere */
    struct lm_geoid_pages geoid_pages; /* of finer grids; rows 0: the image has none */
    fx_bam_t centre_latitude, centre_longitude;
    char title[33]; /* the builder's; ends in a zero byte */
    struct lm_classes classes;
    struct lm_band bands[LM_DB_BANDS_MAX];
};

/* Head of the section TARGETS. target_count records (lm/target.h) follow it. */
struct lm_targets_head {
    uint32_t count, record_bytes;
    uint8_t reserved[52];
    uint32_t crc; /* CRC-32C of the bytes before it */
};
_Static_assert(sizeof(struct lm_targets_head) == 64, "the record must be what FORMATS.md says");

/* Head of the section SIGNATURES. signature_count records, then chip_count chips (lm/signature.h)
 * follow it. */
struct lm_signatures_head {
    uint32_t count, record_bytes, chip_count, chip_bytes;
    uint8_t reserved[44];
    uint32_t crc; /* CRC-32C of the bytes before it */
};
_Static_assert(sizeof(struct lm_signatures_head) == 64, "the record must be what FORMATS.md says");

/* Read `length` bytes of the flash and wait for them. For start-up only: no other read may be under
 * way. `destination` is borrowed for the call.
 *
 * Returns LM_OK, or LM_ERR_IO with the bytes at `destination` unspecified if
 * - the flash refuses the read, also because it reaches past the end,
 * - the read fails,
 * - it is not done after `poll_limit` polls. It is then still under way. */
int lm_db_read(const struct lm_flash *flash, uint64_t offset, void *destination, uint32_t length,
               uint32_t poll_limit);

/* Open an image: read and check its header, class table, band table and the heads of targets and
 * signatures. For start-up only, like lm_db_read.
 *
 * Returns LM_OK. Every offset and count in *db has then been checked against the size of the flash.
 * Tiles, targets, signatures and the tables of radar and bus are checked when they are read. It
 * fails, with *db unspecified:
 * - LM_ERR_IO: a read failed or took more than `poll_limit` polls.
 * - LM_ERR_CORRUPT: a checksum, a number out of its range, or a section that is missing or does not
 *   lie inside the image.
 * - LM_ERR_VERSION: the image has another version than LM_DB_VERSION, or needs what this firmware
 *   does not have (`top` or `sensor` of struct lm_image_header).
 *
 * `db` keeps `flash`. Cost: some reads of the flash, and 1 KiB of stack for the header. */
int lm_db_open(struct lm_db *db, const struct lm_flash *flash, uint32_t poll_limit);

/* The same of an image in a part of the flash. No offset or size in *db then reaches outside it. */
int lm_db_open_part(struct lm_db *db, const struct lm_flash *flash,
                    const struct lm_flash_part *part, uint32_t poll_limit);

/* Zone of a latitude, 0..3: cells are 2^zone wider in longitude. Borders are at 61.875, 73.125 and
 * 84.375 degrees, north and south: 11, 13 and 15 sixteenths of a quarter turn. */
static inline uint32_t lm_db_zone(fx_bam_t latitude)
{
    /* Two bits for each sixteenth from pole to pole. The north pole itself lies behind the last one
     * and takes the first, which is the same. */
    const uint64_t zone_of_sixteenth = 0xE94000000000016B;
    const uint32_t sixteenth = (latitude + FX_BAM_90) >> LM_DB_SIXTEENTH_LOG2;
    return (uint32_t)(zone_of_sixteenth >> (2 * sixteenth & 63)) & 3;
}

/* Directory entry of a tile, or -1 if no band holds it. Every number is allowed. Cost: one pass
 * over the bands. */
int64_t lm_db_entry(const struct lm_db *db, uint8_t lod, uint32_t row, uint32_t column);

/* Place of a directory entry in the flash, bytes. */
static inline uint64_t lm_db_entry_offset(const struct lm_db *db, uint32_t entry)
{
    return db->directory_offset + sizeof(struct lm_tile_entry) * (uint64_t)entry;
}

/* Check directory entry number `number` that was read from flash. Returns
 * - LM_OK: the tile is absent, or its record and its detail lie inside TILES and DETAIL.
 * - LM_ERR_CORRUPT: the checksum does not match this entry, a place or size reaches outside its
 *   section, a raw record has not LM_TILE_BYTES, or a compressed one is empty or no shorter.
 * - LM_ERR_VERSION: the record has an encoding that this firmware does not know. */
int lm_db_entry_check(const struct lm_db *db, uint32_t number, const struct lm_tile_entry *entry);

/* Place in the flash, bytes, of the record of an entry that has passed lm_db_entry_check. */
static inline uint64_t lm_db_tile_offset(const struct lm_db *db, const struct lm_tile_entry *entry)
{
    return db->records_offset + (uint64_t)LM_DB_PLACE_BYTES * entry->place;
}

/* The tile's own south-west point, from which readers count (lm/kernels_map.h). */
static inline const struct lm_tile_point *lm_tile_origin(const struct lm_tile *tile)
{
    return &tile->points[LM_TILE_BORDER][LM_TILE_BORDER];
}

/* Check a tile record that was read from flash, and unpacked if it was compressed. Returns LM_OK,
 * or LM_ERR_CORRUPT if
 * - its checksum does not match,
 * - it is another tile than (lod, row, column),
 * - its base or post_shift is out of range, or `under` has a height.
 *
 * Cost: one CRC over 17 kB. */
int lm_tile_check(const struct lm_tile *tile, uint8_t lod, uint32_t row, uint32_t column);

/* Height of a cell of an LOD along the meridian, in millimetres: 2^shift * 9.31506 mm. */
uint32_t lm_db_cell_mm(const struct lm_db *db, uint8_t lod);

#endif
