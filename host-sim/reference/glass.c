/* From lines to pixels: EQUATIONS.md, "On the glass". */
#include "reference/reference.h"

#include <math.h>
#include <string.h>

/* Number held to 0..count - 1, and what is left of it above a whole number. */
static unsigned hold(double place, unsigned count, double *rest)
{
    const double held = fmin(fmax(place, 0), count - 1);
    const unsigned whole = (unsigned)fmin(floor(held), count < 2 ? 0 : count - 2);
    *rest = held - whole;
    return whole;
}

static double grey_at(const struct ref_picture *picture, double line, double cell)
{
    double right, up;
    const unsigned k = hold(line, picture->line_count, &right);
    const unsigned i = hold(cell, picture->cell_count, &up);
    const unsigned next = k + (right > 0);
    const int above = (int)(i + (up > 0));
    const double at_left = (1 - up) * ref_picture_bin(picture, k, (int)i)->grey +
                           up * ref_picture_bin(picture, k, above)->grey;
    const double at_right = (1 - up) * ref_picture_bin(picture, next, (int)i)->grey +
                            up * ref_picture_bin(picture, next, above)->grey;
    return (1 - right) * at_left + right * at_right;
}

void ref_glass_sar(const struct ref_picture *picture, double range_m, unsigned side,
                   uint8_t *pixels)
{
    const double cells = picture->cell_count, cell_m = picture->view.cell_m;
    for (unsigned i = 0; i < side * side; i++) {
        /* From the middle of the square, in cells. */
        const double x = ((i % side + 0.5) / side - 0.5) * cells;
        const double y = (0.5 - (i / side + 0.5) / side) * cells;
        const double line = x * range_m / (range_m + y * cell_m) + picture->line_count / 2.0 - 0.5;
        pixels[i] = (uint8_t)lround(grey_at(picture, line, y + cells / 2 - 0.5));
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
