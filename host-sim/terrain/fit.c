#include "fit.h"

#include <math.h>
#include <stdlib.h>

enum { TAPS = 2 * TERRAIN_FIT_CELLS * TERRAIN_FIT_PARTS - 1 };

static const double cell_least = 0.25;

static double triangle(double x)
{
    return fmax(0.0, 1.0 - fabs(x));
}

/* Dual of the triangle, x in cells. */
static double dual(double x)
{
    const double own = 11.0 / 16, next = 5.0 / 32; /* overlaps, as fit.h has them */
    const double root = sqrt(own * own - 4 * next * next), q = (root - own) / (2 * next);
    double sum = 0;
    for (int m = 1 - TERRAIN_FIT_CELLS; m < TERRAIN_FIT_CELLS; m++) {
        sum += pow(q, abs(m)) / root * triangle(x - m);
    }
    return sum;
}

void terrain_fit_set(struct terrain_fit *fit, double cell_x, double cell_y)
{
    fit->cell_x = cell_x;
    fit->cell_y = cell_y;
    fit->is_on = fmax(cell_x, cell_y) <= 1.0 && fmin(cell_x, cell_y) > cell_least;
    double sum = 0;
    for (int k = 0; k < TAPS; k++) {
        fit->tap[k] = dual((double)(k - TAPS / 2) / TERRAIN_FIT_PARTS);
        sum += fit->tap[k];
    }
    for (int k = 0; k < TAPS; k++) {
        fit->tap[k] /= sum;
    }
}

double terrain_fit_reach(double cell)
{
    return 1.0 + TERRAIN_FIT_CELLS * cell;
}

double terrain_fit_weight(const struct terrain_fit *fit, double cell, double distance)
{
    /* The taps less than a pixel away; the others' triangles are 0. */
    const double step = cell / TERRAIN_FIT_PARTS;
    int first = (int)ceil((distance - 1) / step), last = (int)floor((distance + 1) / step);
    first = first < -(TAPS / 2) ? -(TAPS / 2) : first;
    last = last > TAPS / 2 ? TAPS / 2 : last;
    double sum = 0;
    for (int k = first; k <= last; k++) {
        sum += fit->tap[k + TAPS / 2] * (1.0 - fabs(distance - k * step));
    }
    return sum;
}
