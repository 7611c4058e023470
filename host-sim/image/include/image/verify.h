/* Verification of an image: every byte of it against what docs/FORMATS.md promises. */
#ifndef IMAGE_VERIFY_H
#define IMAGE_VERIFY_H

#include "image/reader.h"

struct image_verify_counts {
    uint64_t tiles, entries, edges, children; /* checked */
};

/* Check an image that was mapped or lent, noting each fault. A single flipped bit anywhere is
 * always noted. Returns 0 when every check could be made (with or without findings), -1 when the
 * tables are too damaged to go on or memory ran out, with a finding for it. Cost: each byte is read
 * about three times; 4 bytes of memory an entry. */
int image_verify(struct image *image, struct image_findings *findings,
                 struct image_verify_counts *counts);

#endif
