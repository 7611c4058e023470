/* Writer of a flash image (docs/FORMATS.md, section 1). Tiles may come in any order; the file
 * appears under its final name when it is whole. Usage: image_writer_begin, image_writer_tile for
 * each tile, image_writer_end; image_writer_abort to give up. */
#ifndef IMAGE_WRITER_H
#define IMAGE_WRITER_H

#include "hs/atomic_file.h"
#include "image/format.h"
#include "image/pack.h"
#include "image/sha256.h"

#include <stdint.h>

/* A section made elsewhere. */
struct image_bytes {
    const void *data; /* borrowed until the end */
    size_t count;
};

/* Where the detail of a tile lies in the section DETAIL, in units of LM_DB_PLACE_BYTES. */
struct image_detail_place {
    uint32_t place;
    uint8_t size; /* 0: the tile has none */
};

/* Where a record lies in TILES, in units of LM_DB_PLACE_BYTES. */
struct image_stored_place {
    uint32_t place;
    uint16_t size;
};

struct image_writer {
    struct hs_atomic_file file;
    struct lm_image_header header;
    struct lm_classes classes;
    struct lm_band bands[LM_DB_BANDS_MAX];
    uint32_t *records;                      /* record number of each directory entry; owned */
    struct image_stored_place *stored;      /* where each record lies in TILES; owned */
    struct image_detail_place *details;     /* and of each entry, where its detail lies; owned */
    struct image_bytes targets, signatures; /* the sections; data NULL for an image without */
    struct image_bytes geoid, geoid_pages, detail, radar, bus; /* the same */
    enum image_compression compression; /* of tile records; the caller may set it before the end */
    bool has_borders;                   /* likewise: tiles come with the borders that they keep */
    uint32_t tiles_size;                /* of TILES, in units of LM_DB_PLACE_BYTES */
    uint32_t tiles_crc;
    struct image_sha256 tiles_sha256;
};

/* Start `path`. `header` gives shift0, level_count, band_count and entry_count; the rest is filled
 * in here. Returns 0, or -1 with the error reported and nothing left behind. */
int image_writer_begin(struct image_writer *w, const char *path,
                       const struct lm_image_header *header, const struct lm_classes *classes,
                       const struct lm_band *bands);

/* Append a tile and enter it as directory entry `entry`, which must not have been used. Counts it
 * in `w->header.record_count`. Border and checksum are made at the end, when all neighbours are
 * known; cells of the border and posts of row 0 and column 0 may hold anything. Returns 0, or -1
 * with the error reported. */
int image_writer_tile(struct image_writer *w, uint32_t entry, const struct lm_tile *tile);

/* Name the detail of directory entry `entry`. */
void image_writer_detail(struct image_writer *w, uint32_t entry, uint32_t place, uint8_t size);

/* Finish: borders of tiles, directory, manifest and header. `manifest` is text to which the SHA-256
 * of the other sections is added. Title, centre, mean elevation and geoid are taken from w->header,
 * the other sections and how
 * records are stored from the members above, where the caller has put them. Returns
 * 0, or -1 with the error reported; either way the writer is done with. */
int image_writer_end(struct image_writer *w, const char *manifest);

/* Give up: nothing is left of the file. Harmless after image_writer_end. */
void image_writer_abort(struct image_writer *w);

#endif
