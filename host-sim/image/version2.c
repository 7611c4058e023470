#include "image/version2.h"

#include "fx/crc32c.h"
#include "hs/error.h"
#include "hs/little_endian.h"
#include "image/codes.h"
#include "image/grid.h"
#include "image/ground.h"

#include <inttypes.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    OLD_VERSION = 2,
    OLD_HEADER_BYTES = 512,
    OLD_CRC_AT = 508,
    OLD_TITLE_AT = 448,
    OLD_SECTIONS_AT = 64,
    OLD_SECTIONS_MAX = 16,
    OLD_LODS_MAX = 12,
    OLD_ENTRY_BYTES = 8,
    OLD_CLASS_USED = 28, /* bytes of a class that meant something */
    OLD_POINTS = 65,
    OLD_TILE_BYTES = 16960,
    SECTIONS = LM_IMAGE_SIGNATURES + 1 /* by type; later types did not exist */
};

/* A tile record of version 2. */
struct old_tile {
    uint32_t crc;
    uint8_t lod, zone;
    uint16_t reserved0;
    uint32_t row, column;
    int32_t base_m_q6;
    uint8_t post_shift, reserved1[11];
    struct lm_tile_point points[OLD_POINTS][OLD_POINTS];
    uint8_t reserved2[28];
};
_Static_assert(sizeof(struct old_tile) == OLD_TILE_BYTES, "the record of version 2");

struct span {
    const uint8_t *at; /* NULL: no such section */
    uint64_t bytes;
};

struct conversion {
    const char *name; /* of the old image */
    const uint8_t *bytes;
    uint64_t size;
    struct span sections[SECTIONS];
    struct lm_image_header header; /* of the new image, as far as it is known */
    uint32_t record_count;         /* of the old one */
    struct lm_classes classes;
    struct lm_db db; /* grid and bands */
    struct image_writer writer;
};

static int damaged(const struct conversion *c, const char *what)
{
    return hs_error(c->name, "convert a sound copy of it, or build it again from its sources", "%s",
                    what);
}

/* ---- reading the old image ---- */

static int read_header(struct conversion *c)
{
    const uint8_t *h = c->bytes;
    if (c->size < OLD_HEADER_BYTES || memcmp(h, "LANDMASS", 8) != 0) {
        return hs_error(c->name, "give an image that `landmass-db build` wrote", "is no image");
    }
    if (hs_get_u32(h + 8) == LM_DB_VERSION) {
        return hs_error(c->name,
                        "use it as it is, or say by --compress how its tiles shall be "
                        "stored",
                        "is an image of version %d already", LM_DB_VERSION);
    }
    if (hs_get_u32(h + 8) != OLD_VERSION) {
        return hs_error(c->name, "build it again from its sources",
                        "is an image of version %" PRIu32 "; this command knows version %d",
                        hs_get_u32(h + 8), OLD_VERSION);
    }
    if (fx_crc32c(0, h, OLD_CRC_AT) != hs_get_u32(h + OLD_CRC_AT)) {
        return damaged(c, "its header's checksum does not hold");
    }
    struct lm_image_header *n = &c->header;
    n->shift0 = h[24];
    n->lod_count = h[25];
    n->band_count = (uint16_t)(h[26] | h[27] << 8);
    n->entry_count = hs_get_u32(h + 28);
    c->record_count = hs_get_u32(h + 32);
    n->mean_elevation_m_q6 = (int32_t)hs_get_u32(h + 40);
    n->geoid_m_q6 = (int32_t)hs_get_u32(h + 44);
    n->centre_latitude = hs_get_u32(h + 48);
    n->centre_longitude = hs_get_u32(h + 52);
    n->section_count = hs_get_u32(h + 56);
    memcpy(n->title, h + OLD_TITLE_AT, sizeof n->title);
    const bool is_sound =
        n->shift0 >= LM_DB_SHIFT_MIN && n->lod_count >= 1 && n->lod_count <= OLD_LODS_MAX &&
        n->shift0 + n->lod_count - 1 <= LM_DB_SHIFT_MAX && n->band_count >= 1 &&
        n->band_count <= LM_DB_BANDS_MAX && n->section_count <= OLD_SECTIONS_MAX &&
        hs_get_u64(h + 16) == c->size && hs_get_u32(h + 36) == OLD_TILE_BYTES;
    return is_sound ? 0 : damaged(c, "a number of its header is out of its range");
}

static int read_section(struct conversion *c, uint32_t index)
{
    const uint8_t *entry = c->bytes + OLD_SECTIONS_AT + (size_t)24 * index;
    const uint32_t type = hs_get_u32(entry);
    const uint64_t offset = hs_get_u64(entry + 8), bytes = hs_get_u64(entry + 16);
    if (type == 0 || type >= SECTIONS) {
        return 0;
    }
    if (offset % LM_IMAGE_SECTION_ALIGNMENT != 0 || offset > c->size || bytes > c->size - offset) {
        return damaged(c, "a section does not lie inside it");
    }
    if (fx_crc32c(0, c->bytes + offset, bytes) != hs_get_u32(entry + 4)) {
        return damaged(c, "the checksum of a section does not hold");
    }
    c->sections[type] = (struct span){c->bytes + offset, bytes};
    return 0;
}

static bool has_length(const struct conversion *c, uint32_t type, uint64_t bytes)
{
    return c->sections[type].at && c->sections[type].bytes == bytes;
}

static int read_sections(struct conversion *c)
{
    for (uint32_t i = 0; i < c->header.section_count; i++) {
        if (read_section(c, i) != 0) {
            return -1;
        }
    }
    const struct lm_image_header *h = &c->header;
    if (!has_length(c, LM_IMAGE_CLASSES, sizeof c->classes) ||
        !has_length(c, LM_IMAGE_BANDS, h->band_count * sizeof(struct lm_band)) ||
        !has_length(c, LM_IMAGE_DIRECTORY, (uint64_t)h->entry_count * OLD_ENTRY_BYTES) ||
        !has_length(c, LM_IMAGE_TILES, (uint64_t)c->record_count * OLD_TILE_BYTES) ||
        !c->sections[LM_IMAGE_MANIFEST].at) {
        return damaged(c, "a section is missing or has another length than its header says");
    }
    memcpy(&c->classes, c->sections[LM_IMAGE_CLASSES].at, sizeof c->classes);
    for (int i = 0; i < LM_DB_CLASSES; i++) {
        memset((uint8_t *)&c->classes.entry[i] + OLD_CLASS_USED, 0,
               sizeof c->classes.entry[i] - OLD_CLASS_USED);
    }
    c->db =
        (struct lm_db){.lod_count = h->lod_count, .shift0 = h->shift0, .band_count = h->band_count};
    memcpy(c->db.bands, c->sections[LM_IMAGE_BANDS].at, c->sections[LM_IMAGE_BANDS].bytes);
    return 0;
}

/* A band must lie on the Earth, in one zone, and have entries of its own. */
static bool band_is_sound(const struct conversion *c, const struct lm_band *b)
{
    if (b->lod >= c->header.lod_count || b->zone > 3 || b->rows < 1 || b->columns < 1) {
        return false;
    }
    const uint8_t shift = (uint8_t)(c->header.shift0 + b->lod);
    const uint32_t rows = image_rows_all(shift), round = image_columns_round(shift, b->zone);
    const uint64_t entries = (uint64_t)b->rows * b->columns;
    return b->row0 < rows && b->rows <= rows - b->row0 && b->column0 < round &&
           b->columns <= round && entries <= c->header.entry_count &&
           b->entry0 <= c->header.entry_count - entries;
}

static int check_bands(const struct conversion *c)
{
    for (uint32_t i = 0; i < c->header.band_count; i++) {
        if (!band_is_sound(c, &c->db.bands[i])) {
            return damaged(c, "a band of tiles is out of range");
        }
    }
    return 0;
}

/* The record of an entry, or NULL: the image has no such tile. Sets *is_bad for one that cannot be
 * used. */
static const struct old_tile *old_tile_of(const struct conversion *c, uint32_t entry, bool *is_bad)
{
    const uint8_t *at = c->sections[LM_IMAGE_DIRECTORY].at + (size_t)entry * OLD_ENTRY_BYTES;
    const uint32_t record = hs_get_u32(at), covered[2] = {entry, record};
    *is_bad = fx_crc32c(0, covered, sizeof covered) != hs_get_u32(at + 4) ||
              (record != UINT32_MAX && record >= c->record_count);
    if (*is_bad || record == UINT32_MAX) {
        return NULL;
    }
    const struct old_tile *t =
        (const void *)(c->sections[LM_IMAGE_TILES].at + (size_t)record * OLD_TILE_BYTES);
    *is_bad = fx_crc32c(0, &t->lod, OLD_TILE_BYTES - sizeof t->crc) != t->crc ||
              t->post_shift > LM_TILE_POST_SHIFT_MAX || t->base_m_q6 > IMAGE_ELEVATION_LIMIT_Q6 ||
              t->base_m_q6 < -IMAGE_ELEVATION_LIMIT_Q6 ||
              lm_db_entry(&c->db, t->lod, t->row, t->column) != (int64_t)entry;
    return *is_bad ? NULL : t;
}

/* ---- making the new one ---- */

static void take_record(const struct old_tile *old, struct lm_tile *tile)
{
    *tile = (struct lm_tile){.lod = old->lod,
                             .zone = old->zone,
                             .row = old->row,
                             .column = old->column,
                             .base_m_q6 = old->base_m_q6,
                             .post_shift = old->post_shift};
    for (int r = 0; r < OLD_POINTS; r++) {
        for (int c = 0; c < OLD_POINTS; c++) {
            tile->points[r + LM_TILE_BORDER][c + LM_TILE_BORDER] = old->points[r][c];
        }
    }
}

/* A tile made, and what the one above it is made of. */
struct made {
    struct lm_tile tile;
    struct image_ground ground;
    int32_t posts_q6[LM_TILE_POSTS][LM_TILE_POSTS];
};

/* Make the tile at a place and all below it. *out, which the caller frees, is NULL without a tile.
 * Returns 0, or -1 with the error reported. */
static int make_tile(struct conversion *c, int level, uint32_t row, uint32_t column,
                     struct made **out);

/* Posts and ground of a tile from those below it. Version 2 had every second post: only those that
 * are smoothed are new. */
static void take_below(const struct conversion *c, struct made *m, struct made *const below[4])
{
    const int32_t(*posts[4])[LM_TILE_POSTS] = {NULL, NULL, NULL, NULL};
    for (int i = 0; i < 4; i++) {
        posts[i] = below[i] ? (const int32_t(*)[LM_TILE_POSTS])below[i]->posts_q6 : NULL;
    }
    image_posts_smooth(posts, m->posts_q6);
    image_posts_encode((const int32_t(*)[LM_TILE_POSTS])m->posts_q6, &m->tile);
    image_ground_init(&m->ground, &m->tile);
    for (int i = 0; i < 4; i++) {
        if (below[i]) {
            image_ground_take(&m->ground, &m->tile, &below[i]->ground, i, &c->classes);
        }
    }
}

static int make_from(struct conversion *c, uint32_t entry, const struct old_tile *old,
                     struct made *m)
{
    struct made *below[4] = {NULL, NULL, NULL, NULL};
    int result = 0;
    take_record(old, &m->tile);
    image_cells_decode(&m->tile, m->ground.cells);
    image_posts_decode(&m->tile, m->posts_q6);
    for (int i = 0; i < 4 && old->lod > 0 && result == 0; i++) {
        result = make_tile(c, old->lod - 1, 2 * old->row + (uint32_t)(i / 2),
                           2 * old->column + (uint32_t)(i % 2), &below[i]);
    }
    if (result == 0) {
        take_below(c, m, below);
        image_ground_encode(&m->ground, &m->tile, c->classes.height_dm);
        result = image_writer_tile(&c->writer, entry, &m->tile);
    }
    for (int i = 0; i < 4; i++) {
        free(below[i]);
    }
    return result;
}

static int make_tile(struct conversion *c, int level, uint32_t row, uint32_t column,
                     struct made **out)
{
    *out = NULL;
    const int64_t entry = lm_db_entry(&c->db, (uint8_t)level, row, column);
    bool is_bad = false;
    const struct old_tile *old = entry < 0 ? NULL : old_tile_of(c, (uint32_t)entry, &is_bad);
    if (is_bad) {
        return damaged(c, "a directory entry or a tile is damaged");
    }
    if (!old) {
        return 0;
    }
    *out = malloc(sizeof **out);
    return *out ? make_from(c, (uint32_t)entry, old, *out)
                : hs_error(c->name, NULL, "out of memory");
}

static int make_tiles(struct conversion *c)
{
    for (uint32_t i = 0; i < c->db.band_count; i++) {
        const struct lm_band *b = &c->db.bands[i];
        const uint32_t mask = image_columns_round((uint8_t)(c->db.shift0 + b->lod), b->zone) - 1;
        const uint64_t tiles = b->lod + 1 == c->db.lod_count ? (uint64_t)b->rows * b->columns : 0;
        for (uint64_t k = 0; k < tiles; k++) {
            struct made *top;
            const int result = make_tile(c, b->lod, b->row0 + (uint32_t)(k / b->columns),
                                         (b->column0 + (uint32_t)(k % b->columns)) & mask, &top);
            free(top);
            if (result != 0) {
                return -1;
            }
        }
    }
    return c->writer.header.record_count == c->record_count
               ? 0
               : damaged(c, "a tile has no tile above it, or stands twice");
}

/* The old manifest with its section checksums marked as the old image's. The caller frees it. */
static char *make_manifest(const struct conversion *c)
{
    static const char mark[] = "section-sha256:";
    const char *old = (const char *)c->sections[LM_IMAGE_MANIFEST].at;
    const char *const end = old + c->sections[LM_IMAGE_MANIFEST].bytes;
    char *text = NULL;
    size_t bytes = 0;
    FILE *out = open_memstream(&text, &bytes);
    if (!out) {
        return NULL;
    }
    for (const char *line = old; line < end;) {
        const char *stop = memchr(line, '\n', (size_t)(end - line));
        const size_t length = (size_t)((stop ? stop : end) - line);
        const bool is_marked =
            length >= sizeof mark - 1 && memcmp(line, mark, sizeof mark - 1) == 0;
        fprintf(out, "%s%.*s\n", is_marked ? "version-2-" : "", (int)length, line);
        line += length + 1;
    }
    fputs(
        "converted: from version 2 by landmass-db convert; borders from neighbours, coarser levels "
        "made again\n",
        out);
    if (fclose(out) != 0) {
        free(text);
        return NULL;
    }
    return text;
}

static void take_extras(struct conversion *c)
{
    const struct span *targets = &c->sections[LM_IMAGE_TARGETS];
    const struct span *signatures = &c->sections[LM_IMAGE_SIGNATURES];
    struct lm_image_header *h = &c->writer.header;
    c->writer.targets = (struct image_bytes){targets->at, targets->bytes};
    c->writer.signatures = (struct image_bytes){signatures->at, signatures->bytes};
    h->mean_elevation_m_q6 = c->header.mean_elevation_m_q6;
    h->geoid_m_q6 = c->header.geoid_m_q6;
    h->centre_latitude = c->header.centre_latitude;
    h->centre_longitude = c->header.centre_longitude;
    memcpy(h->title, c->header.title, sizeof h->title);
}

static int write_image(struct conversion *c, enum image_compression how, const char *path)
{
    const struct lm_image_header header = {.shift0 = c->header.shift0,
                                           .lod_count = c->header.lod_count,
                                           .band_count = c->header.band_count,
                                           .entry_count = c->header.entry_count};
    if (image_writer_begin(&c->writer, path, &header, &c->classes, c->db.bands) != 0) {
        return -1;
    }
    char *manifest = make_tiles(c) == 0 ? make_manifest(c) : NULL;
    if (!manifest) {
        image_writer_abort(&c->writer);
        return -1;
    }
    take_extras(c);
    c->writer.compression = how;
    const int result = image_writer_end(&c->writer, manifest);
    free(manifest);
    return result;
}

int image_version2_convert(const uint8_t *bytes, uint64_t size, const char *name,
                           enum image_compression how, const char *path)
{
    struct conversion *c = calloc(1, sizeof *c);
    if (!c) {
        return hs_error(name, NULL, "out of memory");
    }
    c->name = name;
    c->bytes = bytes;
    c->size = size;
    const bool is_read = read_header(c) == 0 && read_sections(c) == 0 && check_bands(c) == 0;
    const int result = is_read ? write_image(c, how, path) : -1;
    free(c);
    return result;
}
