#include "seal.h"

#include "fx/crc32c.h"
#include "lm/db.h"
#include "lm/tile_unpack.h"

#include <string.h>

enum {
    SECTION_ENTRY = 24,
    SECTIONS_MAX = 32,
    ENTRY = 16,
    CLASSES = 1,
    BANDS,
    DIRECTORY,
    TILES,
    GEOID = 8,
    RADAR = 10,
    ENTRIES_MAX = 4096
};

static uint64_t get(const uint8_t *at, size_t bytes)
{
    uint64_t value = 0;
    memcpy(&value, at, bytes);
    return value;
}

static void seal_directory(uint8_t *directory, size_t bytes)
{
    for (uint32_t i = 0; i < bytes / ENTRY && i < ENTRIES_MAX; i++) {
        uint8_t *entry = directory + ENTRY * (size_t)i, covered[ENTRY];
        memcpy(covered, &i, 4);
        memcpy(covered + 4, entry, ENTRY - 4);
        const uint32_t crc = fx_crc32c(0, covered, sizeof covered);
        memcpy(entry + ENTRY - 4, &crc, 4);
    }
}

static void seal_records(uint8_t *records, size_t bytes)
{
    for (size_t i = 0; i < bytes / LM_TILE_BYTES && i < ENTRIES_MAX; i++) {
        uint8_t *record = records + i * LM_TILE_BYTES;
        const uint32_t crc = fx_crc32c(0, record + 4, LM_TILE_BYTES - 4);
        memcpy(record, &crc, 4);
    }
}

/* A record has the checksum of its tile. What cannot be unpacked is left alone. */
static void seal_packed(uint8_t *record, uint16_t size)
{
    struct lm_tile tile;
    struct lm_tile_unpack unpack;
    memcpy(lm_tile_unpack_place(&tile, size), record, (size_t)size * LM_DB_PLACE_BYTES);
    int status = lm_tile_unpack_begin(&unpack, &tile, size);
    while (status == LM_BUSY) {
        status = lm_tile_unpack_run(&unpack);
    }
    if (status == LM_OK) {
        const uint32_t crc = fx_crc32c(0, &tile.lod, LM_TILE_BYTES - sizeof tile.crc);
        memcpy(record, &crc, sizeof crc);
    }
}

/* Where a section of a type lies, if it lies inside the image. */
static uint8_t *find(uint8_t *image, size_t size, uint64_t type, uint64_t *bytes)
{
    for (size_t i = 0; i < SECTIONS_MAX; i++) {
        const uint8_t *entry = image + 64 + i * SECTION_ENTRY;
        const uint64_t offset = get(entry + 8, 8);
        *bytes = get(entry + 16, 8);
        if (get(entry, 4) == type && offset <= size && *bytes <= size - offset) {
            return image + offset;
        }
    }
    return NULL;
}

static void seal_packed_records(uint8_t *image, size_t size)
{
    uint64_t directory_bytes, tiles_bytes;
    const uint8_t *directory = find(image, size, DIRECTORY, &directory_bytes);
    uint8_t *tiles = find(image, size, TILES, &tiles_bytes);
    for (size_t i = 0; directory && tiles && i < directory_bytes / ENTRY && i < ENTRIES_MAX; i++) {
        const uint8_t *entry = directory + ENTRY * i;
        const uint64_t at = LM_DB_PLACE_BYTES * get(entry, 4);
        const uint16_t units = (uint16_t)get(entry + 4, 2);
        const uint64_t bytes = (uint64_t)LM_DB_PLACE_BYTES * units;
        if (entry[6] == LM_TILE_LZ4 && units > 0 && bytes < LM_TILE_BYTES && at <= tiles_bytes &&
            bytes <= tiles_bytes - at) {
            seal_packed(tiles + at, units);
        }
    }
}

/* The record's own checksum, and then the section's. */
static void seal_radar(uint8_t *record, size_t bytes)
{
    if (bytes > 4) {
        const uint32_t crc = fx_crc32c(0, record + 4, bytes - 4);
        memcpy(record, &crc, 4);
    }
}

static void seal_section(uint8_t *image, size_t size, uint8_t *entry, unsigned parts)
{
    const uint64_t type = get(entry, 4), offset = get(entry + 8, 8), bytes = get(entry + 16, 8);
    if (offset < LM_DB_HEADER_BYTES || offset > size || bytes > size - offset) {
        return;
    }
    if (type == DIRECTORY && parts & SEAL_DIRECTORY) {
        seal_directory(image + offset, bytes);
    } else if (type == TILES && parts & SEAL_RECORDS) {
        seal_records(image + offset, bytes);
    } else if ((type == CLASSES || type == BANDS || type == GEOID || type == RADAR) &&
               parts & SEAL_TABLES) {
        if (type == RADAR) {
            seal_radar(image + offset, bytes);
        }
        const uint32_t crc = fx_crc32c(0, image + offset, bytes);
        memcpy(entry + 4, &crc, 4);
    }
}

void seal_image(uint8_t *image, size_t size, unsigned parts)
{
    if (size < LM_DB_HEADER_BYTES) {
        return;
    }
    for (size_t i = 0; i < SECTIONS_MAX; i++) {
        seal_section(image, size, image + 64 + i * SECTION_ENTRY, parts);
    }
    if (parts & SEAL_RECORDS) {
        seal_packed_records(image, size);
    }
    if (parts & SEAL_HEADER) {
        const uint32_t crc = fx_crc32c(0, image, LM_DB_HEADER_BYTES - 4);
        memcpy(image + LM_DB_HEADER_BYTES - 4, &crc, 4);
    }
}
