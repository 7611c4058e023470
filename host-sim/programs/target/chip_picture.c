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

static uint32_t grey_of(float power, float white, double range_db)
{
    if (!(power > 0) || !(white > 0)) {
        return 0;
    }
    const double level = 1 + 10 * log10((double)power / (double)white) / range_db;
    return 0x010101u * (uint32_t)lround(255 * fmin(fmax(level, 0), 1));
}

void chip_draw(const float *power, int width, int height, float white, double range_db, int zoom,
               uint32_t *pixels, int stride_px)
{
    for (int y = 0; y < height * zoom; y++) {
        const float *row = power + (height - 1 - y / zoom) * width;
        for (int x = 0; x < width * zoom; x++) {
            pixels[y * stride_px + x] = grey_of(row[x / zoom], white, range_db);
        }
    }
}
