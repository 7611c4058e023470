#include "seal.h"

#include "fx/crc32c.h"
#include "lm/db.h"

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
    } else if ((type == CLASSES || type == BANDS || type == GEOID) && parts & SEAL_TABLES) {
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
    if (parts & SEAL_HEADER) {
        const uint32_t crc = fx_crc32c(0, image, LM_DB_HEADER_BYTES - 4);
        memcpy(image + LM_DB_HEADER_BYTES - 4, &crc, 4);
    }
}
