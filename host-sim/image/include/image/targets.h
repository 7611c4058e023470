/* Targets of an image: print them, and find what is wrong with them. Those for an image that is
 * being built: build/targets.h. */
#ifndef IMAGE_TARGETS_H
#define IMAGE_TARGETS_H

#include "image/reader.h"

/* Print what they are, a line each and one for every body. */
void image_targets_print(const struct image *image);

/* Note what is wrong with them; `image` has passed image_read_tables. */
void image_targets_check(const struct image *image, struct image_findings *findings);

#endif
