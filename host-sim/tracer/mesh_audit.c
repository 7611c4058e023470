#include "tracer/mesh_audit.h"

#include "hs/error.h"

#include <stdio.h>
#include <stdlib.h>

/* Thinner than this by its longest side is a line: a ray's single precision cannot tell. */
static const double flatness_min = 1e-7;

static bool is_degenerate(const struct mesh *m, const struct mesh_triangle *t)
{
    const struct vec a = m->vertices[t->corner[0]];
    const struct vec u = vec_sub(m->vertices[t->corner[1]], a);
    const struct vec v = vec_sub(m->vertices[t->corner[2]], a);
    const struct vec w = vec_sub(u, v);
    const double longest = fmax(vec_dot(u, u), fmax(vec_dot(v, v), vec_dot(w, w)));
    return !(vec_length(vec_cross(u, v)) > flatness_min * longest) || !(longest > 1e-12);
}

uint32_t mesh_drop_degenerate(struct mesh *m)
{
    uint32_t kept = 0;
    for (uint32_t i = 0; i < m->triangle_count; i++) {
        if (!is_degenerate(m, &m->triangles[i])) {
            m->triangles[kept++] = m->triangles[i];
        }
    }
    const uint32_t dropped = m->triangle_count - kept;
    m->triangle_count = kept;
    return dropped;
}

/* One side of a triangle: from the lower place to the higher, or against it. */
struct edge {
    uint32_t low, high, triangle;
    int32_t sense;
};

struct place {
    struct vec at;
    uint32_t vertex;
};

static int by_place(const void *a, const void *b)
{
    const struct vec p = ((const struct place *)a)->at, q = ((const struct place *)b)->at;
    if (p.x != q.x) {
        return p.x < q.x ? -1 : 1;
    }
    if (p.y != q.y) {
        return p.y < q.y ? -1 : 1;
    }
    return p.z < q.z ? -1 : p.z > q.z;
}

static int by_ends(const void *a, const void *b)
{
    const struct edge *p = a, *q = b;
    if (p->low != q->low) {
        return p->low < q->low ? -1 : 1;
    }
    return p->high < q->high ? -1 : p->high > q->high;
}

/* For each vertex the index of the first at the same place. NULL without memory. */
static uint32_t *welded(const struct mesh *m)
{
    struct place *places = malloc(m->vertex_count * sizeof *places);
    uint32_t *weld = malloc(m->vertex_count * sizeof *weld);
    if (!places || !weld) {
        free(places);
        free(weld);
        return NULL;
    }
    for (uint32_t i = 0; i < m->vertex_count; i++) {
        places[i] = (struct place){m->vertices[i], i};
    }
    qsort(places, m->vertex_count, sizeof *places, by_place);
    uint32_t first = 0;
    for (uint32_t i = 0; i < m->vertex_count; i++) {
        if (by_place(&places[i], &places[first]) != 0) {
            first = i;
        }
        weld[places[i].vertex] = places[first].vertex;
    }
    free(places);
    return weld;
}

static size_t list_edges(const struct mesh *m, const uint32_t *weld, struct edge *edges,
                         struct mesh_audit *audit)
{
    size_t count = 0;
    for (uint32_t i = 0; i < m->triangle_count; i++) {
        const struct mesh_triangle *t = &m->triangles[i];
        if (is_degenerate(m, t)) {
            audit->degenerate++;
            continue;
        }
        for (int k = 0; k < 3; k++) {
            const uint32_t a = weld[t->corner[k]], b = weld[t->corner[(k + 1) % 3]];
            edges[count++] = a < b ? (struct edge){a, b, i, 1} : (struct edge){b, a, i, -1};
        }
    }
    qsort(edges, count, sizeof *edges, by_ends);
    return count;
}

static uint32_t root_of(uint32_t *parent, uint32_t i)
{
    while (parent[i] != i) {
        parent[i] = parent[parent[i]];
        i = parent[i];
    }
    return i;
}

struct parts {
    uint32_t *parent; /* of each triangle, up to the one that stands for its part */
    double *volume;   /* of the part, at that triangle, times six */
    bool *is_open;
};

/* Go through the edges that share both ends: as many one way as the other in a closed body. */
static void join_edges(const struct edge *edges, size_t count, struct parts *p,
                       struct mesh_audit *audit)
{
    for (size_t i = 0; i < count;) {
        int32_t balance = 0;
        size_t end = i;
        for (; end < count && by_ends(&edges[i], &edges[end]) == 0; end++) {
            balance += edges[end].sense;
            p->parent[root_of(p->parent, edges[end].triangle)] =
                root_of(p->parent, edges[i].triangle);
        }
        if (balance != 0) {
            audit->open_edges += (end - i) % 2 == 1;
            audit->turned_edges += (end - i) % 2 == 0;
            p->is_open[edges[i].triangle] = true;
        }
        i = end;
    }
}

static void count_parts(const struct mesh *m, struct parts *p, struct mesh_audit *audit)
{
    for (uint32_t i = 0; i < m->triangle_count; i++) {
        const uint32_t *c = m->triangles[i].corner;
        const uint32_t root = root_of(p->parent, i);
        p->volume[root] +=
            vec_dot(m->vertices[c[0]], vec_cross(m->vertices[c[1]], m->vertices[c[2]]));
        if (p->is_open[i]) {
            p->is_open[root] = true;
        }
    }
    for (uint32_t i = 0; i < m->triangle_count; i++) {
        if (p->parent[i] == i && !is_degenerate(m, &m->triangles[i])) {
            audit->part_count++;
            audit->inside_out += !p->is_open[i] && p->volume[i] < 0;
        }
    }
}

static void number_parts(uint32_t *parent, uint32_t count, int32_t *part_of, uint32_t *part_count)
{
    *part_count = 0;
    for (uint32_t i = 0; i < count; i++) {
        part_of[i] = -1;
    }
    for (uint32_t i = 0; i < count; i++) {
        int32_t *part = &part_of[root_of(parent, i)];
        *part = *part < 0 ? (int32_t)(*part_count)++ : *part;
    }
    for (uint32_t i = 0; i < count; i++) {
        part_of[i] = part_of[root_of(parent, i)];
    }
}

int mesh_parts(const struct mesh *m, int32_t *part_of, uint32_t *part_count)
{
    struct mesh_audit audit = {0};
    uint32_t *weld = welded(m);
    struct edge *edges = malloc(((size_t)m->triangle_count * 3 + 1) * sizeof *edges);
    struct parts p = {malloc((m->triangle_count + 1) * sizeof *p.parent), NULL,
                      calloc(m->triangle_count + 1, sizeof *p.is_open)};
    const bool has_memory = weld && edges && p.parent && p.is_open;
    if (has_memory) {
        for (uint32_t i = 0; i < m->triangle_count; i++) {
            p.parent[i] = i;
        }
        join_edges(edges, list_edges(m, weld, edges, &audit), &p, &audit);
        number_parts(p.parent, m->triangle_count, part_of, part_count);
    }
    free(weld);
    free(edges);
    free(p.parent);
    free(p.is_open);
    return has_memory ? 0 : -1;
}

/* Those that share both ends are one; returns how many that leaves. */
static size_t pair_edges(const struct edge *edges, size_t count, struct mesh_edge *pairs)
{
    size_t kept = 0;
    for (size_t i = 0, end; i < count; i = end) {
        for (end = i + 1; end < count && by_ends(&edges[i], &edges[end]) == 0; end++) {
        }
        if (end - i <= 2) {
            const uint32_t other = end - i == 2 ? edges[i + 1].triangle : MESH_NO_TRIANGLE;
            pairs[kept++] =
                (struct mesh_edge){edges[i].low, edges[i].high, edges[i].triangle, other};
        }
    }
    return kept;
}

struct mesh_edge *mesh_edges(const struct mesh *m, size_t *count)
{
    struct mesh_audit audit = {0};
    const size_t room = (size_t)m->triangle_count * 3 + 1;
    uint32_t *weld = welded(m);
    struct edge *edges = malloc(room * sizeof *edges);
    struct mesh_edge *pairs = malloc(room * sizeof *pairs);
    if (weld && edges && pairs) {
        *count = pair_edges(edges, list_edges(m, weld, edges, &audit), pairs);
    } else {
        free(pairs);
        pairs = NULL;
    }
    free(weld);
    free(edges);
    return pairs;
}

int mesh_audit(const struct mesh *m, const char *place, struct mesh_audit *audit)
{
    *audit = (struct mesh_audit){0};
    uint32_t *weld = welded(m);
    struct edge *edges = malloc((size_t)m->triangle_count * 3 * sizeof *edges);
    struct parts p = {malloc(m->triangle_count * sizeof *p.parent),
                      calloc(m->triangle_count, sizeof *p.volume),
                      calloc(m->triangle_count, sizeof *p.is_open)};
    const bool has_memory = weld && edges && p.parent && p.volume && p.is_open;
    if (has_memory) {
        for (uint32_t i = 0; i < m->triangle_count; i++) {
            p.parent[i] = i;
        }
        join_edges(edges, list_edges(m, weld, edges, audit), &p, audit);
        count_parts(m, &p, audit);
    }
    free(weld);
    free(edges);
    free(p.parent);
    free(p.volume);
    free(p.is_open);
    return has_memory ? 0 : hs_error(place, NULL, "out of memory to check the model");
}

int mesh_require_closed(const struct mesh_audit *a, const char *place)
{
    if (a->degenerate + a->open_edges + a->turned_edges + a->inside_out == 0) {
        return 0;
    }
    char text[200];
    snprintf(text, sizeof text,
             "%u triangles without area, %u open edges, %u edges whose two sides disagree, %u of "
             "%u parts inside out",
             a->degenerate, a->open_edges, a->turned_edges, a->inside_out, a->part_count);
    return hs_error(place, "mend the model, or take it as it is with --as-is: both sides reflect",
                    "%s", text);
}
