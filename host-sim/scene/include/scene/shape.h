/* Shapes on the ground, in metres, and how land is divided among owners. */
#ifndef SCENE_SHAPE_H
#define SCENE_SHAPE_H

#include "hs/rng.h"

#include <stdbool.h>

/* A place in the axes of the design (land.h), in metres. */
struct point {
    double u, v;
};

enum { SHAPE_MAX = 24 };

/* A convex polygon, counter-clockwise. */
struct shape {
    struct point p[SHAPE_MAX];
    int count;
};

/* A place and a direction: local x runs along (cos, sin), local y to its left. */
struct frame {
    struct point origin;
    double cos, sin;
};

/* Distance in metres; the point that lies `fraction` of the way from a to b. */
double point_distance(struct point a, struct point b);
struct point point_between(struct point a, struct point b, double fraction);

/* The frame whose local x runs `direction_deg` to the left of u; the place of local coordinates;
 * the rectangle x0..x1 by y0..y1 in them. */
struct frame frame_at(struct point origin, double direction_deg);
struct point frame_point(const struct frame *f, double x, double y);
struct shape frame_rectangle(const struct frame *f, double x0, double y0, double x1, double y1);

/* Area in m^2; mean of the corners; whether a place lies inside or on the edge. */
double shape_area(const struct shape *s);
struct point shape_centre(const struct shape *s);
bool shape_contains(const struct shape *s, struct point p);

/* The part of `s` on the left of the line through `at` in the direction (du, dv), moved `gap` to
 * the left. May be empty (count 0). Corners beyond SHAPE_MAX are left out, which no caller reaches.
 */
struct shape shape_cut(const struct shape *s, struct point at, double du, double dv, double gap);

/* `s` without a margin of `m` metres along every edge; may be empty. */
struct shape shape_inset(const struct shape *s, double m);

/* Divide `s` across its longest edge direction, near the middle, leaving a strip `gap` wide between
 * the halves. `unevenness` 0..0.4 shifts and `skew_deg` turns the cut at most so far. */
void shape_split(const struct shape *s, struct hs_rng *r, double gap, double unevenness,
                 double skew_deg, struct shape half[2]);

/* The distance from `p` to the line through `count` points; `*along` (may be NULL) is how far along
 * the line the nearest point lies. */
double line_distance(const struct point *line, int count, struct point p, double *along);

/* A smooth line through `count` control points (Catmull-Rom), `steps` points to each stretch.
 * `out` holds (count - 1) * steps + 1; returns how many were written. */
int line_smooth(const struct point *control, int count, int steps, struct point *out);

#endif
