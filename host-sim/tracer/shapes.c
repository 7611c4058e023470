#include "shapes.h"

static const double pi = 3.14159265358979323846;

void shape_triangle(struct mesh *m, struct vec a, struct vec b, struct vec c, uint32_t material)
{
    const uint32_t ia = mesh_add_vertex(m, a), ib = mesh_add_vertex(m, b);
    mesh_add_triangle(m, ia, ib, mesh_add_vertex(m, c), material);
}

void shape_plate(struct mesh *m, struct vec corner, struct vec u, struct vec v, uint32_t material)
{
    const uint32_t a = mesh_add_vertex(m, corner), b = mesh_add_vertex(m, vec_add(corner, u));
    const uint32_t c = mesh_add_vertex(m, vec_add(vec_add(corner, u), v));
    mesh_add_triangle(m, a, b, c, material);
    mesh_add_triangle(m, a, c, mesh_add_vertex(m, vec_add(corner, v)), material);
}

void shape_loft(struct mesh *m, const struct vec *from, const struct vec *to, int count,
                bool has_caps, uint32_t material)
{
    const uint32_t n = (uint32_t)count, first = m->vertex_count;
    for (int i = 0; i < count; i++) {
        mesh_add_vertex(m, from[i]);
    }
    for (int i = 0; i < count; i++) {
        mesh_add_vertex(m, to[i]);
    }
    for (uint32_t i = 0; i < n; i++) {
        const uint32_t a = first + i, b = first + (i + 1) % n;
        mesh_add_triangle(m, a, b, b + n, material);
        mesh_add_triangle(m, a, b + n, a + n, material);
    }
    for (uint32_t i = 1; has_caps && i + 1 < n; i++) {
        mesh_add_triangle(m, first, first + i + 1, first + i, material);
        mesh_add_triangle(m, first + n, first + n + i, first + n + i + 1, material);
    }
}

void shape_box(struct mesh *m, struct vec low, struct vec high, uint32_t material)
{
    const double xz[4][2] = {{low.x, low.z}, {high.x, low.z}, {high.x, high.z}, {low.x, high.z}};
    shape_profile(m, xz, 4, low.y, high.y, material);
}

void shape_profile(struct mesh *m, const double (*xz)[2], int count, double right_m, double left_m,
                   uint32_t material)
{
    struct vec from[SHAPE_CORNERS_MAX], to[SHAPE_CORNERS_MAX];
    for (int i = 0; i < count; i++) { /* seen from the right, the body runs away from the viewer */
        const double *p = xz[count - 1 - i];
        from[i] = (struct vec){p[0], right_m, p[1]};
        to[i] = (struct vec){p[0], left_m, p[1]};
    }
    shape_loft(m, from, to, count, true, material);
}

void shape_round(struct mesh *m, const struct shape_round *r, uint32_t material)
{
    struct vec from[SHAPE_CORNERS_MAX], to[SHAPE_CORNERS_MAX];
    const struct vec axis = vec_sub(r->to, r->from);
    /* Two directions across the axis, the first of them level or along x. */
    const struct vec aside =
        axis.x == 0 && axis.y == 0 ? (struct vec){1, 0, 0} : (struct vec){-axis.y, axis.x, 0};
    const struct vec u = vec_scale(aside, 1 / vec_length(aside));
    const struct vec w = vec_cross(axis, u), v = vec_scale(w, 1 / vec_length(w));
    for (int i = 0; i < r->facets; i++) {
        const double turn = 2 * pi * (i + 0.5) / r->facets;
        const struct vec out = vec_add(vec_scale(u, cos(turn)), vec_scale(v, sin(turn)));
        from[i] = vec_mad(r->from, out, r->from_radius_m);
        to[i] = vec_mad(r->to, out, r->to_radius_m);
    }
    shape_loft(m, from, to, r->facets, r->has_caps, material);
}
