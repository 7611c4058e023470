/* SHA-256 (FIPS 180-4), by which the manifest names its inputs and sections. Usage: begin, add as
 * often as needed, end. */
#ifndef IMAGE_SHA256_H
#define IMAGE_SHA256_H

#include <stddef.h>
#include <stdint.h>

enum { IMAGE_SHA256_BYTES = 32, IMAGE_SHA256_TEXT = 2 * IMAGE_SHA256_BYTES + 1 };

struct image_sha256 {
    uint32_t state[8];
    uint64_t length_bytes;
    uint8_t block[64];
};

/* Start a digest, and add bytes to it. */
void image_sha256_begin(struct image_sha256 *s);
void image_sha256_add(struct image_sha256 *s, const void *data, size_t length_bytes);

/* The digest in hexadecimal, lower case, with a terminating zero. The context is used up. */
void image_sha256_end(struct image_sha256 *s, char text[IMAGE_SHA256_TEXT]);

#endif
