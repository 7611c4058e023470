/* Signatures of an image: print them, and find what is wrong with them. Those for an image that is
 * being built: build/signatures.h. */
#ifndef IMAGE_SIGNATURES_H
#define IMAGE_SIGNATURES_H

#include "image/reader.h"

/* Print each signature on a line; nothing when there is none. */
void image_signatures_print(const struct image *image);

/* Add each fault of signatures and chips to `findings`; `image` has passed image_read_tables. */
void image_signatures_check(const struct image *image, struct image_findings *findings);

/* Print a name, which a damaged or hostile file may hold, 16 characters wide: what a terminal
 * cannot show becomes a question mark. */
void image_name_print(const char name[16]);

#endif
