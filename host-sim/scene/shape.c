#include "scene/shape.h"

#include <math.h>

double point_distance(struct point a, struct point b)
{
    return hypot(b.u - a.u, b.v - a.v);
}

struct point point_between(struct point a, struct point b, double fraction)
{
    return (struct point){a.u + (b.u - a.u) * fraction, a.v + (b.v - a.v) * fraction};
}

struct frame frame_at(struct point origin, double direction_deg)
{
    const double angle = direction_deg * 3.14159265358979323846 / 180.0;
    return (struct frame){origin, cos(angle), sin(angle)};
}

struct point frame_point(const struct frame *f, double x, double y)
{
    return (struct point){f->origin.u + f->cos * x - f->sin * y,
                          f->origin.v + f->sin * x + f->cos * y};
}

struct shape frame_rectangle(const struct frame *f, double x0, double y0, double x1, double y1)
{
    return (struct shape){{frame_point(f, x0, y0), frame_point(f, x1, y0), frame_point(f, x1, y1),
                           frame_point(f, x0, y1)},
                          4};
}

double shape_area(const struct shape *s)
{
    double twice = 0;
    for (int i = 0; i < s->count; i++) {
        const struct point a = s->p[i], b = s->p[(i + 1) % s->count];
        twice += a.u * b.v - b.u * a.v;
    }
    return 0.5 * twice;
}

struct point shape_centre(const struct shape *s)
{
    struct point sum = {0, 0};
    for (int i = 0; i < s->count; i++) {
        sum.u += s->p[i].u;
        sum.v += s->p[i].v;
    }
    return (struct point){sum.u / s->count, sum.v / s->count};
}

/* How far `p` lies to the left of the line from `a` in the direction (du, dv) of length 1. */
static double left_of(struct point p, struct point a, double du, double dv)
{
    return du * (p.v - a.v) - dv * (p.u - a.u);
}

bool shape_contains(const struct shape *s, struct point p)
{
    for (int i = 0; i < s->count; i++) {
        const struct point a = s->p[i], b = s->p[(i + 1) % s->count];
        if (left_of(p, a, b.u - a.u, b.v - a.v) < 0) {
            return false;
        }
    }
    return s->count >= 3;
}

static void add_corner(struct shape *s, struct point p)
{
    if (s->count < SHAPE_MAX) {
        s->p[s->count++] = p;
    }
}

struct shape shape_cut(const struct shape *s, struct point at, double du, double dv, double gap)
{
    struct shape part = {.count = 0};
    for (int i = 0; i < s->count; i++) {
        const struct point a = s->p[i], b = s->p[(i + 1) % s->count];
        const double left_a = left_of(a, at, du, dv) - gap, left_b = left_of(b, at, du, dv) - gap;
        if (left_a >= 0) {
            add_corner(&part, a);
        }
        if ((left_a >= 0) != (left_b >= 0)) {
            add_corner(&part, point_between(a, b, left_a / (left_a - left_b)));
        }
    }
    if (part.count < 3) {
        part.count = 0;
    }
    return part;
}

struct shape shape_inset(const struct shape *s, double m)
{
    struct shape inner = *s;
    for (int i = 0; i < s->count && inner.count > 0; i++) {
        const struct point a = s->p[i], b = s->p[(i + 1) % s->count];
        const double length = point_distance(a, b);
        if (length > 1e-6) {
            inner = shape_cut(&inner, a, (b.u - a.u) / length, (b.v - a.v) / length, m);
        }
    }
    return inner;
}

/* The extent of `s` along (du, dv) about the point `at`. */
static void extent(const struct shape *s, struct point at, double du, double dv, double *low,
                   double *high)
{
    *low = INFINITY;
    *high = -INFINITY;
    for (int i = 0; i < s->count; i++) {
        const double x = (s->p[i].u - at.u) * du + (s->p[i].v - at.v) * dv;
        *low = fmin(*low, x);
        *high = fmax(*high, x);
    }
}

void shape_split(const struct shape *s, struct hs_rng *r, double gap, double unevenness,
                 double skew_deg, struct shape half[2])
{
    double longest = 0, du = 1, dv = 0;
    for (int i = 0; i < s->count; i++) {
        const struct point a = s->p[i], b = s->p[(i + 1) % s->count];
        const double length = point_distance(a, b);
        if (length > longest) {
            longest = length;
            du = (b.u - a.u) / length;
            dv = (b.v - a.v) / length;
        }
    }
    const struct point centre = shape_centre(s);
    double low, high, low_across, high_across;
    extent(s, centre, du, dv, &low, &high);
    extent(s, centre, -dv, du, &low_across, &high_across);
    if (high_across - low_across > high - low) {
        const double swap = du;
        du = -dv;
        dv = swap;
        low = low_across;
        high = high_across;
    }
    const double turn = (2 * hs_rng_uniform(r) - 1) * skew_deg * 3.14159265358979323846 / 180.0;
    const double x = low + (high - low) * (0.5 + unevenness * (2 * hs_rng_uniform(r) - 1));
    const struct point at = {centre.u + du * x, centre.v + dv * x};
    const double cut_u = -dv * cos(turn) - du * sin(turn), cut_v = du * cos(turn) - dv * sin(turn);
    half[0] = shape_cut(s, at, cut_u, cut_v, gap / 2);
    half[1] = shape_cut(s, at, -cut_u, -cut_v, gap / 2);
}

double line_distance(const struct point *line, int count, struct point p, double *along)
{
    double best = INFINITY, length = 0;
    for (int i = 0; i + 1 < count; i++) {
        const double du = line[i + 1].u - line[i].u, dv = line[i + 1].v - line[i].v;
        const double step = hypot(du, dv);
        double t = step > 0 ? ((p.u - line[i].u) * du + (p.v - line[i].v) * dv) / (step * step) : 0;
        t = fmax(0, fmin(1, t));
        const double d = hypot(line[i].u + t * du - p.u, line[i].v + t * dv - p.v);
        if (d < best) {
            best = d;
            if (along) {
                *along = length + t * step;
            }
        }
        length += step;
    }
    return best;
}

static double catmull_rom(double a, double b, double c, double d, double t)
{
    return b + 0.5 * t * (c - a + t * (2 * a - 5 * b + 4 * c - d + t * (3 * (b - c) + d - a)));
}

int line_smooth(const struct point *control, int count, int steps, struct point *out)
{
    int n = 0;
    for (int i = 0; i + 1 < count; i++) {
        const struct point b = control[i], c = control[i + 1];
        const struct point a = i > 0 ? control[i - 1] : b;
        const struct point d = i + 2 < count ? control[i + 2] : c;
        for (int k = 0; k < steps; k++) {
            const double t = (double)k / steps;
            out[n++] = (struct point){catmull_rom(a.u, b.u, c.u, d.u, t),
                                      catmull_rom(a.v, b.v, c.v, d.v, t)};
        }
    }
    out[n++] = control[count - 1];
    return n;
}
