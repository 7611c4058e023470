/* Reader of a flash image. It trusts no byte of the file. */
#ifndef IMAGE_READER_H
#define IMAGE_READER_H

#include "image/findings.h"
#include "image/format.h"
#include "image/unpacked.h"
#include "lm/bus_profile.h"
#include "lm/db.h"
#include "lm/radar.h"
#include "lm/signature.h"
#include "lm/target.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct image {
    const uint8_t *bytes; /* the whole file, mapped, or lent by the caller */
    uint64_t size_bytes;
    int is_mapped;
    struct lm_image_header header;
    struct lm_db db; /* as the firmware holds it, without a flash */
    const struct lm_image_section
        *sections[LM_IMAGE_SECTION_TYPES];   /* in `header`; by type, [0] unused; NULL: not there */
    bool has_radar;                          /* a section RADAR, whose table is sound */
    struct lm_radar radar;                   /* that table */
    char bus_name[LM_BUS_PROFILE_NAME_SIZE]; /* of the table in section BUS; empty: none, or bad */
    const struct lm_tile_entry *entries;
    struct image_unpacked *unpacked; /* owned; NULL for an image without compressed records */
    /* db.target_count, signature_count and chip_count of them, their contents not yet checked */
    const struct lm_target *targets;
    const struct lm_signature *signatures;
    const struct lm_chip *chips;
};

/* Map a file. Returns 0, or -1 with the error reported: it cannot be read or
 * mapped, is no ordinary file, or is empty. image_close unmaps it. */
int image_map(struct image *image, const char *path);

/* Use bytes in memory, aligned to 8, that stay the caller's. */
void image_lend(struct image *image, const void *bytes, size_t size_bytes);

/* Check header, section table, class table and bands, noting what is wrong. Returns 0 when the rest
 * can be read: all pointers are set and every section, band and entry number lies inside the image.
 * -1 otherwise. */
int image_read_tables(struct image *image, struct image_findings *findings);

/* image_map and image_read_tables for programs that only want to look: 0, or -1 with the error
 * reported. */
int image_open(struct image *image, const char *path);

/* Unmap the file. What the pointers led to is gone; a lent image stays the caller's. */
void image_close(struct image *image);

/* The tile of a directory entry, its bounds checked as lm_db_entry_check does and nothing else;
 * NULL when the image has no such tile or the entry is damaged. That of a raw record is valid until
 * the image is closed, that of a compressed one until IMAGE_UNPACKED_TILES - 1 others have been
 * asked for. One that cannot be unpacked is all zeros, which no check of a tile passes. One thread
 * at a time may ask. */
const struct lm_tile *image_entry_tile(const struct image *image, uint32_t entry);

/* The same tile as a copy, which any thread may ask for. False when there is none. */
bool image_copy_tile(const struct image *image, uint32_t entry, struct lm_tile *tile);

/* What image_entry_tile gives of the tile at a place of the grid. */
const struct lm_tile *image_find_tile(const struct image *image, uint8_t level, uint32_t row,
                                      uint32_t column);

/* Offset in the image of the record of an entry that has one. */
uint64_t image_record_offset(const struct image *image, uint32_t entry);

/* Sort entry numbers by where their records lie. */
void image_sort_by_place(const struct image *image, uint32_t *entries, uint32_t count);

/* Does a band hold this tile, and which zone is it in? Returns the band or NULL. */
const struct lm_band *image_band(const struct image *image, uint8_t level, uint32_t row);

#endif
