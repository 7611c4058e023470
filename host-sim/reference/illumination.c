/* What the radar sees: EQUATIONS.md, "Illumination". */
#include "reference/reference.h"

#include <math.h>

double ref_tangent(double antenna_m, double range_m, double top_m)
{
    return (top_m - antenna_m - range_m * range_m / (2 * REF_EFFECTIVE_EARTH_M)) / range_m;
}

double ref_grazing(const struct ref_view *view, double range_m, double before_m)
{
    const double flat =
        (view->antenna_m - view->reference_m) / range_m - before_m / (2 * REF_EFFECTIVE_EARTH_M);
    return fmax(flat, 1.0 / 256);
}

double ref_gain_db(const struct ref_view *view, double range_m, double before_m)
{
    return 10 * log10(before_m / (view->cell_m * ref_grazing(view, range_m, before_m)));
}

size_t ref_first_shown(const struct ref_bin *bins, size_t count, const struct ref_view *view)
{
    size_t first = 0;
    while (first < count && bins[first].range_m < fmax(256, view->antenna_m / 2)) {
        first++;
    }
    return first;
}

static double bin_tangent(const struct ref_bin *bin, double antenna_m)
{
    return ref_tangent(antenna_m, bin->range_m, bin->elevation_m + bin->height_m);
}

double ref_gm_horizon(const struct ref_bin *first, const struct ref_view *view)
{
    return bin_tangent(first, view->antenna_m) -
           ref_grazing(view, first->range_m, first->range_m) * view->cell_m / first->range_m;
}

double ref_behind_foreground(const struct ref_bin *bins, size_t count, const struct ref_view *view,
                             double horizon)
{
    const size_t first = ref_first_shown(bins, count, view);
    if (first >= count) {
        return horizon;
    }
    const double tangent = bin_tangent(&bins[first], view->antenna_m);
    const double rise =
        first + 1 < count ? bin_tangent(&bins[first + 1], view->antenna_m) - tangent : 0;
    return fmax(horizon, rise > 0 ? tangent - rise : ref_gm_horizon(&bins[first], view));
}

double ref_highest_tangent(const struct ref_bin *bins, size_t count, double antenna_m)
{
    double highest = -INFINITY;
    for (size_t i = 0; i < count; i++) {
        highest = fmax(highest, bin_tangent(&bins[i], antenna_m));
    }
    return highest;
}

/* Where the line is behind its last shore. */
struct shore {
    int cells_since; /* -1: no water yet, or in it */
    bool is_after_water;
};

/* The far shore is a ramp of whole steps of 1/256 dB, as EQUATIONS.md defines it: that rounding is
 * part of the equation, not of the arithmetic. */
static double shore_db(struct shore *shore, const struct ref_bin *bin,
                       const struct ref_params *params, double cell_m)
{
    if (bin->kind == LM_KIND_WATER) {
        *shore = (struct shore){-1, true};
        return 0;
    }
    if (shore->is_after_water) {
        *shore = (struct shore){0, false};
    } else if (shore->cells_since >= 0) {
        shore->cells_since++;
    }
    if (shore->cells_since < 0) {
        return 0;
    }
    const double full = round(params->shore_db * 256);
    const double step = floor(full / fmax(1, round(params->shore_width_m / cell_m)));
    return fmax(full - shore->cells_since * step, 0) / 256;
}

static double leading_edge_db(const struct ref_bin *before, const struct ref_bin *bin,
                              const struct ref_params *params)
{
    if (before == NULL || before->kind == bin->kind) {
        return 0;
    }
    return bin->kind == LM_KIND_STRUCTURE ? params->edge_structure_db
           : bin->kind == LM_KIND_TREES   ? params->edge_trees_db
                                          : 0;
}

void ref_raise_crests(struct ref_bin *bins, size_t count, const struct ref_view *view)
{
    const size_t first = ref_first_shown(bins, count, view);
    double before_m = first < count ? bins[first].elevation_m : 0;
    for (size_t i = first + 1; i + 2 < count; i++) {
        const double here_m = bins[i].elevation_m, next_m = bins[i + 1].elevation_m;
        const double fall_m = -ref_tangent(view->antenna_m, bins[i].range_m, here_m) * view->cell_m;
        const double from_near_m = here_m - before_m + fall_m;
        const double from_far_m = next_m - bins[i + 2].elevation_m - fall_m;
        const double rise_m = next_m - here_m + fall_m;
        const double bulge_m =
            fmin((from_near_m + from_far_m) / 16, fmin(from_near_m, from_far_m) / 4);
        bins[i].elevation_m += bulge_m > fabs(rise_m) / 2 ? rise_m / 2 + bulge_m : 0;
        before_m = here_m;
    }
}

void ref_illuminate(struct ref_bin *bins, size_t count, const struct ref_view *view,
                    const struct ref_params *params, double horizon)
{
    struct shore shore = {-1, false};
    const size_t first = ref_first_shown(bins, count, view);
    for (size_t i = 0; i < first; i++) {
        bins[i].is_lit = false;
        bins[i].horizon = horizon;
        bins[i].level_db = params->noise_floor_db;
    }
    for (size_t i = first; i < count; i++) {
        struct ref_bin *bin = &bins[i];
        const double before_m = i > first ? bin->range_m - view->cell_m : bin->range_m;
        bin->tangent = bin_tangent(bin, view->antenna_m);
        bin->horizon = horizon;
        bin->rise = bin->tangent - horizon;
        bin->is_lit = bin->rise > 0;
        bin->gain_db = ref_gain_db(view, bin->range_m, before_m);
        bin->edge_db = leading_edge_db(i > first ? bin - 1 : NULL, bin, params) +
                       shore_db(&shore, bin, params, view->cell_m);
        bin->level_db = bin->is_lit
                            ? bin->gamma_db + 10 * log10(bin->rise) + bin->gain_db + bin->edge_db
                            : params->noise_floor_db;
        horizon = fmax(horizon, bin->tangent);
    }
}
