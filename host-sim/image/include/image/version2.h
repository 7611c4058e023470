/* Flash image of version 2, for those who make a newer one of it. Trusts no byte of the file. */
#ifndef IMAGE_VERSION2_H
#define IMAGE_VERSION2_H

#include "image/writer.h"

#include <stdint.h>

/* Make the image `path` of version 3 from the bytes of one of version 2; `name` is for messages,
 * and `how` says how tile records are stored.
 *
 * - Cells and posts of tiles are kept. Borders are filled from neighbours. Coarser levels are made
 *   again from the finer ones, and so gain their crests.
 * - Classes, title, centre, targets and signatures are kept.
 * - The manifest is kept. Its lines of section checksums are marked as the old image's, and a line
 *   says what was converted.
 *
 * Memory: four tiles a level. Returns 0, or -1 with the error reported and `path` as it was: the
 * bytes are no image of version 2, a checksum does not hold, a tile has no parent, or the new image
 * cannot be written. */
int image_version2_convert(const uint8_t *bytes, uint64_t size, const char *name,
                           enum image_compression how, const char *path);

#endif
