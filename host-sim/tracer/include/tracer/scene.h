/* Traced scene: a model standing on its ground, ready to be met by rays. Embree answers where they
 * meet the model; where they meet the ground, a plane, is computed here. */
#ifndef TRACER_SCENE_H
#define TRACER_SCENE_H

#include "tracer/mesh.h"

#include <stdbool.h>
#include <stdint.h>

/* Facet that a ray meets: its plane and its material. */
struct scene_facet {
    struct vec normal; /* unit, on the outer side */
    double offset_m;   /* normal . p of the points p of the plane */
};

struct scene {
    void *device, *tree;        /* Embree's; owned */
    const float *vertices;      /* of the model, as Embree holds them: borrowed from `tree` */
    const uint32_t *corners;    /* likewise; three vertices a triangle */
    struct scene_facet *facets; /* owned; of the triangles, then of the ground */
    uint8_t *facet_materials;   /* owned; likewise */
    uint32_t triangle_count, facet_count, material_count;
    double ground_half_m; /* half the side of the ground, a square at z = 0; 0: there is none */
    char materials[TRACE_MATERIALS_MAX][TRACE_NAME_SIZE];
    struct vec low, high; /* bounds of the model, without the ground */
};

enum { SCENE_PACKET = 16 };
#define SCENE_MISS UINT32_MAX

/* Up to SCENE_PACKET rays, as Embree takes them: coordinate by coordinate, in single precision. */
struct scene_rays {
    float from[3][SCENE_PACKET], along[3][SCENE_PACKET];
    uint32_t count;
};

/* Add a ray; `along` is of unit length. There must be room. */
static inline void scene_rays_add(struct scene_rays *r, struct vec from, struct vec along)
{
    const uint32_t i = r->count++;
    r->from[0][i] = (float)from.x;
    r->from[1][i] = (float)from.y;
    r->from[2][i] = (float)from.z;
    r->along[0][i] = (float)along.x;
    r->along[1][i] = (float)along.y;
    r->along[2][i] = (float)along.z;
}

/* Build the tree over the model. When ground_half_m > 0 it stands on a square of ground of that
 * half side at z = 0, of the material "ground". The mesh is not needed afterwards. Returns 0, or -1
 * with the error reported with `place` and *s empty. */
int scene_open(struct scene *s, const struct mesh *m, double ground_half_m, const char *place);

/* The corners of a triangle of the model. */
void scene_corners(const struct scene *s, uint32_t triangle, struct vec corners[3]);

/* The facet that each ray meets first, or SCENE_MISS. Any number of threads may ask at once. */
void scene_meet(const struct scene *s, const struct scene_rays *rays,
                uint32_t facets[SCENE_PACKET]);

/* Bit i is set when ray i meets anything. */
uint32_t scene_is_blocked(const struct scene *s, const struct scene_rays *rays);

/* Harmless on a zeroed struct. */
void scene_close(struct scene *s);

#endif
