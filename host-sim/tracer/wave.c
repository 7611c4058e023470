#include "tracer/wave.h"

static struct wave plus(struct wave e, double complex k, struct vec axis)
{
    return (struct wave){e.x + k * axis.x, e.y + k * axis.y, e.z + k * axis.z};
}

static struct wave cross(const struct wave *e, struct vec axis)
{
    return (struct wave){e->y * axis.z - e->z * axis.y, e->z * axis.x - e->x * axis.z,
                         e->x * axis.y - e->y * axis.x};
}

static struct wave sum(struct wave a, struct wave b, double complex k)
{
    return (struct wave){a.x + k * b.x, a.y + k * b.y, a.z + k * b.z};
}

static bool sends_h(enum reflect_channel channel)
{
    return channel == REFLECT_HH || channel == REFLECT_VH;
}

static bool receives_h(enum reflect_channel channel)
{
    return channel == REFLECT_HH || channel == REFLECT_HV;
}

struct vec wave_sent(enum reflect_channel channel, const struct trace_axes *axes)
{
    return sends_h(channel) ? axes->across : axes->rise;
}

struct vec wave_received(enum reflect_channel channel, const struct trace_axes *axes)
{
    return receives_h(channel) ? axes->across : axes->rise;
}

struct wave wave_of(struct vec electric)
{
    return (struct wave){electric.x, electric.y, electric.z};
}

double complex wave_dot(const struct wave *e, struct vec axis)
{
    return e->x * axis.x + e->y * axis.y + e->z * axis.z;
}

/* H of a place: square to its normal and to the way. Along the normal any will do: `otherwise`. */
static struct vec level_of(struct vec normal, struct vec way, struct vec otherwise)
{
    const struct vec level = vec_cross(normal, way);
    const double length = vec_length(level);
    return length > 1e-9 ? vec_scale(level, 1 / length) : otherwise;
}

static struct vec any_square_to(struct vec way)
{
    const struct vec axis = fabs(way.x) < 0.6 ? (struct vec){1, 0, 0} : (struct vec){0, 1, 0};
    const struct vec square = vec_cross(axis, way);
    return vec_scale(square, 1 / vec_length(square));
}

static struct vec mirrored(struct vec v, struct vec normal)
{
    return vec_mad(v, normal, -2 * vec_dot(v, normal));
}

/* The V that goes with H of a way. Fresnel's VV is the coefficient of the magnetic field, and so of
 * the electric one along these. */
static struct vec upright_of(struct vec level, struct vec way)
{
    return vec_cross(level, way);
}

struct wave wave_reflected(const struct wave *e, struct vec along, struct vec normal,
                           const struct reflect_pair *pair)
{
    const struct vec level = level_of(normal, along, any_square_to(along));
    const struct vec upright = upright_of(level, along);
    const struct vec on = upright_of(level, mirrored(along, normal));
    const struct wave none = {0, 0, 0};
    return plus(plus(none, pair->hh * wave_dot(e, level), level), pair->vv * wave_dot(e, upright),
                on);
}

/* way x e: the magnetic field, in the units of the electric one. */
static struct wave magnetic(const struct wave *e, struct vec way)
{
    return cross(e, vec_scale(way, -1));
}

struct wave wave_optics(const struct wave *e, struct vec along, struct vec normal, struct vec back,
                        const struct reflect_pair *pair)
{
    const struct wave on = wave_reflected(e, along, normal, pair);
    const struct wave electric = sum(*e, on, 1);
    const struct wave total = sum(magnetic(e, along), magnetic(&on, mirrored(along, normal)), 1);
    const struct wave current = cross(&total, vec_scale(normal, -1)); /* normal x total */
    const struct wave other = cross(&electric, normal);
    const struct wave radiated = sum(current, cross(&other, back), 1);
    const double lit = -vec_dot(along, normal); /* the plane is larger than the wave front */
    const struct wave none = {0, 0, 0};
    return plus(sum(none, radiated, -0.5 / lit), 0.5 / lit * wave_dot(&radiated, back), back);
}

struct wave wave_scattered(const struct wave *e, struct vec along, struct vec normal,
                           struct vec back, const struct reflect_law *law,
                           const struct trace_record *t, double complex kept,
                           double complex crossed)
{
    const struct vec level = level_of(normal, along, any_square_to(along));
    const struct vec upright = upright_of(level, along);
    const struct vec level_back = level_of(normal, back, level);
    const struct vec upright_back = upright_of(level_back, back);
    const double cosine = vec_dot(level, level_back);
    const double sine = vec_dot(normal, vec_cross(level, level_back));
    const struct reflect_rough rough = reflect_rough_of(law, t, cosine, sine);
    const double complex h = wave_dot(e, level), v = wave_dot(e, upright);
    const struct wave none = {0, 0, 0};
    return plus(
        plus(none, kept * (rough.hh * h + rough.hv * v) - crossed * rough.crossed * v, level_back),
        kept * (rough.vh * h + rough.vv * v) + crossed * rough.crossed * h, upright_back);
}
