/* Place on the ground, and patterns that belong to it: functions of the place alone, in metres, so
 * that rasters, levels, tiles and zones of whatever build agree.
 *
 * A place is a point of the WGS-84 ellipsoid in axes fixed in the Earth. Patterns are made in these
 * three dimensions and met on the ground: there is no projection, and hence no seam. */
#ifndef REFLECTIVITY_PLACE_H
#define REFLECTIVITY_PLACE_H

#include <stdint.h>

struct reflect_place {
    double x, y, z; /* metres from the middle of the Earth, or of any other axes at right angles */
};

/* The place at a latitude and longitude, radians. */
struct reflect_place reflect_place_at(double latitude, double longitude);

/* A place, and the plane that touches the ellipsoid there: for many places around one. */
struct reflect_tangent {
    struct reflect_place at;
    double sin_latitude, cos_latitude, sin_longitude, cos_longitude;
};

struct reflect_tangent reflect_tangent_at(double latitude, double longitude);

/* The place on the plane that is `east_m` and `north_m` from where it touches. 5 km away it is 2 m
 * above the ground. */
struct reflect_place reflect_place_beside(const struct reflect_tangent *t, double east_m,
                                          double north_m);

/* Smooth pattern: normal, mean 0 and variance 1 at each place, from a lattice of `step_m`. Its
 * correlation is about 0.5 at 0.6 steps and nothing from 2 steps on. */
double reflect_pattern_smooth(uint64_t seed, struct reflect_place p, double step_m);

/* Parcels: cells of a jittered lattice of `step_m` (Voronoi), each of one value, normal with mean 0
 * and variance 1. */
double reflect_pattern_parcels(uint64_t seed, struct reflect_place p, double step_m);

/* Spots: discs of up to 2.4 m radius, at most one in each cube of 8 m, that cover `share` (up to
 * 0.11) of the ground. Returns a number of [0, 1) that is even over spots and one for each, or -1
 * between spots. */
double reflect_pattern_spots(uint64_t seed, struct reflect_place p, double share);

#endif
