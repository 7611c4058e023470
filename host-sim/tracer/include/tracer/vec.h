/* Vectors of three doubles. */
#ifndef TRACER_VEC_H
#define TRACER_VEC_H

#include <math.h>

struct vec {
    double x, y, z;
};

static inline struct vec vec_add(struct vec a, struct vec b)
{
    return (struct vec){a.x + b.x, a.y + b.y, a.z + b.z};
}

static inline struct vec vec_scale(struct vec a, double k)
{
    return (struct vec){a.x * k, a.y * k, a.z * k};
}

/* a + k b */
static inline struct vec vec_mad(struct vec a, struct vec b, double k)
{
    return (struct vec){a.x + b.x * k, a.y + b.y * k, a.z + b.z * k};
}

static inline struct vec vec_sub(struct vec a, struct vec b)
{
    return vec_mad(a, b, -1);
}

static inline double vec_dot(struct vec a, struct vec b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static inline struct vec vec_cross(struct vec a, struct vec b)
{
    return (struct vec){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

static inline double vec_length(struct vec a)
{
    return sqrt(vec_dot(a, a));
}

#endif
