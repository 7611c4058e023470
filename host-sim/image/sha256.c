#include "image/sha256.h"

#include <stdio.h>

void image_sha256_begin(struct image_sha256 *s)
{
    (void)SHA256_Init(&s->state);
}

void image_sha256_add(struct image_sha256 *s, const void *data, size_t length_bytes)
{
    (void)SHA256_Update(&s->state, data, length_bytes);
}

void image_sha256_end(struct image_sha256 *s, char text[IMAGE_SHA256_TEXT])
{
    uint8_t digest[IMAGE_SHA256_BYTES];
    (void)SHA256_Final(digest, &s->state);
    for (size_t i = 0; i < sizeof digest; i++) {
        snprintf(text + 2 * i, 3, "%02x", digest[i]);
    }
}
