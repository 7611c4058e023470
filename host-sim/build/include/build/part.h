/* Part: the file of a shard that is made, a piece of an image (docs/FORMATS.md, section 8). It
 * holds the records of its tiles, what the tiles above them need, and sums over all of them.
 *
 * Example: reading one.
 *
 *     struct build_part part;
 *     if (build_part_open(&part, path) != 0) {
 *         return -1;
 *     }
 *     int has = build_part_take(&part, entry, &record, NULL);
 *     ...
 *     build_part_close(&part); */
#ifndef BUILD_PART_H
#define BUILD_PART_H

#include "build/shard.h"
#include "build/tile.h"
#include "hs/atomic_file.h"
#include "image/sha256.h"

#include <stddef.h>

enum { BUILD_PART_VERSION = 2, BUILD_PART_HEADER_BYTES = 2048 };

/* What a part says of itself. */
struct build_part_head {
    char magic[8]; /* LANDPART */
    uint32_t version, header_bytes;
    uint64_t part_bytes, index_offset;
    uint32_t number, shard_count; /* which shard of how many */
    char key[64];                 /* hexadecimal: of all that its tiles are made from */
    char body_sha256[64];         /* of all bytes behind the header */
    uint32_t level, zone, row0, rows, column0, columns;
    uint32_t tile_count, index_count; /* of the index: tiles, and once more those of `level` */
    struct build_counts counts;
    struct build_towns towns;
};

/* ---- writing: begin, put for each tile, end; abort to give up ---- */

struct build_part_item {
    uint32_t entry;
    uint16_t is_top; /* 1: what the tile above needs, 0: the record */
    uint16_t size;   /* of the record, in units of LM_DB_PLACE_BYTES; else 0 */
    uint64_t offset;
};

struct build_part_writer {
    struct hs_atomic_file file;
    struct build_part_head head;
    struct build_part_item *items; /* owned */
    size_t item_count, item_capacity;
    uint64_t offset;
    struct image_sha256 sha256;
};

/* Start `path`, the part of shard `number`. Returns 0, or -1 with the error reported and nothing
 * left behind; so do the next two. */
int build_part_begin(struct build_part_writer *w, const char *path, const struct build_shard *shard,
                     uint32_t number, uint32_t shard_count, const char *key);
/* As struct build_sink has it. */
int build_part_put(void *writer, uint32_t entry, const struct build_tile *tile, bool is_top);
/* Put it in place. The writer is done with whatever is returned. */
int build_part_end(struct build_part_writer *w, const struct build_context *b);
/* Harmless after the end. */
void build_part_abort(struct build_part_writer *w);

/* ---- reading ---- */

struct build_part {
    const char *path; /* borrowed */
    struct build_part_head head;
    const uint8_t *bytes; /* mapped */
    size_t size;
    const uint8_t *index; /* of these */
};

/* Open a part and check every byte of it. Returns 0, or -1 with the error reported and nothing to
 * close:
 * - it cannot be read, is no part, is of another version or shorter than it says,
 * - a checksum is wrong,
 * - its index is not in order or points outside. */
int build_part_open(struct build_part *p, const char *path);
/* Harmless on a zeroed struct. */
void build_part_close(struct build_part *p);
/* Give back the memory that the part's bytes take; they are read again as they are needed. */
void build_part_release(const struct build_part *p);

/* The record of a directory entry, and what the tile above it needs into `tile` unless it is NULL.
 * Returns 1, 0 where the part has no such tile, or -1 with the error reported: the record is of
 * another tile, or holds what no tile has. */
int build_part_take(const struct build_part *p, uint32_t entry, const struct image_frame *frame,
                    int level, struct lm_tile *record, struct build_tile *tile);

#endif
