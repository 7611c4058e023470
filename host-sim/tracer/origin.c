#include "tracer/origin.h"

#include "tracer/ends.h"

static const double pi = 3.14159265358979323846;

static struct vec normal_of(const struct trace_record *t)
{
    return (struct vec){(double)t->normal[0], (double)t->normal[1], (double)t->normal[2]};
}

struct origin origin_of(const struct trace_records *r, uint32_t b, const struct trace_record *t)
{
    const struct trace_record *way[TRACE_BOUNCES_MAX];
    const double psi = r->look.depression_deg * pi / 180;
    const double column = t->ray % r->sensor.columns, row = t->ray / r->sensor.columns;
    const double left_up_m = r->sensor.low_up_m + (row + 0.5) * r->sensor.step_up_m;
    const struct vec sight = {0, cos(psi), -sin(psi)}, rise = {0, sin(psi), cos(psi)};
    struct origin o = {.count = b + 1};
    const double range_m = (double)t->range_m;
    way[b] = t;
    for (uint32_t i = b; i > 0; i--) {
        way[i - 1] = &r->bounces[i - 1].records[way[i]->parent];
    }
    struct vec along = sight, at = vec_scale(rise, left_up_m);
    at.x = r->sensor.low_across_m + (column + 0.5) * r->sensor.step_across_m;
    if (r->ends.distance_m > 0) {
        const struct ends ends = ends_of(&r->look, &r->ends, ENDS_OF_PICTURE);
        along = end_view(&ends.out, at).along;
    }
    for (uint32_t i = 0; i <= b; i++) {
        const struct vec normal = normal_of(way[i]);
        at = o.places[i] = vec_mad(at, along, (double)way[i]->hop_m);
        along = vec_mad(along, normal, -2 * vec_dot(along, normal));
    }
    o.elevation_m = (left_up_m + vec_dot(at, rise)) / 2;
    o.height_m = o.elevation_m * cos(psi) - range_m * sin(psi);
    return o;
}
