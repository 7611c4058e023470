#include "tracer/squint.h"

#include "tracer/origin.h"

static const double pi = 3.14159265358979323846;

struct vec squint_axis(double squint_deg, double depression_deg)
{
    const double sigma = squint_deg * pi / 180, psi = depression_deg * pi / 180;
    const struct vec sight = {0, cos(psi), -sin(psi)}, flight = {cos(sigma), sin(sigma), 0};
    const struct vec axis = vec_mad(flight, sight, -vec_dot(flight, sight));
    return vec_scale(axis, 1 / vec_length(axis));
}

void squint_records(struct trace_records *r, double squint_deg)
{
    const double psi = r->look.depression_deg * pi / 180;
    const struct vec axis = squint_axis(squint_deg, r->look.depression_deg);
    const double rising = vec_dot(axis, (struct vec){0, sin(psi), cos(psi)});
    for (uint32_t b = 0; b < r->bounce_count; b++) {
        for (uint32_t i = 0; i < r->bounces[b].count; i++) {
            struct trace_record *t = &r->bounces[b].records[i];
            const double elevation_m = origin_of(r, b, t).elevation_m;
            t->across_m = (float)(axis.x * (double)t->across_m + rising * elevation_m);
        }
    }
}
