#include "tracer/mesh.h"

#include <stdlib.h>
#include <string.h>

uint32_t mesh_material(struct mesh *m, const char *name)
{
    for (uint32_t i = 0; i < m->material_count; i++) {
        if (strcmp(m->materials[i], name) == 0) {
            return i;
        }
    }
    if (m->material_count == TRACE_MATERIALS_MAX || strlen(name) >= TRACE_NAME_SIZE) {
        return TRACE_MATERIALS_MAX;
    }
    strcpy(m->materials[m->material_count], name);
    return m->material_count++;
}

/* Make room for one more of `size` bytes each. */
static bool grow(void **items, uint32_t count, uint32_t *room, uint32_t limit, size_t size)
{
    if (count < *room) {
        return true;
    }
    if (count >= limit) {
        return false;
    }
    const uint32_t wanted = count < 512 ? 1024 : count < limit / 2 ? 2 * count : limit;
    void *larger = realloc(*items, wanted * size);
    if (!larger) {
        return false;
    }
    *items = larger;
    *room = wanted;
    return true;
}

uint32_t mesh_add_vertex(struct mesh *m, struct vec v)
{
    void *items = m->vertices;
    if (!grow(&items, m->vertex_count, &m->vertex_room, MESH_VERTICES_MAX, sizeof v)) {
        m->is_full = true;
        return 0;
    }
    m->vertices = items;
    m->vertices[m->vertex_count] = v;
    return m->vertex_count++;
}

void mesh_add_triangle(struct mesh *m, uint32_t a, uint32_t b, uint32_t c, uint32_t material)
{
    void *items = m->triangles;
    if (!grow(&items, m->triangle_count, &m->triangle_room, MESH_TRIANGLES_MAX,
              sizeof *m->triangles)) {
        m->is_full = true;
        return;
    }
    m->triangles = items;
    m->triangles[m->triangle_count++] = (struct mesh_triangle){{a, b, c}, material};
}

void mesh_bounds(const struct mesh *m, struct vec *low, struct vec *high)
{
    *low = *high = m->vertex_count > 0 ? m->vertices[0] : (struct vec){0, 0, 0};
    for (uint32_t i = 1; i < m->vertex_count; i++) {
        const struct vec v = m->vertices[i];
        *low = (struct vec){fmin(low->x, v.x), fmin(low->y, v.y), fmin(low->z, v.z)};
        *high = (struct vec){fmax(high->x, v.x), fmax(high->y, v.y), fmax(high->z, v.z)};
    }
}

void mesh_place(struct mesh *m, double scale, double turn_deg, struct vec move)
{
    const double turn_rad = turn_deg * (3.14159265358979323846 / 180);
    const double c = cos(turn_rad) * scale, s = sin(turn_rad) * scale;
    for (uint32_t i = 0; i < m->vertex_count; i++) {
        const struct vec v = m->vertices[i];
        m->vertices[i] =
            vec_add((struct vec){c * v.x - s * v.y, s * v.x + c * v.y, scale * v.z}, move);
    }
}

void mesh_free(struct mesh *m)
{
    free(m->vertices);
    free(m->triangles);
    *m = (struct mesh){0};
}
