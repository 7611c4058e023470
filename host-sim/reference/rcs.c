#include "reference/rcs.h"

#include <math.h>
#include <string.h>

static const double pi = 3.14159265358979323846;

double ref_plate_lobe_deg(double wavelengths, int ways)
{
    const double sine = 1 / (ways * wavelengths);
    return sine >= 1 ? 180 : 2 * asin(sine) * 180 / pi;
}

/* Mean over a side of exp(j 2 k sine x), from the middles of pieces of a twenty-fifth of a turn or
 * less. */
static double side_mean(double side_m, double wavelength_m, double sine)
{
    const int pieces = 100 + (int)(50 * side_m / wavelength_m);
    double sum = 0;
    for (int i = 0; i < pieces; i++) {
        const double x_m = ((i + 0.5) / pieces - 0.5) * side_m;
        sum += cos(4 * pi / wavelength_m * sine * x_m);
    }
    return sum / pieces;
}

static double plate_m2(const struct lm_shape *s, double wavelength_m, struct ref_vector d)
{
    if (d.ahead <= 0 && !s->is_two_sided) {
        return 0;
    }
    const double a_m = s->size_mm[0] * 1e-3, b_m = s->size_mm[1] * 1e-3;
    const double field = a_m * b_m * d.ahead * side_mean(a_m, wavelength_m, d.right) *
                         side_mean(b_m, wavelength_m, d.up);
    return 4 * pi * field * field / (wavelength_m * wavelength_m);
}

/* Two faces as intervals on a line across crease and sight; the sharing one is cut out of them. */
static double dihedral_m2(const struct lm_shape *s, double wavelength_m, struct ref_vector d)
{
    const double a_m = s->size_mm[0] * 1e-3, b_m = s->size_mm[1] * 1e-3;
    const double flat = hypot(d.ahead, d.right), angle = atan2(d.right, d.ahead);
    if (!(fabs(angle) < pi / 4)) {
        return 0;
    }
    const double left_m = a_m * flat * cos(pi / 4 + angle);
    const double right_m = a_m * flat * cos(pi / 4 - angle);
    const double share_m = fmin(right_m, left_m) + fmin(left_m, right_m);
    const double field = share_m * b_m * side_mean(b_m, wavelength_m, d.up);
    return 4 * pi * field * field / (wavelength_m * wavelength_m);
}

enum { CORNERS_MAX = 12 };

struct polygon {
    double x[CORNERS_MAX], y[CORNERS_MAX];
    int count;
};

/* Keep what lies left of the line from (x0, y0) to (x1, y1) (Sutherland and Hodgman 1974). */
static void cut(struct polygon *p, double x0, double y0, double x1, double y1)
{
    struct polygon kept = {.count = 0};
    for (int i = 0; i < p->count; i++) {
        const int k = (i + 1) % p->count;
        const double here = (x1 - x0) * (p->y[i] - y0) - (y1 - y0) * (p->x[i] - x0);
        const double there = (x1 - x0) * (p->y[k] - y0) - (y1 - y0) * (p->x[k] - x0);
        if (here >= 0) {
            kept.x[kept.count] = p->x[i];
            kept.y[kept.count++] = p->y[i];
        }
        if ((here >= 0) != (there >= 0)) {
            const double t = here / (here - there);
            kept.x[kept.count] = p->x[i] + t * (p->x[k] - p->x[i]);
            kept.y[kept.count++] = p->y[i] + t * (p->y[k] - p->y[i]);
        }
    }
    *p = kept;
}

static double area(const struct polygon *p)
{
    double twice = 0;
    for (int i = 0; i < p->count; i++) {
        const int k = (i + 1) % p->count;
        twice += p->x[i] * p->y[k] - p->x[k] * p->y[i];
    }
    return twice / 2;
}

/* The outline of the corner seen from the radar, projected on the plane through its apex: a
 * triangle of the tips of its legs. What it shares with its image, mirrored at the apex, returns.
 */
static double trihedral_share_m2(double leg_m, struct ref_vector d)
{
    const struct ref_vector legs[3] = {{sqrt(1.0 / 3), 0, sqrt(2.0 / 3)},
                                       {sqrt(1.0 / 3), sqrt(0.5), -sqrt(1.0 / 6)},
                                       {sqrt(1.0 / 3), -sqrt(0.5), -sqrt(1.0 / 6)}};
    /* Two axes across the line of sight; inside the opening it never comes near `up`. */
    const double flat = hypot(d.ahead, d.right);
    const struct ref_vector x = {-d.right / flat, d.ahead / flat, 0};
    const struct ref_vector y = {-d.up * d.ahead / flat, -d.up * d.right / flat, flat};
    struct polygon p = {.count = 3};
    for (int i = 0; i < 3; i++) {
        if (legs[i].ahead * d.ahead + legs[i].right * d.right + legs[i].up * d.up <= 0) {
            return 0;
        }
        p.x[i] = leg_m * (legs[i].ahead * x.ahead + legs[i].right * x.right);
        p.y[i] = leg_m * (legs[i].ahead * y.ahead + legs[i].right * y.right + legs[i].up * y.up);
    }
    if (area(&p) < 0) {
        const struct polygon q = p;
        p.x[1] = q.x[2], p.y[1] = q.y[2], p.x[2] = q.x[1], p.y[2] = q.y[1];
    }
    const struct polygon outline = p;
    for (int i = 0; i < 3; i++) {
        const int k = (i + 1) % 3;
        cut(&p, -outline.x[i], -outline.y[i], -outline.x[k], -outline.y[k]);
    }
    return p.count ? area(&p) : 0;
}

double ref_rcs_m2(const struct lm_shape *shape, double wavelength_m, struct ref_vector radar)
{
    const double size_m = shape->size_mm[0] * 1e-3;
    double share_m2 = 0;
    switch (shape->kind) {
    case LM_SHAPE_SPHERE:
        return pi * size_m * size_m;
    case LM_SHAPE_PLATE:
        return plate_m2(shape, wavelength_m, radar);
    case LM_SHAPE_DIHEDRAL:
        return dihedral_m2(shape, wavelength_m, radar);
    default:
        share_m2 = trihedral_share_m2(size_m, radar);
        return 4 * pi * share_m2 * share_m2 / (wavelength_m * wavelength_m);
    }
}

static double radians(fx_bam_t angle)
{
    return (int32_t)angle * (pi / 2147483648.0);
}

static double dot(struct ref_vector a, struct ref_vector b)
{
    return a.ahead * b.ahead + a.right * b.right + a.up * b.up;
}

/* The axes themselves, drawn in the target's: the boresight where azimuth and elevation point, the
 * right one level, the third across both; then both turned by the roll. */
struct ref_vector ref_scatterer_axes(const struct lm_scatterer *s, struct ref_vector v)
{
    const double az = radians(s->azimuth), el = radians(s->elevation), roll = radians(s->roll);
    const struct ref_vector ahead = {cos(el) * cos(az), cos(el) * sin(az), sin(el)};
    const struct ref_vector right = {-sin(az), cos(az), 0};
    const struct ref_vector up = {-sin(el) * cos(az), -sin(el) * sin(az), cos(el)};
    return (struct ref_vector){dot(v, ahead), cos(roll) * dot(v, right) + sin(roll) * dot(v, up),
                               cos(roll) * dot(v, up) - sin(roll) * dot(v, right)};
}

double complex ref_target_echo(const struct lm_target *t, unsigned mask, double wavelength_m,
                               struct ref_vector radar_m)
{
    const double range_m = sqrt(dot(radar_m, radar_m));
    const struct ref_vector toward = {radar_m.ahead / range_m, radar_m.right / range_m,
                                      radar_m.up / range_m};
    double complex sum = 0;
    for (unsigned i = 0; i < t->scatterer_count; i++) {
        const struct lm_scatterer *s = &t->scatterers[i];
        const struct ref_vector way = {radar_m.ahead - s->offset_mm[0] * 1e-3,
                                       radar_m.right - s->offset_mm[1] * 1e-3,
                                       radar_m.up - s->offset_mm[2] * 1e-3};
        const struct lm_shape shape = {s->kind, s->is_two_sided, {s->size_mm[0], s->size_mm[1]}};
        if (mask >> i & 1) {
            const double m2 = ref_rcs_m2(&shape, wavelength_m, ref_scatterer_axes(s, toward));
            sum += sqrt(m2) * cexp(I * 4 * pi / wavelength_m * (sqrt(dot(way, way)) - range_m));
        }
    }
    return sum;
}
