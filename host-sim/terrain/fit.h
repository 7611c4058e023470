/* Posts whose own bilinear surface comes nearest to that of a model.
 *
 * Samples of the model would do if the image's posts lay on its posts. They lie between, where a
 * bilinear surface is lower than its crests and higher than its valleys, and the image's surface
 * cuts these off once more. The best posts are those of least squares: the model's surface weighed
 * with the dual of the triangle, which is triangles at all posts, that at m cells times
 *
 *     q^|m| / sqrt(o^2 - 4 n^2)        q = (sqrt(o^2 - 4 n^2) - o) / (2 n)
 *
 * (Unser, "Splines: a perfect fit for signal and image processing", 1999). o is what a triangle
 * overlaps with itself and n with its neighbour: sums over quarters of a cell, which stand for the
 * integrals. The dual ends at five cells, where q^|m| is below 1/1000. */
#ifndef TERRAIN_FIT_H
#define TERRAIN_FIT_H

#include "terrain/surface.h"

/* Prepare for cells of so many pixels. It is off where they are longer than a pixel or shorter than
 * a quarter. */
void terrain_fit_set(struct terrain_fit *fit, double cell_x, double cell_y);

/* Pixels on either side of a post that have a weight: less than this. */
double terrain_fit_reach(double cell);

/* Weight of a pixel `distance` pixels away from the post. */
double terrain_fit_weight(const struct terrain_fit *fit, double cell, double distance);

#endif
