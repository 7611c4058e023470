/* A signature in the golden images: a body with a cross-beam at its tail, from eight sides. Whole
 * numbers alone, so that it is the same on every machine. */
#ifndef GOLDEN_SIGNATURE_H
#define GOLDEN_SIGNATURE_H

#include "tiny_image.h"

/* Put it behind everything else in the image. 0, or -1 without memory, the image as it was. */
int golden_add_signature(struct tiny_image *image);

#endif
