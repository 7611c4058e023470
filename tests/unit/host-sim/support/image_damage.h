/* An image in memory, damaged byte by byte and looked at by image_verify. */
#ifndef IMAGE_DAMAGE_H
#define IMAGE_DAMAGE_H

#include "check.h"
#include "scene.h"

#include "image/reader.h"
#include "image/verify.h"

#include "fx/crc32c.h"
#include "lm/image.h"

#include <stdlib.h>
#include <string.h>

/* How much image_verify finds wrong; not to be read to its end is one fault more. */
static inline uint64_t damage_faults(const void *bytes, size_t size)
{
    struct image image;
    struct image_findings findings = {NULL, 0, 0, false, NULL};
    struct image_verify_counts counts;
    image_lend(&image, bytes, size);
    const int is_complete = image_verify(&image, &findings, &counts);
    return findings.count + (is_complete != 0);
}

/* The bytes of an open image; the caller frees them. */
static inline uint8_t *damage_copy(const struct image *image)
{
    uint8_t *bytes = malloc(image->size_bytes);
    assert_non_null(bytes);
    memcpy(bytes, image->bytes, image->size_bytes);
    return bytes;
}

/* Put right the checksums of the sections of these types, first to last, and of the header. They
 * stand in the order of their types. */
static inline void damage_seal(uint8_t *bytes, int first, int last)
{
    struct lm_image_header h;
    memcpy(&h, bytes, sizeof h);
    for (int type = first; type <= last; type++) {
        struct lm_image_section *s = &h.sections[type - 1];
        s->crc = fx_crc32c(0, bytes + s->offset, s->bytes);
    }
    h.crc = fx_crc32c(0, &h, offsetof(struct lm_image_header, crc));
    memcpy(bytes, &h, sizeof h);
}

/* Flip a bit of each byte of a section's head, 64 of them, and of one in `step` of the rest of its
 * `count`: each is found, and without them nothing is. */
static inline void damage_flip(uint8_t *image, size_t size, size_t at, size_t count, size_t step)
{
    for (size_t i = 0; i < count; i += i < 64 ? 1 : step) {
        uint8_t *byte = image + at + i;
        *byte = (uint8_t)(*byte ^ 1u << i % 8);
        assert_true(damage_faults(image, size) > 0);
        *byte = (uint8_t)(*byte ^ 1u << i % 8);
    }
    assert_int_equal(damage_faults(image, size), 0);
}

#endif
