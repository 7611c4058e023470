#include "tracer/mesh_zones.h"

#include "hs/error.h"

#include <stdio.h>
#include <string.h>

/* A triangle has three corners, and each of the six sides of a zone adds one at most. */
enum { CORNERS_MAX = 9, SIDES = 6 };

struct polygon {
    struct vec corner[CORNERS_MAX];
    int count;
};

/* A zone's sides: what lies on the positive side of each is inside, and on it unless `is_open`: a
 * face in a border belongs to one zone. */
struct side {
    struct vec normal;
    double offset;
    bool is_open;
};

static double height_over(const struct side *s, struct vec v)
{
    return vec_dot(s->normal, v) - s->offset;
}

static bool is_inside(const struct side *s, struct vec v)
{
    const double height = height_over(s, v);
    return s->is_open ? height > 0 : height >= 0;
}

/* Where the way from `a` to `b` meets the side; both neighbours of an edge reckon it alike, from
 * the inner end. */
static struct vec meet(const struct side *s, struct vec inner, struct vec outer)
{
    const double in = height_over(s, inner), out = height_over(s, outer);
    return vec_mad(inner, vec_sub(outer, inner), in / (in - out));
}

static void cut(struct polygon *p, const struct side *s)
{
    struct polygon kept = {.count = 0};
    for (int i = 0; i < p->count; i++) {
        const struct vec a = p->corner[i], b = p->corner[(i + 1) % p->count];
        const bool is_in = is_inside(s, a), is_next_in = is_inside(s, b);
        if (is_in) {
            kept.corner[kept.count++] = a;
        }
        if (is_in != is_next_in) {
            kept.corner[kept.count++] = is_in ? meet(s, a, b) : meet(s, b, a);
        }
    }
    *p = kept;
}

/* Piece `i` of `count` of low..high along one axis. The outermost sides lie a little outside, so
 * that nothing is lost by rounding. */
static void slab(struct vec axis, double low, double high, int i, int count, struct side sides[2])
{
    const double step = (high - low) / count, spare = 1e-6 + 1e-6 * (high - low);
    const double end = low + step * (i + 1) + (i + 1 == count ? spare : 0);
    sides[0] = (struct side){axis, low + step * i - (i == 0 ? spare : 0), false};
    sides[1] = (struct side){vec_scale(axis, -1), -end, true};
}

struct zone {
    int along, aside, high, left; /* left: 1 or -1 */
};

static void sides_of(const struct mesh_zones *z, const struct zone *at, struct vec low,
                     struct vec high, struct side sides[SIDES])
{
    const double wide = fmax(fabs(low.y), fabs(high.y));
    slab((struct vec){1, 0, 0}, low.x, high.x, at->along, z->along, sides);
    slab((struct vec){0, 0, 1}, low.z, high.z, at->high, z->high, sides + 2);
    slab((struct vec){0, at->left, 0}, 0, wide, at->aside, z->aside, sides + 4);
    if (at->aside == 0) {
        sides[4].offset = 0;
        sides[4].is_open = at->left < 0;
    }
}

static void add_fan(struct mesh *to, const struct polygon *p, uint32_t material)
{
    const uint32_t first = to->vertex_count;
    for (int i = 0; i < p->count; i++) {
        mesh_add_vertex(to, p->corner[i]);
    }
    for (uint32_t i = 1; i + 1 < (uint32_t)p->count; i++) {
        const struct vec a = vec_sub(p->corner[i], p->corner[0]);
        const struct vec b = vec_sub(p->corner[i + 1], p->corner[0]);
        if (vec_length(vec_cross(a, b)) > 1e-12) {
            mesh_add_triangle(to, first, first + i, first + i + 1, material);
        }
    }
}

/* TRACE_MATERIALS_MAX when there is no room: one is left for the ground. */
static uint32_t name_zone(struct mesh *to, const char *material, const struct zone *at,
                          bool has_sides)
{
    char name[TRACE_NAME_SIZE + 16];
    snprintf(name, sizeof name, "%s.%d%d%d%s", material, at->along + 1, at->aside + 1, at->high + 1,
             has_sides && at->left < 0 ? "r" : "");
    const uint32_t number = mesh_material(to, name);
    return number < TRACE_MATERIALS_MAX - 1 ? number : TRACE_MATERIALS_MAX;
}

static int add_piece(const struct mesh *m, const struct mesh_triangle *t, const struct side *sides,
                     const struct zone *at, bool has_sides, struct mesh *to)
{
    struct polygon p = {.count = 3};
    for (int i = 0; i < 3; i++) {
        p.corner[i] = m->vertices[t->corner[i]];
    }
    for (int s = 0; s < SIDES && p.count > 0; s++) {
        cut(&p, &sides[s]);
    }
    if (p.count < 3) {
        return 0;
    }
    const uint32_t material = name_zone(to, m->materials[t->material], at, has_sides);
    if (material == TRACE_MATERIALS_MAX) {
        return -1;
    }
    add_fan(to, &p, material);
    return 0;
}

static int add_zone(const struct mesh *m, const struct mesh_zones *z, const struct zone *at,
                    struct mesh *to)
{
    struct vec low, high;
    struct side sides[SIDES];
    mesh_bounds(m, &low, &high);
    sides_of(z, at, low, high, sides);
    for (uint32_t i = 0; i < m->triangle_count; i++) {
        if (add_piece(m, &m->triangles[i], sides, at, z->has_sides, to) != 0) {
            return -1;
        }
    }
    return 0;
}

int mesh_zone(struct mesh *m, const struct mesh_zones *z, const char *path)
{
    struct mesh cut_up = {0};
    int result = 0;
    for (int i = 0; i < z->along * z->aside * z->high * 2 && result == 0; i++) {
        const struct zone at = {i / 2 % z->along, i / 2 / z->along % z->aside,
                                i / 2 / z->along / z->aside, i % 2 == 0 ? 1 : -1};
        result = add_zone(m, z, &at, &cut_up);
    }
    if (result != 0 || cut_up.is_full) {
        mesh_free(&cut_up);
        return result != 0
                   ? hs_error(path, "give fewer --zones, or shorter names of materials",
                              "has more than %d zones of different materials, or a name is longer "
                              "than %d letters",
                              TRACE_MATERIALS_MAX - 1, TRACE_NAME_SIZE - 1)
                   : hs_error(path, "give fewer --zones", "out of memory");
    }
    mesh_free(m);
    *m = cut_up;
    return 0;
}
