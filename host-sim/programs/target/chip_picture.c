#include "chip_picture.h"

#include <math.h>

float chip_peak(const float *power, int count)
{
    float peak = 0;
    for (int i = 0; i < count; i++) {
        peak = fmaxf(peak, power[i]);
    }
    return peak;
}

/* 0 to 1 */
static double level_of(float power, const struct chip_tone *tone)
{
    const double share = (double)power / (double)tone->white;
    switch (tone->kind) {
    case CHIP_PEAK:
        return sqrt(share);
    case CHIP_CUT:
        return sqrt(share) * pow(10, tone->db / 20);
    default:
        return 1 + 10 * log10(share) / tone->db;
    }
}

static uint32_t grey_of(float power, const struct chip_tone *tone)
{
    if (!(power > 0) || !(tone->white > 0)) {
        return 0;
    }
    const int last = tone->levels - 1;
    const double level = fmin(fmax(level_of(power, tone), 0), 1);
    return 0x010101u * (uint32_t)lround(255 * round(level * last) / last);
}

void chip_draw(const float *power, int width, int height, const struct chip_tone *tone, int zoom,
               uint32_t *pixels, int stride_px)
{
    for (int y = 0; y < height * zoom; y++) {
        const float *row = power + (height - 1 - y / zoom) * width;
        for (int x = 0; x < width * zoom; x++) {
            pixels[y * stride_px + x] = grey_of(row[x / zoom], tone);
        }
    }
}
