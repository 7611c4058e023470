/* Model files: whatever visual/model.h reads (OBJ, glTF, STL, PLY, Collada, OpenFlight) as a mesh,
 * and a mesh as Wavefront OBJ. */
#ifndef TRACER_MODEL_FILE_H
#define TRACER_MODEL_FILE_H

#include "tracer/mesh.h"

/* Read a model. `up`, "y" or "z", is the axis that points up in files that do not say it
 * themselves; NULL: y. Lengths of those are taken for metres. Faces without a material, or with one
 * that has no name, get "metal". Faces of more than three corners are divided into triangles. Cost:
 * a process of its own for the reader, under the limits of visual/model.h. Returns 0, or -1 with
 * the error reported and *m empty:
 * - what visual_model_read refuses,
 * - a corner that is not finite or beyond MESH_SIZE_MAX_M,
 * - a face that no division fills, because its outline crosses itself,
 * - more than TRACE_MATERIALS_MAX materials, or a name that is longer than TRACE_NAME_SIZE allows
 * or not plain ASCII without blanks. */
int model_file_read(struct mesh *m, const char *path, const char *up);

/* Warn of a model that is larger than a ship or smaller than a hand, with its sizes. */
void model_file_doubt_size(const struct mesh *m, const char *path);

/* Write a model as OBJ with z up. Returns 0, or -1 reported. */
int model_file_write(const struct mesh *m, const char *path);

#endif
