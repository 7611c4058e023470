/* Zones: a mesh cut into blocks, so that what lies in each is a material of its own. A target whose
 * parts are all of one metal does not return alike from all of them: plates, hinges, bolts and gear
 * are too small for the model. Networks that know where a ray fell can learn that
 * (netem/architecture.h, EP9). */
#ifndef TRACER_MESH_ZONES_H
#define TRACER_MESH_ZONES_H

#include "tracer/mesh.h"

#include <stdbool.h>

enum { MESH_ZONES_MAX = 9 }; /* in each direction */

struct mesh_zones {
    int along, aside, high; /* 1..MESH_ZONES_MAX pieces of equal size: from tail to nose, from the
                               middle plane to either side alike, and upwards */
    bool has_sides;         /* left and right are of different materials */
};

/* Cut every triangle at the zones' borders, which divide the mesh's bounds, and rename its material
 * to `material.xyz`: digits of the piece along, aside and upwards, from 1; and, with has_sides, an
 * `r` on the right. The law of a material goes by the name before the point (tracer/materials.h).
 * `m` is replaced.
 *
 * Returns 0, or -1 with the error reported and `m` as it was, iff
 *  - more than TRACE_MATERIALS_MAX - 1 materials arise, or a name becomes too long, or
 *  - out of memory.
 *
 * Cost: triangles x zones they touch. */
int mesh_zone(struct mesh *m, const struct mesh_zones *zones, const char *path);

#endif
