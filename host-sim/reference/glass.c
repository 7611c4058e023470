/* From lines to pixels: EQUATIONS.md, "On the glass". */
#include "reference/reference.h"

#include <math.h>
#include <string.h>

void ref_glass_sar(const struct ref_picture *picture, unsigned scale, uint8_t *pixels)
{
    const unsigned n = picture->cell_count, width = n * scale;
    for (unsigned i = 0; i < width * width; i++) {
        const unsigned line = i % width / scale, cell = n - 1 - i / width / scale;
        pixels[i] = ref_picture_bin(picture, line, (int)cell)->grey;
    }
}

void ref_glass_gm(const struct ref_picture *picture, const struct ref_gm *gm, unsigned width,
                  unsigned height, uint8_t *pixels)
{
    const double rad = acos(-1.0) / 180;
    const double pixel_m = gm->cell_m * gm->cell_count / height;
    memset(pixels, 0, (size_t)width * height);
    for (unsigned i = 0; i < width * height; i++) {
        const unsigned row = i / width, column = i % width;
        const double x = (column + 0.5 - width / 2.0) * pixel_m;
        const double y = (height - row - 0.5) * pixel_m;
        const double wedge = (atan2(x, y) / rad / gm->half_angle_deg + 1) / 2 * gm->line_count;
        if (wedge < 0 || wedge >= gm->line_count) {
            continue;
        }
        const unsigned line = (unsigned)wedge;
        const double middle = (ref_gm_azimuth_deg(gm, line) - gm->centre_azimuth_deg) * rad;
        const double cell = floor((x * sin(middle) + y * cos(middle)) / gm->cell_m);
        if (cell >= 0 && cell < gm->cell_count) {
            pixels[i] = ref_picture_bin(picture, line, (int)cell)->grey;
        }
    }
}
