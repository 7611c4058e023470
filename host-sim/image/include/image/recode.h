/* An image with its tile records stored another way. */
#ifndef IMAGE_RECODE_H
#define IMAGE_RECODE_H

#include "image/pack.h"
#include "image/reader.h"

/* Write the image again as `path`. `image` has passed image_verify without findings; `name` is its
 * own, for messages. Tiles, all known sections and the order of records are kept; a seal is not,
 * because it is over other bytes. The same build with the other choice gives the same image.
 * Returns 0, or -1 with the error reported and `path` as it was. */
int image_recode(const struct image *image, const char *name, enum image_compression how,
                 const char *path);

#endif
