#include "slots/check.h"

#include "fx/crc32c.h"
#include "lm/image.h"
#include "lm/tile_unpack.h"

#include <inttypes.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { PIECE_BYTES = 1 << 20, ENTRIES = 4096, POLLS = 1000000 };

struct check {
    const struct lm_flash *flash;
    struct lm_db db;
    struct lm_image_header header;
    enum slot_depth depth;
    slot_progress *progress;
    void *ctx;
    uint64_t done_bytes, total_bytes;
    struct slot_fault *fault;
    struct lm_tile tile;
    struct lm_tile_entry entries[ENTRIES];
    uint8_t piece[PIECE_BYTES];
};

static int refuse(struct check *c, uint64_t offset, const char *cause, ...)
    __attribute__((format(printf, 3, 4)));

static int refuse(struct check *c, uint64_t offset, const char *cause, ...)
{
    va_list arguments;
    va_start(arguments, cause);
    c->fault->offset = offset;
    vsnprintf(c->fault->cause, sizeof c->fault->cause, cause, arguments);
    va_end(arguments);
    return -1;
}

static void advance(struct check *c, uint64_t bytes)
{
    c->done_bytes += bytes;
    if (c->progress) {
        c->progress(c->ctx, c->done_bytes, c->total_bytes);
    }
}

/* How often a section is read. */
static uint64_t passes(const struct check *c, uint32_t type)
{
    const bool is_large = type == LM_IMAGE_TILES || type == LM_IMAGE_DETAIL;
    return is_large && c->depth != SLOT_RECORDS ? 0 : type == LM_IMAGE_TILES ? 2 : 1;
}

static int open_tables(struct check *c)
{
    switch (lm_db_open(&c->db, c->flash, POLLS)) {
    case LM_OK:
        break;
    case LM_ERR_VERSION:
        return refuse(c, 0, "an image of another version");
    case LM_ERR_IO:
        return refuse(c, 0, "header or tables cannot be read");
    default:
        return refuse(c, 0, "header or tables are damaged, or it is no database image");
    }
    if (lm_db_read(c->flash, 0, &c->header, sizeof c->header, POLLS) != LM_OK) {
        return refuse(c, 0, "the header cannot be read");
    }
    for (uint32_t i = 0; i < c->header.section_count; i++) {
        c->total_bytes += passes(c, c->header.sections[i].type) * c->header.sections[i].bytes;
    }
    return 0;
}

/* lm_db_open has not looked at the place of those that it does not use. */
static int check_section(struct check *c, const struct lm_image_section *s)
{
    uint32_t crc = 0;
    if (s->bytes > c->header.image_bytes || s->offset > c->header.image_bytes - s->bytes) {
        return refuse(c, s->offset, "section %" PRIu32 " lies outside the image", s->type);
    }
    for (uint64_t at = 0; at < s->bytes;) {
        const uint64_t left = s->bytes - at;
        const uint32_t length = left < PIECE_BYTES ? (uint32_t)left : PIECE_BYTES;
        if (lm_db_read(c->flash, s->offset + at, c->piece, length, POLLS) != LM_OK) {
            return refuse(c, s->offset + at, "cannot be read");
        }
        crc = fx_crc32c(crc, c->piece, length);
        at += length;
        advance(c, length);
    }
    return crc == s->crc
               ? 0
               : refuse(c, s->offset, "the checksum of section %" PRIu32 " does not fit", s->type);
}

static int unpack(struct check *c, const struct lm_tile_entry *entry)
{
    struct lm_tile_unpack work;
    int status = lm_tile_unpack_begin(&work, &c->tile, entry->size);
    while (status == LM_BUSY) {
        status = lm_tile_unpack_run(&work);
    }
    return status;
}

static int check_record(struct check *c, uint32_t number, const struct lm_tile_entry *entry,
                        uint8_t lod, uint32_t row, uint32_t column)
{
    const uint64_t at = lm_db_tile_offset(&c->db, entry);
    const uint32_t bytes = (uint32_t)LM_DB_PLACE_BYTES * entry->size;
    void *to = lm_tile_unpack_place(&c->tile, entry->size);
    if (lm_db_read(c->flash, at, to, bytes, POLLS) != LM_OK) {
        return refuse(c, at, "the record of entry %" PRIu32 " cannot be read", number);
    }
    if ((entry->encoding == LM_TILE_LZ4 && unpack(c, entry) != LM_OK) ||
        lm_tile_check(&c->tile, lod, row, column) != LM_OK) {
        return refuse(c, at, "the record of entry %" PRIu32 " is damaged", number);
    }
    advance(c, bytes);
    return 0;
}

/* Tile columns round the Earth, a power of two; lm_db_open has checked the shifts. */
static uint32_t columns_round(const struct check *c, const struct lm_band *band)
{
    return 1u << (32 - LM_TILE_CELLS_LOG2 - c->db.shift0 - band->lod - band->zone);
}

static int check_entries(struct check *c, const struct lm_band *band, uint32_t first,
                         uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t number = band->entry0 + first + i;
        const struct lm_tile_entry *entry = &c->entries[i];
        if (lm_db_entry_check(&c->db, number, entry) != LM_OK) {
            return refuse(c, lm_db_entry_offset(&c->db, number),
                          "directory entry %" PRIu32 " is damaged", number);
        }
        const uint32_t row = band->row0 + (first + i) / band->columns;
        const uint32_t column =
            (band->column0 + (first + i) % band->columns) & (columns_round(c, band) - 1);
        if (entry->place != LM_TILE_ABSENT &&
            check_record(c, number, entry, band->lod, row, column) != 0) {
            return -1;
        }
    }
    return 0;
}

static int check_band(struct check *c, const struct lm_band *band)
{
    const uint64_t all = (uint64_t)band->rows * band->columns;
    for (uint64_t first = 0; first < all; first += ENTRIES) {
        const uint32_t count = all - first < ENTRIES ? (uint32_t)(all - first) : ENTRIES;
        const uint64_t at = lm_db_entry_offset(&c->db, band->entry0 + (uint32_t)first);
        if (lm_db_read(c->flash, at, c->entries, count * (uint32_t)sizeof c->entries[0], POLLS) !=
            LM_OK) {
            return refuse(c, at, "the directory cannot be read");
        }
        if (check_entries(c, band, (uint32_t)first, count) != 0) {
            return -1;
        }
    }
    return 0;
}

static int check_all(struct check *c)
{
    if (open_tables(c) != 0) {
        return -1;
    }
    for (uint32_t i = 0; i < c->header.section_count; i++) {
        const struct lm_image_section *s = &c->header.sections[i];
        if (passes(c, s->type) > 0 && check_section(c, s) != 0) {
            return -1;
        }
    }
    for (uint32_t i = 0; c->depth == SLOT_RECORDS && i < c->db.band_count; i++) {
        if (check_band(c, &c->db.bands[i]) != 0) {
            return -1;
        }
    }
    return 0;
}

int slot_check(const struct lm_flash *flash, enum slot_depth depth, slot_progress *progress,
               void *ctx, struct slot_fault *fault)
{
    struct check *c = malloc(sizeof *c);
    if (!c) {
        *fault = (struct slot_fault){.cause = "not enough memory to check it"};
        return -1;
    }
    c->flash = flash;
    c->depth = depth;
    c->progress = progress;
    c->ctx = ctx;
    c->done_bytes = c->total_bytes = 0;
    c->fault = fault;
    const int result = check_all(c);
    free(c);
    return result;
}
