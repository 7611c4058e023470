#include "tracer/coherent.h"

#include "tracer/vec.h"

#include <string.h>

static const double pi = 3.14159265358979323846;
static const double resolved_turns = 0.5; /* over the width of a tube: as far as samples tell */

/* Axes of a record's normal: across, away, up. */
struct tube {
    struct vec sight;       /* of the radar */
    struct vec along;       /* where its waves go */
    struct vec right, rise; /* to the rays beside it: one step of the plane, on one wave front */
    double complex field;
};

struct adder {
    const struct trace_records *records;
    const struct reflect_law *law;
    uint64_t seed;
    double sign, tube_m2;
};

static struct vec normal_of(const struct trace_record *t)
{
    return (struct vec){(double)t->normal[0], (double)t->normal[1], (double)t->normal[2]};
}

static struct vec mirrored(struct vec v, struct vec normal)
{
    return vec_mad(v, normal, -2 * vec_dot(v, normal));
}

static struct tube primary_tube(const struct adder *a)
{
    const struct trace_records *r = a->records;
    const double psi = r->look.depression_deg * pi / 180;
    const struct vec sight = {0, cos(psi), -sin(psi)};
    return (struct tube){
        .sight = sight,
        .along = sight,
        .right = {r->sensor.step_across_m, 0, 0},
        .rise = vec_scale((struct vec){0, sin(psi), cos(psi)}, r->sensor.step_up_m),
        .field = a->sign,
    };
}

static void reflect_tube(const struct adder *a, struct tube *u, const struct trace_record *t)
{
    const struct vec normal = normal_of(t);
    u->along = mirrored(u->along, normal);
    u->right = mirrored(u->right, normal);
    u->rise = mirrored(u->rise, normal);
    u->field *= reflect_field_of(a->law, t).specular;
}

/* The tube that meets record `t` of bounce `b`. */
static struct tube tube_of(const struct adder *a, uint32_t b, const struct trace_record *t)
{
    const struct trace_record *way[TRACE_BOUNCES_MAX];
    for (uint32_t i = b; i > 0; i--) {
        t = &a->records->bounces[i - 1].records[t->parent];
        way[i - 1] = t;
    }
    struct tube tube = primary_tube(a);
    for (uint32_t i = 0; i < b; i++) {
        reflect_tube(a, &tube, way[i]);
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

static double complex drawn_phase(const struct adder *a, uint32_t b, const struct trace_record *t)
{
    const uint64_t drawn = mix(a->seed ^ mix((uint64_t)b << 32 | t->ray));
    return cexp(I * (2 * pi * 0x1p-53 * (double)(drawn >> 11)));
}

static double complex field_of(const struct adder *a, uint32_t b, const struct trace_record *t)
{
    const struct tube tube = tube_of(a, b, t);
    const struct reflect_field f = reflect_field_of(a->law, t);
    const bool is_ground = b == 0 && strcmp(a->records->materials[t->material], "ground") == 0;
    const double back = is_ground ? 0 : share_back(a, &tube, normal_of(t));
    const double mirror = sqrt(4 * pi) / a->records->look.wavelength_m * a->tube_m2 * back;
    const double rough = sqrt(4 * f.scattered * a->tube_m2);
    return tube.field *
           (mirror * f.specular * cexp(I * (double)t->phase_rad) + rough * drawn_phase(a, b, t));
}

void coherent_echoes(const struct trace_records *r, const struct reflect_law *law, uint64_t seed,
                     void (*take)(void *ctx, const struct coherent_echo *echo), void *ctx)
{
    /* Fresnel's VV is that of the magnetic field. The electric one of the way back is turned. */
    const struct adder a = {r, law, mix(seed), reflect_is_vv(law) ? -1 : 1,
                            r->sensor.step_across_m * r->sensor.step_up_m};
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
