#include "tracer/coherent.h"

#include "tracer/ends.h"
#include "tracer/origin.h"
#include "tracer/vec.h"
#include "tracer/wave.h"

#include <string.h>

static const double pi = 3.14159265358979323846;
static const double resolved_turns = 0.5; /* over the width of a tube: as far as samples tell */

/* Axes of a record's normal: across, away, up. */
struct tube {
    struct vec sight;       /* of the receiver, to where the tube ends */
    struct vec along;       /* where its waves go */
    struct vec right, rise; /* to the rays beside it: one step of the plane, on one wave front */
    double area_m2;         /* of the plane at the centre that the ray stands for */
    double wider;           /* than there, where the tube ends, and the field as much weaker */
    double gain;            /* of the field on the way back, over that from the centre */
    double complex field;
    struct wave wave; /* in its place, where the law follows the electric vector */
};

struct adder {
    const struct trace_records *records;
    const struct reflect_law *law;
    uint64_t seed;
    double sign;
    bool is_plain;
    struct ends ends;    /* in the axes of the records */
    struct vec received; /* polarisation, where the law follows it */
};

static bool is_followed(const struct adder *a)
{
    return a->law->channel != REFLECT_AS_LAW;
}

static struct vec normal_of(const struct trace_record *t)
{
    return (struct vec){(double)t->normal[0], (double)t->normal[1], (double)t->normal[2]};
}

static struct vec mirrored(struct vec v, struct vec normal)
{
    return vec_mad(v, normal, -2 * vec_dot(v, normal));
}

/* Where the tube beside this one is, a step along `axis` on the plane: on one front with it. */
static struct vec beside(const struct adder *a, const struct ends_primary *p, struct vec axis,
                         double step_m)
{
    const double far_m = a->ends.out.distance_m;
    const struct vec on_front = vec_mad(axis, p->along, -vec_dot(axis, p->along));
    return vec_scale(on_front, far_m > 0 ? step_m * far_m / (far_m + p->way_m) : step_m);
}

static struct tube primary_tube(const struct adder *a, uint32_t ray)
{
    const struct trace_sensor *s = &a->records->sensor;
    const struct trace_axes *x = &a->ends.out.axes;
    const double across_m = s->low_across_m + (ray % s->columns + 0.5) * s->step_across_m;
    const double up_m = s->low_up_m + (ray / s->columns + 0.5) * s->step_up_m;
    const struct ends_primary p = ends_primary(&a->ends, across_m, up_m);
    return (struct tube){
        .sight = x->sight,
        .along = p.along,
        .right = beside(a, &p, x->across, s->step_across_m),
        .rise = beside(a, &p, x->rise, s->step_up_m),
        .area_m2 = ends_ray_m2(a->records, ray),
        .wider = 1,
        .gain = 1,
        .field = a->sign,
        .wave = wave_of(wave_sent(a->law->channel, x)),
    };
}

/* What ends that are not plain change at the end of the way. */
static void end_tube(const struct adder *a, struct tube *u, uint32_t b,
                     const struct trace_record *t)
{
    const struct vec place = origin_of(a->records, b, t).places[b];
    const struct end_view view = end_view(&a->ends.back, place);
    const double far_m = a->ends.out.distance_m;
    u->sight = view.along;
    u->gain = sqrt(ends_gain(&a->ends, place));
    if (far_m > 0) {
        /* The way out is the whole way less the way back. */
        u->wider = 1 + (2 * (double)t->range_m - view.way_m) / far_m;
        u->right = vec_scale(u->right, u->wider);
        u->rise = vec_scale(u->rise, u->wider);
    }
}

static void reflect_tube(const struct adder *a, struct tube *u, const struct trace_record *t)
{
    const struct vec normal = normal_of(t);
    if (is_followed(a)) {
        const struct reflect_pair pair = reflect_pair_of(a->law, t);
        u->wave = wave_reflected(&u->wave, u->along, normal, &pair);
    } else {
        u->field *= reflect_field_of(a->law, t).specular;
    }
    u->along = mirrored(u->along, normal);
    u->right = mirrored(u->right, normal);
    u->rise = mirrored(u->rise, normal);
}

/* The tube that meets record `t` of bounce `b`. */
static struct tube tube_of(const struct adder *a, uint32_t b, const struct trace_record *t)
{
    const struct trace_record *way[TRACE_BOUNCES_MAX], *last = t;
    for (uint32_t i = b; i > 0; i--) {
        t = &a->records->bounces[i - 1].records[t->parent];
        way[i - 1] = t;
    }
    struct tube tube = primary_tube(a, t->ray);
    for (uint32_t i = 0; i < b; i++) {
        reflect_tube(a, &tube, way[i]);
    }
    if (!a->is_plain) {
        end_tube(a, &tube, b, last);
    }
    return tube;
}

/* How much longer the way to the radar is, in turns of phase, for the ray `beside` this one, when
 * both meet a plane of that normal. */
static double turns_beside(const struct adder *a, const struct tube *u, struct vec normal,
                           struct vec beside)
{
    const double further_m = -vec_dot(normal, beside) / vec_dot(normal, u->along);
    const struct vec on_plane = vec_mad(beside, u->along, further_m);
    return (further_m + vec_dot(on_plane, u->sight)) / a->records->look.wavelength_m;
}

/* Mean of a phase that turns so often. */
static double mean_of_turns(double turns)
{
    const double x = pi * turns;
    return fabs(x) > 1e-6 ? sin(x) / x : 1;
}

/* Share of the tube's field that goes back to the radar from a plane of that normal. */
static double share_back(const struct adder *a, const struct tube *u, struct vec normal)
{
    const double aside = turns_beside(a, u, normal, u->right);
    const double above = turns_beside(a, u, normal, u->rise);
    return fmax(fabs(aside), fabs(above)) <= resolved_turns
               ? mean_of_turns(aside) * mean_of_turns(above)
               : 0;
}

/* splitmix64 of S. Vigna. */
static uint64_t mix(uint64_t x)
{
    x += 0x9e3779b97f4a7c15U;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9U;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebU;
    return x ^ (x >> 31);
}

/* `scattering`: 0 or 1, of the two that one place has. */
static double complex drawn_phase(const struct adder *a, uint32_t b, const struct trace_record *t,
                                  uint64_t scattering)
{
    const uint64_t drawn = mix(a->seed ^ mix(scattering << 40 | (uint64_t)b << 32 | t->ray));
    return cexp(I * (2 * pi * 0x1p-53 * (double)(drawn >> 11)));
}

/* What returns of the tube's end, for a mirror straight on and for a rough place of share 1. */
static double complex followed_field(const struct adder *a, const struct tube *u, uint32_t b,
                                     const struct trace_record *t, double mirror, double rough)
{
    const struct reflect_pair pair = reflect_pair_of(a->law, t);
    const struct vec normal = normal_of(t), back = vec_scale(u->sight, -1);
    const struct wave smooth = wave_optics(&u->wave, u->along, normal, back, &pair);
    const struct wave scattered = wave_scattered(&u->wave, u->along, normal, back, a->law, t,
                                                 drawn_phase(a, b, t, 0), drawn_phase(a, b, t, 1));
    return mirror * wave_dot(&smooth, a->received) * cexp(I * (double)t->phase_rad) +
           rough * wave_dot(&scattered, a->received);
}

static double complex field_of(const struct adder *a, uint32_t b, const struct trace_record *t)
{
    const struct tube tube = tube_of(a, b, t);
    const bool is_ground = b == 0 && strcmp(a->records->materials[t->material], "ground") == 0;
    const double back = is_ground ? 0 : share_back(a, &tube, normal_of(t));
    const double mirror =
        sqrt(4 * pi) / a->records->look.wavelength_m * tube.area_m2 * tube.wider * back;
    const double rough = sqrt(4 * tube.area_m2);
    if (is_followed(a)) {
        return tube.gain * followed_field(a, &tube, b, t, mirror, rough);
    }
    const struct reflect_field f = reflect_field_of(a->law, t);
    return tube.field * tube.gain *
           (mirror * f.specular * cexp(I * (double)t->phase_rad) +
            rough * sqrt(f.scattered) * drawn_phase(a, b, t, 0));
}

void coherent_echoes(const struct trace_records *r, const struct reflect_law *law, uint64_t seed,
                     void (*take)(void *ctx, const struct coherent_echo *echo), void *ctx)
{
    /* Fresnel's VV is that of the magnetic field. The electric one of the way back is turned. */
    struct adder a = {.records = r,
                      .law = law,
                      .seed = mix(seed),
                      .sign = reflect_is_vv(law) ? -1 : 1,
                      .is_plain = ends_are_plain(&r->ends),
                      .ends = ends_of(&r->look, &r->ends, ENDS_OF_PICTURE)};
    a.received = wave_received(law->channel, &a.ends.back.axes);
    for (uint32_t b = 0; b < r->bounce_count; b++) {
        for (uint32_t i = 0; i < r->bounces[b].count; i++) {
            const struct trace_record *t = &r->bounces[b].records[i];
            if (!(t->flags & TRACE_BLOCKED)) {
                const struct coherent_echo echo = {(double)t->across_m, (double)t->range_m,
                                                   field_of(&a, b, t)};
                take(ctx, &echo);
            }
        }
    }
}

static void add_to_total(void *ctx, const struct coherent_echo *echo)
{
    *(double complex *)ctx += echo->field;
}

double complex coherent_total(const struct trace_records *r, const struct reflect_law *law,
                              uint64_t seed)
{
    double complex total = 0;
    coherent_echoes(r, law, seed, add_to_total, &total);
    return total;
}
