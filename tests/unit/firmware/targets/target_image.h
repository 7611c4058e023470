/* A flash image with a section TARGETS, byte by byte as docs/FORMATS.md has it. */
#ifndef TARGET_IMAGE_H
#define TARGET_IMAGE_H

#include "target_support.h"
#include "tiny_image.h"

#include <stdlib.h>

enum {
    TARGETS = 3,
    SECTION_TABLE = 64,
    SECTION_ENTRY = 24,
    SECTION_COUNT_AT = 56,
    HEADER_CRC_AT = 1020
};

/* A tiny image with a section TARGETS behind everything else: three times the target, with ids
 * 0..2. */
struct with_targets {
    uint8_t *bytes;
    size_t size, head_at;
};

static inline void put(uint8_t *at, uint64_t value, size_t bytes)
{
    memcpy(at, &value, bytes);
}

static inline void seal_header(struct with_targets *w)
{
    put(w->bytes + HEADER_CRC_AT, fx_crc32c(0, w->bytes, HEADER_CRC_AT), 4);
}

static inline void seal_head(struct with_targets *w)
{
    put(w->bytes + w->head_at + 60, fx_crc32c(0, w->bytes + w->head_at, 60), 4);
}

static inline void add_targets(struct with_targets *w, const struct tiny_image *image,
                               struct lm_target t)
{
    const size_t section_bytes = 64 + TARGETS * LM_TARGET_BYTES;
    w->head_at = (image->size + 63) / 64 * 64;
    w->size = w->head_at + section_bytes;
    w->bytes = calloc(1, w->size);
    memcpy(w->bytes, image->bytes, image->size);
    put(w->bytes + w->head_at, TARGETS, 4);
    put(w->bytes + w->head_at + 4, LM_TARGET_BYTES, 4);
    seal_head(w);
    for (uint32_t i = 0; i < TARGETS; i++) {
        t.id = i;
        seal_target(&t);
        memcpy(w->bytes + w->head_at + 64 + i * sizeof t, &t, sizeof t);
    }
    uint8_t *entry = w->bytes + SECTION_TABLE + 5 * SECTION_ENTRY;
    put(entry, 6, 4);
    put(entry + 8, w->head_at, 8);
    put(entry + 16, section_bytes, 8);
    put(w->bytes + 16, w->size, 8);
    put(w->bytes + SECTION_COUNT_AT, 6, 4);
    seal_header(w);
}

#endif
