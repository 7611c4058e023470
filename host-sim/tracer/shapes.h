/* Shapes to build models from: each is added to a mesh with its outer side outwards. All are
 * closed except plates and tubes. */
#ifndef TRACER_SHAPES_H
#define TRACER_SHAPES_H

#include "tracer/mesh.h"

enum { SHAPE_CORNERS_MAX = 720 };

/* The parallelogram at `corner` with the edges u and v; its outer side is that of u x v. */
void shape_plate(struct mesh *m, struct vec corner, struct vec u, struct vec v, uint32_t material);

void shape_triangle(struct mesh *m, struct vec a, struct vec b, struct vec c, uint32_t material);

void shape_box(struct mesh *m, struct vec low, struct vec high, uint32_t material);

/* The body between two convex outlines of `count` corners each (3..SHAPE_CORNERS_MAX), joined
 * corner to corner. Seen along the way from `from` to `to` the corners run clockwise. Without caps
 * both ends are open. */
void shape_loft(struct mesh *m, const struct vec *from, const struct vec *to, int count,
                bool has_caps, uint32_t material);

/* A profile of (x, z) pairs, counter-clockwise as seen from the right (x ahead to the right of the
 * picture, z up), drawn out from y = right_m (the lower) to y = left_m. */
void shape_profile(struct mesh *m, const double (*xz)[2], int count, double right_m, double left_m,
                   uint32_t material);

/* A round body from `from` to `to` with a radius at either end. `facets` flat faces around, of
 * which one looks along each main axis when `facets` is a multiple of four. */
struct shape_round {
    struct vec from, to;
    double from_radius_m, to_radius_m;
    int facets; /* 3..SHAPE_CORNERS_MAX */
    bool has_caps;
};
void shape_round(struct mesh *m, const struct shape_round *r, uint32_t material);

#endif
