#include "tracer/edges.h"

#include "hs/error.h"
#include "tracer/mesh_audit.h"
#include "tracer/wave.h"

#include <stdlib.h>

static const double pi = 3.14159265358979323846;
static const double lift_m = 1e-3; /* off the edge, to look from it */
enum { PIECES_MAX = 1 << 24 };

/* ---- the law ---- */

/* Straight on to a face two poles cancel: a little beside it. What is left is smooth. */
static double off_poles(double wedge_rad, double phi_rad)
{
    const double phi = fabs(cos(phi_rad)) < 1e-5 ? phi_rad + 3e-5 : phi_rad;
    return fabs(cos(wedge_rad - phi)) < 1e-5 ? phi - 6e-5 : phi;
}

struct edge_waves edges_waves(double wedge_rad, double phi_rad)
{
    const double n = wedge_rad / pi, phi = off_poles(wedge_rad, phi_rad), other = wedge_rad - phi;
    const double share = sin(pi / n) / n, straight = share / (cos(pi / n) - 1);
    const double back = share / (cos(pi / n) - cos(2 * phi / n));
    const double optics = (phi < pi ? tan(phi) / 2 : 0) + (other < pi ? tan(other) / 2 : 0);
    return (struct edge_waves){straight - back - optics, straight + back + optics};
}

/* ---- an edge ---- */

struct wedge {
    struct vec from, along; /* along: of unit length */
    double length_m, angle_rad;
    struct vec face, normal; /* of the first face: from the edge into it, and outwards */
    struct vec outward;      /* away from both faces */
    uint32_t material;
};

static struct vec unit(struct vec v)
{
    const double length = vec_length(v);
    return length > 0 ? vec_scale(v, 1 / length) : v;
}

static struct vec corner_at(const struct mesh *m, uint32_t triangle, int i)
{
    return m->vertices[m->triangles[triangle].corner[i]];
}

static struct vec normal_of(const struct mesh *m, uint32_t triangle)
{
    const struct vec a = corner_at(m, triangle, 0);
    return unit(
        vec_cross(vec_sub(corner_at(m, triangle, 1), a), vec_sub(corner_at(m, triangle, 2), a)));
}

/* From the edge into a triangle, square to the edge. */
static struct vec into(const struct mesh *m, const struct wedge *w, uint32_t triangle)
{
    const struct vec sum = vec_add(vec_add(corner_at(m, triangle, 0), corner_at(m, triangle, 1)),
                                   corner_at(m, triangle, 2));
    const struct vec inside = vec_mad(vec_scale(sum, 1.0 / 3), w->from, -1);
    return unit(vec_mad(inside, w->along, -vec_dot(inside, w->along)));
}

/* Returns false for an edge that is none: of a flat face, a round body, or an inner one. */
static bool wedge_of(const struct mesh *m, const struct mesh_edge *e, struct wedge *w)
{
    const struct vec way = vec_sub(m->vertices[e->to], m->vertices[e->from]);
    *w = (struct wedge){.from = m->vertices[e->from],
                        .along = unit(way),
                        .length_m = vec_length(way),
                        .angle_rad = 2 * pi,
                        .material = m->triangles[e->triangle].material};
    w->face = into(m, w, e->triangle);
    w->normal = normal_of(m, e->triangle);
    w->outward = vec_scale(w->face, -1);
    if (e->other == MESH_NO_TRIANGLE) {
        return true;
    }
    const struct vec beyond = into(m, w, e->other);
    const double above = vec_dot(beyond, w->normal);
    const double turn_rad = atan2(-above, -vec_dot(beyond, w->face)); /* of the face; 0: flat */
    w->angle_rad = pi + turn_rad;
    w->outward = unit(vec_scale(vec_add(w->face, beyond), -1));
    return turn_rad >= EDGES_LEAST_TURN_DEG * pi / 180;
}

/* ---- its echoes ---- */

struct maker {
    const struct scene *scene;
    const struct trace_axes axes;
    const struct reflect_law *law;
    double piece_m;
    size_t room;
    struct edge_echoes *echoes;
};

/* The edge's own waves between the two polarisations: the part along the edge, and that across. */
static double polarised(const struct maker *k, const struct wedge *w, struct vec radar,
                        const struct edge_waves *waves)
{
    const double lengthwise = vec_dot(radar, w->along), square = 1 - lengthwise * lengthwise;
    const struct vec across = vec_cross(radar, w->along); /* as long as sqrt(square) */
    struct vec sent = reflect_is_vv(k->law) ? k->axes.rise : k->axes.across, received = sent;
    if (k->law->channel != REFLECT_AS_LAW) {
        sent = wave_sent(k->law->channel, &k->axes);
        received = wave_received(k->law->channel, &k->axes);
    }
    return (waves->soft * vec_dot(sent, w->along) * vec_dot(received, w->along) -
            waves->hard * vec_dot(sent, across) * vec_dot(received, across)) /
           square;
}

/* Straight on, over that of metal. */
static double complex metal_share(const struct maker *k, const struct wedge *w)
{
    const struct trace_record straight_on = {.material = (uint8_t)w->material};
    return k->law->channel != REFLECT_AS_LAW ? -reflect_pair_of(k->law, &straight_on).hh
                                             : -reflect_field_of(k->law, &straight_on).specular *
                                                   (reflect_is_vv(k->law) ? -1 : 1);
}

/* What a piece of a wedge returns, for a range of 0; 0 where the radar sees it from within. */
static double complex field_of(const struct maker *k, const struct wedge *w, double piece_m)
{
    const struct vec radar = vec_scale(k->axes.sight, -1);
    const double lengthwise = vec_dot(radar, w->along), square = 1 - lengthwise * lengthwise;
    const double angle = atan2(vec_dot(radar, w->normal), vec_dot(radar, w->face));
    const double phi = angle < 0 ? angle + 2 * pi : angle;
    if (square < 1e-9 || phi > w->angle_rad) {
        return 0;
    }
    const struct edge_waves waves = edges_waves(w->angle_rad, phi);
    const double x = 2 * pi * piece_m * lengthwise / k->law->wavelength_m;
    return -I * metal_share(k, w) * piece_m / sqrt(pi) * (fabs(x) > 1e-6 ? sin(x) / x : 1) *
           polarised(k, w, radar, &waves);
}

static bool make_room(struct edge_echoes *e, size_t *room)
{
    if (e->count + SCENE_PACKET <= *room) {
        return true;
    }
    const size_t more = 2 * *room + 1024;
    struct coherent_echo *echoes =
        more <= PIECES_MAX ? realloc(e->echoes, more * sizeof *echoes) : NULL;
    if (!echoes) {
        return false;
    }
    e->echoes = echoes;
    *room = more;
    return true;
}

/* Add the pieces first.. of the wedge, up to a packet, that the radar sees. */
static bool add_pieces(struct maker *k, const struct wedge *w, uint32_t first, uint32_t pieces,
                       double complex field)
{
    const double piece_m = w->length_m / pieces;
    const struct vec radar = vec_scale(k->axes.sight, -1);
    struct scene_rays rays = {.count = 0};
    struct vec middles[SCENE_PACKET];
    for (uint32_t i = first; i < pieces && rays.count < SCENE_PACKET; i++) {
        middles[rays.count] = vec_mad(w->from, w->along, (i + 0.5) * piece_m);
        scene_rays_add(&rays, vec_mad(middles[rays.count], w->outward, lift_m), radar);
    }
    const uint32_t blocked = scene_is_blocked(k->scene, &rays);
    if (!make_room(k->echoes, &k->room)) {
        return false;
    }
    for (uint32_t i = 0; i < rays.count; i++) {
        const double range_m = vec_dot(middles[i], k->axes.sight);
        const double turns = 2 * range_m / k->law->wavelength_m;
        if (!(blocked >> i & 1)) {
            k->echoes->echoes[k->echoes->count++] =
                (struct coherent_echo){vec_dot(middles[i], k->axes.across), range_m,
                                       field * cexp(-2 * pi * I * (turns - floor(turns)))};
        }
    }
    return true;
}

static bool add_wedge(struct maker *k, const struct wedge *w)
{
    const double top_m = fmax(w->from.z, w->from.z + w->along.z * w->length_m);
    if (k->scene->ground_half_m > 0 && top_m < lift_m) {
        return true; /* it stands on the ground */
    }
    const double count = fmax(ceil(w->length_m / k->piece_m), 1);
    if (count > PIECES_MAX) {
        return false;
    }
    const uint32_t pieces = (uint32_t)count;
    const double complex field = field_of(k, w, w->length_m / pieces);
    bool has_room = true;
    for (uint32_t i = 0; field != 0 && has_room && i < pieces; i += SCENE_PACKET) {
        has_room = add_pieces(k, w, i, pieces, field);
    }
    return has_room;
}

int edges_make(struct edge_echoes *e, const struct mesh *m, const struct scene *s,
               const struct trace_look *look, const struct reflect_law *law, double piece_m)
{
    size_t count = 0;
    *e = (struct edge_echoes){0};
    struct mesh_edge *edges = mesh_edges(m, &count);
    struct maker k = {s, trace_axes_of(look), law, piece_m, 0, e};
    bool is_done = edges != NULL;
    for (size_t i = 0; is_done && i < count; i++) {
        struct wedge w;
        is_done = !wedge_of(m, &edges[i], &w) || add_wedge(&k, &w);
    }
    free(edges);
    if (!is_done) {
        edges_free(e);
        return hs_error("--edges", "reduce the model, or give a larger --cell",
                        "out of memory, or more than %d pieces of edges", PIECES_MAX);
    }
    return 0;
}

void edges_free(struct edge_echoes *e)
{
    free(e->echoes);
    *e = (struct edge_echoes){0};
}
