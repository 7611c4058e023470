/* Audit of a mesh: finds what is wrong with a model before rays are lost in it. */
#ifndef TRACER_MESH_AUDIT_H
#define TRACER_MESH_AUDIT_H

#include "tracer/mesh.h"

struct mesh_audit {
    uint32_t degenerate;   /* triangles without area, among them those with a corner used twice */
    uint32_t open_edges;   /* edges with a triangle on one side only */
    uint32_t turned_edges; /* edges whose two triangles disagree on which side is outside */
    uint32_t part_count;   /* bodies that hang together by edges */
    uint32_t inside_out;   /* closed parts that enclose a negative volume */
};

/* Corners at exactly the same place count as one, however often the file lists them. Degenerate
 * triangles are left out of the other counts. Cost: sorts of corners and edges; 40 bytes a
 * triangle. Returns 0, or -1 for lack of memory, reported with `place`. */
int mesh_audit(const struct mesh *m, const char *place, struct mesh_audit *audit);

/* Number the bodies that hang together by edges, in the order of their first triangle:
 * part_of[triangle], from 0. A triangle without area is a part of its own. Returns 0, or -1 for
 * lack of memory, not reported. */
int mesh_parts(const struct mesh *m, int32_t *part_of, uint32_t *part_count);

/* An edge between two vertices, and its one or two triangles. */
struct mesh_edge {
    uint32_t from, to, triangle;
    uint32_t other; /* MESH_NO_TRIANGLE: the edge is open */
};
#define MESH_NO_TRIANGLE UINT32_MAX

/* The edges of one or two triangles, free() them; those of more are left out, and so are triangles
 * without area. NULL for lack of memory, not reported. */
struct mesh_edge *mesh_edges(const struct mesh *m, size_t *count);

/* Refuse a model that is not made of closed bodies with their outer sides outwards, and tell how to
 * mend it. Returns 0, or -1 with everything that is wrong reported as one error. */
int mesh_require_closed(const struct mesh_audit *audit, const char *place);

/* Remove triangles without area; returns how many there were. */
uint32_t mesh_drop_degenerate(struct mesh *m);

#endif
