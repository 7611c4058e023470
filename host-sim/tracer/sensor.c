#include "tracer/sensor.h"

#include "tracer/ends.h"

#include <math.h>

static const double pi = 3.14159265358979323846;

/* Highest place on the plane where something may stand that is focused before far_m. A point at
 * (away, up) is focused at range = away cos - up sin and seen at height = away sin + up cos. */
static double top_of(const struct scene *s, double psi, double far_m)
{
    const double reach =
        hypot(fmax(fabs(s->low.x), fabs(s->high.x)), fmax(fabs(s->low.y), fabs(s->high.y)));
    const double up_m = fmax(s->high.z, 0);
    return fmin(far_m * tan(psi) + up_m / cos(psi), reach * sin(psi) + up_m * cos(psi));
}

struct trace_sensor trace_sensor_for(const struct scene *s, const struct trace_order *o)
{
    if (!ends_are_plain(&o->ends)) {
        return ends_sensor_for(s, o);
    }
    const double psi = o->look.depression_deg * pi / 180;
    const double width_m = o->grid.cells_across * o->grid.cell_m;
    const double far_m = o->grid.cells_range * o->grid.cell_m / 2;
    const double step_m = o->grid.cell_m / o->rays_per_cell, step_up_m = step_m * fmin(1, tan(psi));
    const double low_m = -far_m * tan(psi);
    const double high_m = fmax(far_m * tan(psi), top_of(s, psi, far_m));
    return (struct trace_sensor){
        .columns = o->grid.cells_across * o->rays_per_cell,
        .rows = (uint32_t)fmin(ceil((high_m - low_m) / step_up_m - 1e-9), TRACE_RAYS_MAX),
        .step_across_m = step_m,
        .step_up_m = step_up_m,
        .low_across_m = -width_m / 2,
        .low_up_m = low_m,
    };
}

double trace_ground_half_m(const struct trace_grid *grid, double depression_deg)
{
    const double across_m = grid->cells_across * grid->cell_m / 2;
    const double away_m = grid->cells_range * grid->cell_m / 2 / cos(depression_deg * pi / 180);
    return hypot(across_m, away_m) + grid->cell_m;
}

struct trace_axes trace_axes_of(const struct trace_look *look)
{
    const double azimuth = look->azimuth_deg * pi / 180, psi = look->depression_deg * pi / 180;
    struct trace_axes a;
    a.away = (struct vec){-cos(azimuth), sin(azimuth), 0};
    a.across = (struct vec){sin(azimuth), cos(azimuth), 0};
    a.sight = vec_mad(vec_scale(a.away, cos(psi)), (struct vec){0, 0, 1}, -sin(psi));
    a.rise = vec_mad(vec_scale(a.away, sin(psi)), (struct vec){0, 0, 1}, cos(psi));
    return a;
}
