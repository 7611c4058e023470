/* Hills that water has made: uplift against the erosion of streams, so that valleys join, every
 * place drains to the sea, and rivers lie lowest.
 *
 * Law: dz/dt = U - K sqrt(A) S, the stream power law with m = 1/2 and n = 1, solved implicitly
 * downstream to upstream (Braun and Willett, Geomorphology 180-181, 2013, eq. 23). */
#ifndef SCENE_EROSION_H
#define SCENE_EROSION_H

#include <stdbool.h>
#include <stdint.h>

struct erosion {
    int width, height; /* nodes; node i is at column i % width, row i / width */
    double spacing_m;
    double *z_m;       /* elevation */
    double *steepness; /* U / K: slope times the root of the drained area, in m */
    uint8_t *is_base;  /* elevation held: sea, river, lake */
    double *area_m2;   /* drained through the node; filled by erosion_route */
    int32_t *receiver; /* the node it drains to, itself at a base and in a pit */
    int32_t *order;    /* nodes, each after its receiver */
    int32_t *scratch;  /* 3 * nodes + 1 */
};

/* Zeroed arrays of width * height. Returns 0, or -1 when memory is short (reported). */
int erosion_init(struct erosion *e, int width, int height, double spacing_m);
void erosion_free(struct erosion *e);

/* Let `steps` steps of uplift pass. `pace` is K dt sqrt(1 m2) in m; slopes stay below `talus`.
 * Cost: about 60 ns a node and step. */
void erosion_run(struct erosion *e, int steps, double pace, double talus);

/* Find each node's receiver, and the area that drains through it, from the present elevations. */
void erosion_route(struct erosion *e);

#endif
