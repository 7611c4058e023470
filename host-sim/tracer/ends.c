#include "tracer/ends.h"

#include "tracer/origin.h"

bool ends_are_plain(const struct trace_ends *e)
{
    return e->distance_m == 0 && !e->is_apart;
}

struct ends ends_of(const struct trace_look *look, const struct trace_ends *e, double azimuth_deg)
{
    struct trace_look out = *look, back = *look;
    out.azimuth_deg = azimuth_deg;
    back.azimuth_deg = azimuth_deg;
    double back_m = e->distance_m;
    if (e->is_apart) {
        back.azimuth_deg += e->receiver_azimuth_deg - look->azimuth_deg;
        back.depression_deg = e->receiver_depression_deg;
        back_m = e->receiver_distance_m;
    }
    return (struct ends){{trace_axes_of(&out), e->distance_m}, {trace_axes_of(&back), back_m}};
}

struct end_view end_view(const struct end *e, struct vec place)
{
    const struct trace_axes *x = &e->axes;
    const double far_m = e->distance_m;
    if (far_m == 0) {
        return (struct end_view){x->sight, vec_dot(place, x->sight), vec_dot(place, x->across)};
    }
    const struct vec v = vec_mad(place, x->sight, far_m);
    const double length_m = vec_length(v);
    /* Nothing is lost where the distance is large. */
    const double more_m2 = vec_dot(place, place) + 2 * far_m * vec_dot(place, x->sight);
    return (struct end_view){vec_scale(v, 1 / length_m), more_m2 / (length_m + far_m),
                             far_m * vec_dot(place, x->across) / length_m};
}

struct ends_primary ends_primary(const struct ends *e, double across_m, double up_m)
{
    const struct trace_axes *x = &e->out.axes;
    const struct vec at = vec_mad(vec_scale(x->rise, up_m), x->across, across_m);
    const struct end_view view = end_view(&e->out, at);
    return (struct ends_primary){at, view.along, view.way_m, view.across_m};
}

double ends_ray_m2(const struct trace_records *r, uint32_t ray)
{
    const struct trace_sensor *s = &r->sensor;
    const double step_m2 = s->step_across_m * s->step_up_m, far_m = r->ends.distance_m;
    if (far_m == 0) {
        return step_m2;
    }
    const double across_m = s->low_across_m + (ray % s->columns + 0.5) * s->step_across_m;
    const double up_m = s->low_up_m + (ray / s->columns + 0.5) * s->step_up_m;
    return step_m2 * pow(1 + (across_m * across_m + up_m * up_m) / (far_m * far_m), -1.5);
}

double ends_gain(const struct ends *picture, struct vec place)
{
    const double far_m = picture->back.distance_m;
    return far_m == 0 ? 1 : pow(1 + end_view(&picture->back, place).way_m / far_m, -2);
}

double ends_echo_m2(const struct trace_records *r, uint32_t b, const struct trace_record *t)
{
    if (ends_are_plain(&r->ends)) {
        return r->sensor.step_across_m * r->sensor.step_up_m;
    }
    const struct ends picture = ends_of(&r->look, &r->ends, ENDS_OF_PICTURE);
    return ends_ray_m2(r, t->ray) * ends_gain(&picture, origin_of(r, b, t).places[b]);
}
