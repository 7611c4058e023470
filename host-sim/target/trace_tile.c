#include "trace_tile.h"

static const double pi = 3.14159265358979323846;

/* New rays start this far off the surface, so that they do not meet it again. It is a hundred times
 * the rounding of Embree's single precision 10 m from the centre. */
static const double lift_m = 1e-4;

/* A surface seen more edge-on than this is taken for missed: where single precision says that the
 * ray meets it and where its plane is met could differ by centimetres. */
static const double grazing_cos_min = 2e-4;

/* A ray under way. */
struct flight {
    struct vec from, along;
    struct vec start; /* `from`, lifted off its surface: where Embree's ray begins */
    double across_m;  /* where its primary ray left the plane */
    double way_m;     /* from the plane through the origin to `from` */
    uint32_t ray, parent;
};

/* What one bounce of the tile leaves behind. */
struct wave {
    struct flight flights[TILE_RAYS];
    uint32_t facets[TILE_RAYS];
    uint32_t count;
};

static double clear_of_model_m(const struct scene *s)
{
    return fmax(vec_length(s->low), vec_length(s->high)) + 1;
}

static void start_wave(const struct trace_tiles *t, uint32_t first, struct wave *w)
{
    const struct trace_sensor *sensor = &t->sensor;
    const uint32_t rays = sensor->columns * sensor->rows;
    const double clear_m = clear_of_model_m(t->scene), sink = t->axes.rise.z / t->axes.sight.z;
    w->count = rays - first < TILE_RAYS ? rays - first : TILE_RAYS;
    for (uint32_t i = 0; i < w->count; i++) {
        const uint32_t ray = first + i;
        const double across_m =
            sensor->low_across_m + (ray % sensor->columns + 0.5) * sensor->step_across_m;
        const double up_m = sensor->low_up_m + (ray / sensor->columns + 0.5) * sensor->step_up_m;
        /* Outside the model, and above the ground where the plane dips below it. */
        const double back_m = clear_m + (up_m < 0 ? up_m * sink : 0);
        const struct vec on_plane =
            vec_mad(vec_scale(t->axes.across, across_m), t->axes.rise, up_m);
        const struct vec from = vec_mad(on_plane, t->axes.sight, -back_m);
        w->flights[i] = (struct flight){from, t->axes.sight, from, across_m, -back_m, ray, 0};
    }
}

static void meet_wave(const struct trace_tiles *t, struct wave *w, struct bare_rays *bare)
{
    for (uint32_t i = 0; i < w->count; i += SCENE_PACKET) {
        struct scene_rays rays;
        rays.count = w->count - i < SCENE_PACKET ? w->count - i : SCENE_PACKET;
        for (uint32_t k = 0; k < rays.count; k++) {
            rays.from[k] = w->flights[i + k].start;
            rays.along[k] = w->flights[i + k].along;
        }
        scene_meet(t->scene, &rays, &w->facets[i]);
        if (bare) {
            bare_keep(bare, &rays, false);
        }
    }
}

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

/* An angle of so many turns, without the whole ones. */
static float angle_of_turns(double turns)
{
    return (float)(2 * pi * (turns - (double)lrint(turns)));
}

/* Record the reflection of flight `f`, number `bounce` of its ray, at a plane, and turn the flight
 * into its specular ray. */
static struct trace_record reflect(const struct trace_tiles *t, struct flight *f, uint32_t bounce,
                                   const struct scene_facet *plane)
{
    const struct trace_axes *axes = &t->axes;
    const double slope = vec_dot(plane->normal, f->along);
    const struct vec normal = slope > 0 ? vec_scale(plane->normal, -1) : plane->normal;
    const double hop_m = (plane->offset_m - vec_dot(plane->normal, f->from)) / slope;
    const struct vec at = vec_mad(f->from, f->along, hop_m);
    const double echo_cos = -vec_dot(normal, axes->sight);
    const float incidence_rad = angle_of(fabs(slope));
    f->way_m += hop_m;
    const double range_m = (f->way_m + vec_dot(at, axes->sight)) / 2;
    const struct trace_record record = {
        .ray = f->ray,
        .parent = f->parent,
        .across_m = (float)((f->across_m + vec_dot(at, axes->across)) / 2),
        .range_m = (float)range_m,
        .phase_rad = angle_of_turns(range_m * t->turns_per_m),
        .hop_m = (float)(bounce == 0 ? f->way_m : hop_m),
        .incidence_rad = incidence_rad,
        .echo_rad = bounce == 0 ? incidence_rad : angle_of(echo_cos),
        .turn_rad = bounce == 0 ? 0 : angle_of(vec_dot(f->along, axes->sight)),
        .normal = {(float)vec_dot(normal, axes->across), (float)vec_dot(normal, axes->away),
                   (float)normal.z},
        .flags = (uint8_t)(echo_cos > 0 ? 0 : TRACE_BLOCKED),
    };
    f->from = at;
    f->start = vec_mad(at, normal, lift_m);
    f->along = vec_mad(f->along, normal, 2 * fabs(slope));
    return record;
}

/* Make records of the flights that met something, mark their parents, and keep those flights only.
 */
static void reflect_wave(const struct trace_tiles *t, struct wave *w, uint32_t b,
                         struct tile_result *result)
{
    struct trace_bounce *bounce = &result->bounces[b];
    for (uint32_t i = 0; i < w->count; i++) {
        const uint32_t facet = w->facets[i];
        struct flight f = w->flights[i];
        if (facet == SCENE_MISS ||
            fabs(vec_dot(t->scene->facets[facet].normal, f.along)) < grazing_cos_min) {
            continue;
        }
        if (b > 0) {
            bounce[-1].records[f.parent].flags |= TRACE_GOES_ON;
        }
        struct trace_record *record = &bounce->records[bounce->count];
        *record = reflect(t, &f, b, &t->scene->facets[facet]);
        record->material = t->scene->facet_materials[facet];
        f.parent = bounce->count;
        w->flights[bounce->count++] = f;
    }
    w->count = bounce->count;
}

/* Look back at the radar from where each flight starts. Returns the number of rays. */
static uint32_t look_back(const struct trace_tiles *t, const struct wave *w,
                          struct trace_bounce *bounce, struct bare_rays *bare)
{
    struct scene_rays rays;
    uint32_t asker[SCENE_PACKET], cast = 0;
    rays.count = 0;
    for (uint32_t i = 0; i < w->count; i++) {
        if (!(bounce->records[i].flags & TRACE_BLOCKED)) {
            asker[rays.count] = i;
            rays.from[rays.count] = w->flights[i].start;
            rays.along[rays.count++] = vec_scale(t->axes.sight, -1);
        }
        if (rays.count == SCENE_PACKET || (i + 1 == w->count && rays.count > 0)) {
            const uint32_t blocked = scene_is_blocked(t->scene, &rays);
            for (uint32_t k = 0; k < rays.count; k++) {
                bounce->records[asker[k]].flags |= blocked >> k & 1 ? TRACE_BLOCKED : 0;
            }
            if (bare) {
                bare_keep(bare, &rays, true);
            }
            cast += rays.count;
            rays.count = 0;
        }
    }
    return cast;
}

void trace_tile(const struct trace_tiles *t, uint32_t index, struct tile_result *result)
{
    struct wave w;
    start_wave(t, index * TILE_RAYS, &w);
    for (uint32_t b = 0; b < t->bounces && w.count > 0; b++) {
        result->rays_cast += w.count;
        meet_wave(t, &w, result->bare);
        reflect_wave(t, &w, b, result);
        if (b == 0) {
            continue; /* the way back is the way the primary ray came */
        }
        result->rays_cast += look_back(t, &w, &result->bounces[b], result->bare);
    }
}
