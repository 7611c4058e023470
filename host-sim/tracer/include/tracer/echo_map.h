/* Map of echoes: for each cell of a picture, which part of the model made it, over how many
 * reflections, and from what height. */
#ifndef TRACER_ECHO_MAP_H
#define TRACER_ECHO_MAP_H

#include "tracer/mesh.h"
#include "tracer/origin.h"
#include "tracer/reflect.h"
#include "tracer/scene.h"

enum { ECHO_MAP_GROUND = -1, ECHO_MAP_UNKNOWN = -2 }; /* in place of a part */

struct echo_cell {
    double power_m2;  /* as accumulate.h counts it */
    double strongest; /* of one ray, likewise */
    uint32_t reflections;
    int32_t facets[TRACE_BOUNCES_MAX]; /* of that ray: triangles of the mesh, or as above */
    int32_t parts[TRACE_BOUNCES_MAX];
    double height_m, height_spread_m; /* mean by power, and standard deviation; NAN without power */
};

struct echo_map {
    struct echo_cell *cells; /* owned: cells_across * cells_range, near row first */
    int32_t *part_of;        /* owned: of each triangle, from 0 */
    uint32_t part_count;
};

/* Of records that were traced of this scene, which was opened with this mesh. Cost: that of
 * accumulate(), and one ray for each reflection of each cell's strongest. Returns 0, or -1 for lack
 * of memory, reported, with *map empty. */
int echo_map_make(struct echo_map *map, const struct trace_records *r,
                  const struct reflect_law *law, const struct scene *s, const struct mesh *m);

/* Harmless on a zeroed struct. */
void echo_map_free(struct echo_map *map);

#endif
