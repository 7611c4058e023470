/* Chip pictures: powers as grey pixels to look at. */
#ifndef TARGET_CHIP_PICTURE_H
#define TARGET_CHIP_PICTURE_H

#include <stdint.h>

/* How power becomes grey: in dB, white at the brightest and black so much below; or in proportion
 * to the amplitude, white at the brightest ([Niu], peak quantisation), or at so much below it and
 * above (truncation quantisation). */
enum chip_tone_kind { CHIP_DB, CHIP_PEAK, CHIP_CUT };
#define CHIP_TONE_WORDS "db|peak|cut"

struct chip_tone {
    enum chip_tone_kind kind;
    float white; /* power of the brightest */
    double db;   /* CHIP_DB, CHIP_CUT: so much below it */
    int levels;  /* of grey, 2 to 256 */
};

/* Draw a chip, near row first, with its far row on top and each pixel `zoom` * `zoom` large. */
void chip_draw(const float *power, int width, int height, const struct chip_tone *tone, int zoom,
               uint32_t *pixels, int stride_px);

float chip_peak(const float *power, int count);

#endif
