/* Chip pictures: powers as grey pixels to look at. */
#ifndef TARGET_CHIP_PICTURE_H
#define TARGET_CHIP_PICTURE_H

#include <stdint.h>

/* Draw a chip, near row first, with its far row on top and each pixel `zoom` * `zoom` large:
 * white is `white`, black `range_db` below. */
void chip_draw(const float *power, int width, int height, float white, double range_db, int zoom,
               uint32_t *pixels, int stride_px);

float chip_peak(const float *power, int count);

#endif
