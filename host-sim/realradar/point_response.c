#include "realradar/point_response.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

enum { MIDDLE = RR_CUT_SIZE / 2, REFINEMENTS = 3 };

static const double isolation_m = 6, isolation_db = 14;

/* Steps from the middle in direction `way` until the power crosses `level`, between samples. */
static double steps_to_level(const double *power, int way, double level)
{
    for (int i = 1; i <= MIDDLE; i++) {
        const double here = power[MIDDLE + way * i], before = power[MIDDLE + way * (i - 1)];
        if (here < level) {
            return i - 1 + (before - level) / (before - here);
        }
    }
    return MIDDLE;
}

static int steps_to_minimum(const double *power, int way)
{
    int i = 0;
    while (i < MIDDLE && power[MIDDLE + way * (i + 1)] < power[MIDDLE + way * i]) {
        i++;
    }
    return i;
}

void rr_cut_measure(struct rr_cut *cut)
{
    const double *power = cut->power;
    const double peak = power[MIDDLE];
    const int left = MIDDLE - steps_to_minimum(power, -1);
    const int right = MIDDLE + steps_to_minimum(power, 1);
    double inside = 0, outside = 0, highest = 0;
    for (int i = 0; i < RR_CUT_SIZE; i++) {
        const bool is_main = i >= left && i <= right;
        *(is_main ? &inside : &outside) += power[i];
        highest = is_main ? highest : fmax(highest, power[i]);
    }
    cut->irw_cells =
        (steps_to_level(power, -1, peak / 2) + steps_to_level(power, 1, peak / 2)) / RR_CUT_STEPS;
    cut->pslr_db = 10 * log10(highest / peak);
    cut->islr_db = 10 * log10(outside / inside);
}

static void take_cut(struct rr_cut *cut, const struct rr_profiles *profiles, struct rr_place centre,
                     struct rr_place direction, double cell_m)
{
    struct rr_place points[RR_CUT_SIZE];
    double complex echo[RR_CUT_SIZE];
    for (int i = 0; i < RR_CUT_SIZE; i++) {
        points[i] = rr_place_along(centre, direction, (i - MIDDLE) * cell_m / RR_CUT_STEPS);
    }
    rr_focus(profiles, points, RR_CUT_SIZE, echo);
    for (int i = 0; i < RR_CUT_SIZE; i++) {
        cut->power[i] = creal(echo[i]) * creal(echo[i]) + cimag(echo[i]) * cimag(echo[i]);
    }
}

/* Metres from the middle of the cut to its largest value within a cell, by a parabola. */
static double peak_offset_m(const struct rr_cut *cut, double cell_m)
{
    int best = MIDDLE;
    for (int i = MIDDLE - RR_CUT_STEPS; i <= MIDDLE + RR_CUT_STEPS; i++) {
        best = cut->power[i] > cut->power[best] ? i : best;
    }
    const double a = cut->power[best - 1], b = cut->power[best], c = cut->power[best + 1];
    const double bend = a - 2 * b + c;
    const double part = bend < 0 ? (a - c) / (2 * bend) : 0;
    return (best - MIDDLE + part) * cell_m / RR_CUT_STEPS;
}

void rr_response_measure(struct rr_response *response, const struct rr_profiles *profiles,
                         const struct rr_resolution *resolution, struct rr_place near)
{
    response->place = near;
    for (int i = 0; i < REFINEMENTS; i++) {
        take_cut(&response->range, profiles, response->place, resolution->range,
                 resolution->range_m);
        response->place = rr_place_along(response->place, resolution->range,
                                         peak_offset_m(&response->range, resolution->range_m));
        take_cut(&response->cross, profiles, response->place, resolution->cross,
                 resolution->cross_m);
        response->place = rr_place_along(response->place, resolution->cross,
                                         peak_offset_m(&response->cross, resolution->cross_m));
    }
    take_cut(&response->range, profiles, response->place, resolution->range, resolution->range_m);
    take_cut(&response->cross, profiles, response->place, resolution->cross, resolution->cross_m);
    response->power = response->range.power[MIDDLE];
    rr_cut_measure(&response->range);
    rr_cut_measure(&response->cross);
}

static double along(struct rr_place a, struct rr_place b, struct rr_place direction)
{
    return (a.x - b.x) * direction.x + (a.y - b.y) * direction.y;
}

static bool is_isolated(const struct rr_image *image, const struct rr_resolution *r, int column,
                        int row)
{
    const int reach = (int)(isolation_m / image->pixel_m), side = image->side_px;
    const struct rr_place centre = rr_image_place(image, column, row);
    const double peak = image->power[(size_t)row * (size_t)side + (size_t)column];
    if (column < reach || row < reach || column >= side - reach || row >= side - reach) {
        return false;
    }
    for (int y = row - reach; y <= row + reach; y++) {
        for (int x = column - reach; x <= column + reach; x++) {
            const struct rr_place place = rr_image_place(image, x, y);
            const bool is_own = fabs(along(place, centre, r->range)) < 2 * r->range_m &&
                                fabs(along(place, centre, r->cross)) < 2 * r->cross_m;
            const double limit = is_own ? peak : peak * pow(10, -isolation_db / 10);
            if (image->power[(size_t)y * (size_t)side + (size_t)x] > limit) {
                return false;
            }
        }
    }
    return true;
}

static bool is_local_peak(const struct rr_image *image, int column, int row)
{
    const size_t side = (size_t)image->side_px;
    const double *p = image->power + (size_t)row * side + (size_t)column;
    return p[0] >= p[-1] && p[0] >= p[1] && p[0] >= p[-(ptrdiff_t)side] && p[0] >= p[side];
}

int rr_find_reflectors(const struct rr_image *image, const struct rr_resolution *resolution,
                       struct rr_place *found, int most)
{
    double *power = malloc((size_t)most * sizeof *power);
    int count = 0;
    for (int row = 1; power && row < image->side_px - 1; row++) {
        for (int column = 1; column < image->side_px - 1; column++) {
            const double here = image->power[(size_t)row * (size_t)image->side_px + (size_t)column];
            if (!is_local_peak(image, column, row) || (count == most && here <= power[most - 1]) ||
                !is_isolated(image, resolution, column, row)) {
                continue;
            }
            int place = count < most ? count++ : most - 1;
            for (; place > 0 && power[place - 1] < here; place--) {
                power[place] = power[place - 1];
                found[place] = found[place - 1];
            }
            power[place] = here;
            found[place] = rr_image_place(image, column, row);
        }
    }
    free(power);
    return count;
}
