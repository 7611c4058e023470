/* Fill of missing heights from those around them. */
#ifndef TERRAIN_FILL_H
#define TERRAIN_FILL_H

#include <stdint.h>

/* Stretch a skin over the pixels of `metres` (rows of `width`) whose `is_known` is 0, held by those
 * around them: a hole in a slope becomes the slope. The known ones stay as they are, and there must
 * be one. Each level of a pyramid of halved pictures is filled from the coarser one and relaxed
 * toward the mean of its neighbours (Laplace's equation by nested iteration). Returns 0, or -1 when
 * memory runs out. Cost: about 30 visits a pixel; memory: 2 bytes a pixel. */
int terrain_fill(int width, int height, float *metres, const uint8_t *is_known);

#endif
