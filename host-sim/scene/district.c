#include "district.h"

#include "noise.h"

enum { DEPTH_MAX = 12 };

struct point district_site(uint64_t seed, int i, int j, double spacing_m)
{
    const double x = 0.12 + 0.76 * noise_at(seed, i, j), y = 0.12 + 0.76 * noise_at(seed + 1, i, j);
    return (struct point){(i + x) * spacing_m, (j + y) * spacing_m};
}

struct shape district_shape(uint64_t seed, int i, int j, double spacing_m)
{
    const struct point own = district_site(seed, i, j, spacing_m);
    const struct frame f = frame_at(own, 0);
    const double reach = 2 * spacing_m;
    struct shape s = frame_rectangle(&f, -reach, -reach, reach, reach);
    for (int dj = -2; dj <= 2; dj++) {
        for (int di = -2; di <= 2; di++) {
            if (di == 0 && dj == 0) {
                continue;
            }
            const struct point other = district_site(seed, i + di, j + dj, spacing_m);
            const double apart = point_distance(own, other);
            const double du = (other.u - own.u) / apart, dv = (other.v - own.v) / apart;
            /* The border stands half way, across the line between the sites; own side to the left.
             */
            s = shape_cut(&s, point_between(own, other, 0.5), -dv, du, 0);
        }
    }
    return s;
}

static void divide(const struct shape *s, const struct division *d, struct hs_rng *r, int depth,
                   district_parcel *take, void *context)
{
    const double area = shape_area(s);
    if (s->count < 3 || area < 0.1 * d->largest_m2) {
        return;
    }
    if (depth >= DEPTH_MAX || area < d->largest_m2 * (1 + hs_rng_uniform(r))) {
        take(context, r, s);
        return;
    }
    struct shape half[2];
    shape_split(s, r, d->gap_m[depth < 2 ? depth : 2], d->unevenness, d->skew_deg, half);
    for (int k = 0; k < 2; k++) {
        divide(&half[k], d, r, depth + 1, take, context);
    }
}

void district_divide(const struct shape *s, const struct division *d, struct hs_rng *r,
                     district_parcel *take, void *context)
{
    divide(s, d, r, 0, take, context);
}
