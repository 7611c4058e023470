#include "tile_work.h"

static const double pi = 3.14159265358979323846;

/* Inverse cosine, to 3e-7: Abramowitz and Stegun, 4.4.46. A call of acos() would take a sixth of
 * the tracer's time. What is passed on is 1 - |cosine|, of which single precision loses nothing. */
static float angle_of(double cosine)
{
    static const float a[8] = {1.5707963050f, -0.2145988016f, 0.0889789874f, -0.0501743046f,
                               0.0308918810f, -0.0170881256f, 0.0066700901f, -0.0012624911f};
    const double short_of_one = 1 - fabs(cosine);
    const float y = short_of_one > 0 ? (float)short_of_one : 0, x = 1 - y;
    const float high = ((a[7] * x + a[6]) * x + a[5]) * x + a[4];
    const float low = ((a[3] * x + a[2]) * x + a[1]) * x + a[0];
    const float angle = sqrtf(y) * (high * (x * x) * (x * x) + low);
    return cosine < 0 ? (float)pi - angle : angle;
}

bool ray_angles_at(const struct trace_tiles *t, uint32_t facet, struct vec along, uint32_t bounce,
                   struct ray_angles *g)
{
    const struct trace_axes *axes = &t->axes;
    const struct scene_facet *plane = &t->scene->facets[facet];
    const double pace = vec_dot(plane->normal, along);
    const struct vec normal = pace > 0 ? vec_scale(plane->normal, -1) : plane->normal;
    const double echo_cos = -vec_dot(normal, axes->sight);
    struct trace_record *r = &g->record;
    g->plane = plane;
    g->normal = normal;
    g->along = vec_mad(along, normal, 2 * fabs(pace));
    g->pace = pace;
    r->incidence_rad = angle_of(fabs(pace));
    r->echo_rad = bounce == 0 ? r->incidence_rad : angle_of(echo_cos);
    r->turn_rad = bounce == 0 ? 0 : angle_of(vec_dot(along, axes->sight));
    r->normal[0] = (float)vec_dot(normal, axes->across);
    r->normal[1] = (float)vec_dot(normal, axes->away);
    r->normal[2] = (float)normal.z;
    r->material = t->scene->facet_materials[facet];
    r->flags = (uint8_t)(echo_cos > 0 ? 0 : TRACE_BLOCKED);
    r->reserved = 0;
    return fabs(pace) >= TILE_GRAZING_COS;
}

void ray_angles_apart(struct ray_angles *g, struct vec along, struct vec seen)
{
    const double echo_cos = -vec_dot(g->normal, seen);
    g->record.echo_rad = angle_of(echo_cos);
    g->record.turn_rad = angle_of(vec_dot(along, seen));
    g->record.flags = (uint8_t)(echo_cos > 0 ? 0 : TRACE_BLOCKED);
}
