#include "tracer/model_file.h"

#include "hs/atomic_file.h"
#include "hs/error.h"
#include "hs/input_file.h"
#include "visual/model.h"

#include <stdio.h>
#include <string.h>

/* Assimp gives faces without a material one of its own, or one without a name. */
static bool is_nameless(const char *name)
{
    return *name == '\0' || strcmp(name, "DefaultMaterial") == 0;
}

static int add_material(struct mesh *m, const char *path, const char *name, uint32_t *number)
{
    name = is_nameless(name) ? "metal" : name;
    bool is_plain = true;
    for (const char *c = name; *c; c++) {
        is_plain = is_plain && *c >= '!' && *c <= '~';
    }
    if (!is_plain) {
        return hs_error(path, "rename it",
                        "the name of a material has a blank or is not plain ASCII: %s", name);
    }
    *number = mesh_material(m, name);
    return *number < TRACE_MATERIALS_MAX
               ? 0
               : hs_error(path, "use at most 32 materials with names of up to 31 letters",
                          "no room for the material %s", name);
}

static bool is_within(struct vec v)
{
    return fabs(v.x) <= MESH_SIZE_MAX_M && fabs(v.y) <= MESH_SIZE_MAX_M &&
           fabs(v.z) <= MESH_SIZE_MAX_M;
}

static bool add_triangle(struct mesh *m, const struct visual_triangle *t, uint32_t material)
{
    uint32_t corner[3];
    bool is_near = true;
    for (int i = 0; i < 3; i++) {
        const struct vec v = {(double)t->x[i], (double)t->y[i], (double)t->z[i]};
        is_near = is_near && is_within(v);
        corner[i] = mesh_add_vertex(m, v);
    }
    mesh_add_triangle(m, corner[0], corner[1], corner[2], material);
    return is_near;
}

static int take_model(struct mesh *m, const struct visual_model *model, const char *path)
{
    if (model->crossed > 0) {
        return hs_error(path, "divide its faces into triangles and export it again",
                        "%u faces cross themselves or fold back", model->crossed);
    }
    bool is_near = model->not_finite == 0;
    for (uint32_t i = 0; i < model->triangle_count; i++) {
        const struct visual_triangle *t = &model->triangles[i];
        uint32_t material = 0;
        if (add_material(m, path, model->materials[t->material].name, &material) != 0) {
            return -1;
        }
        is_near = add_triangle(m, t, material) && is_near;
    }
    if (!is_near) {
        return hs_error(path, "export the model in metres",
                        "a coordinate is not finite or beyond 10 km");
    }
    return m->is_full ? hs_error(path, "reduce the model", "out of memory for its triangles") : 0;
}

int model_file_read(struct mesh *m, const char *path, const char *up)
{
    struct visual_model model;
    struct visual_axes axes = {.keeps_walls = true};
    *m = (struct mesh){0};
    if (up || !visual_model_says_axes(path)) {
        axes.metres_per_unit = 1;
        axes.up = up && *up == 'z' ? VISUAL_UP_Z : VISUAL_UP_Y;
    }
    hs_input_note(path);
    if (visual_model_read(&model, path, NULL, &axes) != 0) {
        return -1;
    }
    const int result = take_model(m, &model, path);
    visual_model_free(&model);
    if (result != 0) {
        mesh_free(m);
    }
    return result;
}

void model_file_doubt_size(const struct mesh *m, const char *path)
{
    const double ship_m = 500, hand_m = 0.1;
    struct vec low, high;
    mesh_bounds(m, &low, &high);
    const struct vec size = vec_sub(high, low);
    const double longest_m = fmax(size.x, fmax(size.y, size.z));
    if (longest_m > ship_m || longest_m < hand_m) {
        hs_warn(path, "--scale says how many metres a unit is",
                "is %.3g m long, %.3g m wide and %.3g m high", size.x, size.y, size.z);
    }
}

int model_file_write(const struct mesh *m, const char *path)
{
    struct hs_atomic_file file;
    if (hs_atomic_open(&file, path) != 0) {
        return -1;
    }
    fputs("# Metres; x ahead, y to the left, z up.\n", file.stream);
    for (uint32_t i = 0; i < m->vertex_count; i++) {
        const struct vec v = m->vertices[i];
        fprintf(file.stream, "v %.17g %.17g %.17g\n", v.x, v.y, v.z);
    }
    uint32_t material = TRACE_MATERIALS_MAX;
    for (uint32_t i = 0; i < m->triangle_count; i++) {
        const struct mesh_triangle *t = &m->triangles[i];
        if (t->material != material) {
            material = t->material;
            fprintf(file.stream, "usemtl %s\n", m->materials[material]);
        }
        fprintf(file.stream, "f %u %u %u\n", t->corner[0] + 1, t->corner[1] + 1, t->corner[2] + 1);
    }
    return hs_atomic_commit(&file);
}
