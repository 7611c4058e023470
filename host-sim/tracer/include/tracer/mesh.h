/* Meshes: models made of triangles with materials, in metres. Axes of a model: x ahead (its nose),
 * y to its left, z up, the ground at z = 0 and the origin where the target stands. The outer side
 * of a triangle is the one from which its corners run counter-clockwise. */
#ifndef TRACER_MESH_H
#define TRACER_MESH_H

#include "tracer/records.h"
#include "tracer/vec.h"

#include <stdbool.h>
#include <stdint.h>

enum {
    MESH_TRIANGLES_MAX = 1 << 24,
    MESH_VERTICES_MAX = 3 * MESH_TRIANGLES_MAX, /* none of a file's is shared */
};
#define MESH_SIZE_MAX_M 10000.0 /* of a coordinate, either way */

struct mesh_triangle {
    uint32_t corner[3];
    uint32_t material;
};

struct mesh {
    struct vec *vertices;            /* owned */
    struct mesh_triangle *triangles; /* owned */
    uint32_t vertex_count, triangle_count, vertex_room, triangle_room;
    uint32_t material_count;
    char materials[TRACE_MATERIALS_MAX][TRACE_NAME_SIZE];
    bool is_full; /* memory or a limit was reached: what was added since is missing */
};

/* The index of a material, which is added when it is new; TRACE_MATERIALS_MAX when there is no room
 * or the name is too long. */
uint32_t mesh_material(struct mesh *m, const char *name);

/* Add; on lack of memory or past the limits nothing is added and m->is_full is set. The first
 * returns the new vertex's index. */
uint32_t mesh_add_vertex(struct mesh *m, struct vec v);
void mesh_add_triangle(struct mesh *m, uint32_t a, uint32_t b, uint32_t c, uint32_t material);

/* Lowest and highest coordinates; both zero without vertices. */
void mesh_bounds(const struct mesh *m, struct vec *low, struct vec *high);

/* Scale, turn to the left about the up axis, then move. */
void mesh_place(struct mesh *m, double scale, double turn_deg, struct vec move);

/* Harmless on a zeroed struct. */
void mesh_free(struct mesh *m);

#endif
