/* Verification of an image: every byte of it against what docs/FORMATS.md promises. */
#ifndef IMAGE_VERIFY_H
#define IMAGE_VERIFY_H

#include "image/reader.h"

struct image_verify_counts {
    uint64_t tiles, entries, edges, children; /* checked */
};

/* Check an image that was mapped or lent, noting each fault. A single flipped bit anywhere is
 * always noted. Returns 0 when every check could be made (with or without findings), -1 when the
 * tables are too damaged to go on or memory ran out, with a finding for it. All processors work on
 * it; findings come in the order in which one would find them. Memory: 5 bytes an entry, 9 MB for
 * each thread where records are compressed, and 6 MB. */
int image_verify(struct image *image, struct image_findings *findings,
                 struct image_verify_counts *counts);

/* The same with so many threads, 1 or more: what is found does not depend on how many. */
int image_verify_with(struct image *image, struct image_findings *findings,
                      struct image_verify_counts *counts, uint32_t threads);

#endif
