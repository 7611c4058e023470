/* The plain divided among its owners: districts whose borders are roads, cut into parcels. */
#ifndef SCENE_DISTRICT_H
#define SCENE_DISTRICT_H

#include "hs/rng.h"
#include "scene/shape.h"

#include <stdint.h>

/* The Voronoi cell of the site of lattice square (i, j), whose sites lie one in each square of
 * `spacing_m`, off its middle. */
struct point district_site(uint64_t seed, int i, int j, double spacing_m);
struct shape district_shape(uint64_t seed, int i, int j, double spacing_m);

/* Division of land into parcels. */
struct division {
    double largest_m2; /* parcels are cut until they are smaller than once or twice this */
    double gap_m[3];   /* left between the halves of the first cut, the second, all others */
    double unevenness; /* shape_split */
    double skew_deg;   /* shape_split */
};

typedef void district_parcel(void *context, struct hs_rng *r, const struct shape *parcel);

/* Cut `s` and hand each parcel to `take`. */
void district_divide(const struct shape *s, const struct division *d, struct hs_rng *r,
                     district_parcel *take, void *context);

#endif
