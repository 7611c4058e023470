/* Put right the checksums of an image whose every byte may be hostile, so that a fuzzer gets past
 * them. Believes nothing that the image says: what it cannot find is left alone. */
#ifndef FUZZ_SEAL_H
#define FUZZ_SEAL_H

#include <stddef.h>
#include <stdint.h>

enum seal_part { SEAL_HEADER = 1, SEAL_TABLES = 2, SEAL_DIRECTORY = 4, SEAL_RECORDS = 8 };

/* `parts` is a set of enum seal_part. At most 4096 directory entries and records are sealed. */
void seal_image(uint8_t *image, size_t size, unsigned parts);

#endif
