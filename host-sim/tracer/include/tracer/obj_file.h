/* Wavefront OBJ files; of the format, vertices, faces and material names. */
#ifndef TRACER_OBJ_FILE_H
#define TRACER_OBJ_FILE_H

#include "tracer/mesh.h"

#define OBJ_BYTES_MAX ((long long)512 << 20)

enum obj_up {
    OBJ_UP_Y, /* the file's axes are x, up, z: what most programs write */
    OBJ_UP_Z,
};

/* Read a model. Faces of more than three corners must be convex and are fanned out; faces before
 * the first `usemtl` get the material "metal"; normals, textures, groups and material libraries are
 * passed over. A file that is too large, a number that is none or not finite, an index without a
 * vertex, curved surfaces: all refused with file and line. Returns 0, or -1 reported, with *m
 * empty. */
int obj_read(struct mesh *m, const char *path, enum obj_up up);

/* Write a model with z up. Returns 0, or -1 reported. */
int obj_write(const struct mesh *m, const char *path);

#endif
