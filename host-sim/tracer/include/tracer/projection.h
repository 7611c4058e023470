/* Projection of a model on the sensor's plane: the first hit of each primary ray, found by drawing
 * instead of casting. The rays are parallel and stand in columns and rows, so that each triangle
 * of the model is a triangle on the plane, and the nearest one at a ray's place is the one it
 * meets. Under the ground lies the mirror image of the model: what a ray would meet of it, did it
 * pass through the ground, is what it meets after the ground has reflected it.
 *
 * Cost: about a hundred instructions a triangle and row, and a few a ray that it covers. */
#ifndef TRACER_PROJECTION_H
#define TRACER_PROJECTION_H

#include "tracer/scene.h"
#include "tracer/trace.h"

/* A triangle on the plane, in columns and rows: from its lowest corner one side goes to the
 * highest, the two others meet at the height of the middle one. */
struct projection_side {
    double x, y, x_per_row; /* of its lower end */
};

struct projection_shape {
    struct projection_side whole, lower, upper;
    double depth_m, depth_per_column_m, depth_per_row_m; /* of column 0, row 0 */
    uint32_t facet, first_row, last_row;
};

/* The shapes, and which of them to draw in each strip of rows. */
struct projection {
    uint32_t columns, rows, strip_rows, strip_count;
    struct projection_shape *shapes; /* owned */
    uint32_t *begins; /* owned; of strip i in `lists`; one more than there are strips */
    uint32_t *lists;  /* owned; indices of shapes */
    uint32_t shape_count, shape_room;
};

/* Draw the model, or its mirror image. Triangles seen more edge-on than grazing_cos are left out,
 * and so are those that lie between the rays. Returns 0, or -1 out of memory with *p empty. */
int projection_open(struct projection *p, const struct scene *scene, const struct trace_axes *axes,
                    const struct trace_sensor *sensor, uint32_t strip_rows, double grazing_cos,
                    bool is_mirror);

/* Harmless on a zeroed struct. */
void projection_close(struct projection *p);

/* Draw a strip: for each of its rays, row by row, the facet that is nearest, beyond near_m[row] and
 * before depths_m[ray], if there is one; else both are left as they are. A depth is the way from
 * the plane through the origin. */
void projection_draw(const struct projection *p, uint32_t strip, const float *near_m,
                     float *depths_m, uint32_t *facets);

#endif
