/* The tracer against closed forms, textbook cross sections and an intersection of its own. */
#include "check.h"
#include "known_records.h"
#include "shapes.h"
#include "support.h"
#include "tracer/models.h"
#include "tracer/trace.h"

#include "hs/rng.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double pi = 3.14159265358979323846;

static struct trace_order order_of(double azimuth_deg, double depression_deg, uint32_t cells,
                                   double cell_m, uint32_t rays_per_cell)
{
    return (struct trace_order){
        .look = {azimuth_deg, depression_deg, TRACE_WAVELENGTH_M},
        .grid = {cells, cells, cell_m},
        .rays_per_cell = rays_per_cell,
        .bounces = TRACE_BOUNCES_MAX,
        .threads = 2,
    };
}

/* Trace a mesh without ground, and free it. */
static void trace_mesh(struct mesh *m, const struct trace_order *o, struct trace_records *r)
{
    struct scene s;
    assert_int_equal(scene_open(&s, m, 0, "test"), 0);
    assert_int_equal(trace_run(&s, o, "test", r, NULL), 0);
    assert_int_equal(trace_records_check(r, "test"), 0);
    scene_close(&s);
    mesh_free(m);
}

/* A cube of 4 mm: a point. */
static void add_point(struct mesh *m, struct vec at)
{
    const struct vec half = {0.002, 0.002, 0.002};
    shape_box(m, vec_sub(at, half), vec_add(at, half), mesh_material(m, "metal"));
}

/* From wherever it is seen, a point is focused at its own place: to the right of the line of sight
 * and behind the centre along it. Half the distance, as eq. (4) prints, fails here. */
TEST(a_point_is_focused_where_it_is)
{
    const struct vec at = {0.31, -0.17, 0.24}; /* ahead, left, up */
    for (double azimuth = 0; azimuth < 360; azimuth += 37) {
        struct mesh m = {0};
        struct trace_records r;
        add_point(&m, at);
        struct trace_order o = order_of(azimuth, 30, 100, 0.01, 8);
        o.bounces = 1;
        trace_mesh(&m, &o, &r);
        /* The radar stands at `azimuth` from the nose by the right. */
        const double a = azimuth * pi / 180, psi = pi / 6;
        const double toward = at.x * cos(a) - at.y * sin(a);
        const double across = at.x * sin(a) + at.y * cos(a);
        const double range = -toward * cos(psi) - at.z * sin(psi);
        assert_true(r.bounces[0].count > 0);
        for (uint32_t i = 0; i < r.bounces[0].count; i++) {
            const struct trace_record *t = &r.bounces[0].records[i];
            assert_true(fabs((double)t->across_m - across) < 0.004);
            assert_true(fabs((double)t->range_m - range) < 0.004);
            const double phase =
                remainder(-4 * pi * (double)t->range_m / TRACE_WAVELENGTH_M, 2 * pi);
            assert_true(fabs(remainder((double)t->phase_rad - phase, 2 * pi)) < 1e-3);
        }
        trace_records_free(&r);
    }
}

/* The same rays through a dihedral as known_records.h has in closed form. */
TEST(a_dihedral_gives_the_records_of_its_closed_form)
{
    const double psi = 15 * pi / 180, height = 0.5, side = 1;
    struct trace_records known, r;
    known_dihedral(&known, side, height, 15, 40);
    struct mesh m = {0};
    const uint32_t metal = mesh_material(&m, "metal"), floor = mesh_material(&m, "floor");
    const double depth = height / tan(psi);
    shape_plate(&m, (struct vec){0, -side / 2, 0}, (struct vec){0, side, 0},
                (struct vec){0, 0, height}, metal);
    shape_plate(&m, (struct vec){0, -side / 2, 0}, (struct vec){depth, 0, 0},
                (struct vec){0, side, 0}, floor);
    struct trace_order o = order_of(0, 15, 400, 0.01, 1);
    trace_mesh(&m, &o, &r);
    /* Other rays than the known ones: compare each with the known law at its own place. */
    assert_int_equal(r.bounces[2].count, 0);
    assert_true(r.bounces[1].count > 10000);
    for (uint32_t b = 0; b < 2; b++) {
        for (uint32_t i = 0; i < r.bounces[b].count; i++) {
            const struct trace_record *t = &r.bounces[b].records[i];
            const bool is_wall = t->material == metal;
            const struct trace_record *k =
                &known.bounces[b].records[(is_wall == (b == 0)) ? 40 * 39 : 0];
            assert_int_equal(k->material, t->material);
            assert_true(fabsf(t->incidence_rad - k->incidence_rad) < 1e-6f);
            assert_true(fabsf(t->echo_rad - k->echo_rad) < 1e-6f);
            assert_true(fabsf(t->turn_rad - k->turn_rad) < 1e-6f);
            for (int c = 0; c < 3; c++) {
                assert_true(fabsf(t->normal[c] - k->normal[c]) < 1e-5f);
            }
            assert_int_equal(t->flags & TRACE_BLOCKED, 0);
            const double up =
                r.sensor.low_up_m + (t->ray / r.sensor.columns + 0.5) * r.sensor.step_up_m;
            const double range = b == 1 ? 0 : is_wall ? -up * tan(psi) : up / tan(psi);
            assert_true(fabs((double)t->range_m - range) < 1e-6);
        }
    }
    trace_records_free(&known);
    trace_records_free(&r);
}

/* Area of the plane whose rays come back to the radar after exactly `bounces` reflections: the
 * aperture A of a corner, whose cross section is 4 pi A^2 / wavelength^2. */
static double aperture_m2(const struct trace_records *r, uint32_t bounces)
{
    const struct trace_bounce *b = &r->bounces[bounces - 1];
    uint32_t count = 0;
    for (uint32_t i = 0; i < b->count; i++) {
        const struct trace_record *t = &b->records[i];
        /* Specular: the bisector of source and radar is the normal. */
        const bool is_specular = fabsf(t->turn_rad - 2 * t->incidence_rad) < 1e-3f &&
                                 fabsf(t->echo_rad - t->incidence_rad) < 1e-3f;
        count += is_specular && !(t->flags & TRACE_BLOCKED);
    }
    return count * r->sensor.step_across_m * r->sensor.step_up_m;
}

/* Knott, Shaeffer, Tuley, Radar Cross Section, table 6.1: a plate ab upright, 4 pi (ab)^2 / l^2; a
 * dihedral of plates ab, 8 pi (ab)^2 / l^2; square plates of side a in a trihedral, 12 pi a^4 /
 * l^2; triangular ones, 4 pi a^4 / (3 l^2). So the apertures ab, ab sqrt 2, a^2 sqrt 3, a^2 /
 * sqrt 3. */
TEST(corner_apertures_are_those_of_the_textbook)
{
    const double boresight = atan(sqrt(0.5)) * 180 / pi; /* 35.26 degrees above two plates */
    const struct vec s = {sqrt(0.5), sqrt(0.5), 0}, p = {sqrt(0.5), -sqrt(0.5), 0}, up = {0, 0, 1};
    const struct vec o = {0, 0, 0};
    struct trace_records r;

    struct mesh m = {0};
    const uint32_t metal = mesh_material(&m, "metal");
    struct trace_order order = order_of(0, 45, 300, 0.01, 2);
    shape_plate(&m, (struct vec){0, -0.5, 0}, (struct vec){0, 1, 0}, up, metal);
    shape_plate(&m, (struct vec){0, -0.5, 0}, (struct vec){1, 0, 0}, (struct vec){0, 1, 0}, metal);
    trace_mesh(&m, &order, &r);
    assert_true(fabs(aperture_m2(&r, 2) - sqrt(2)) < 0.01);
    assert_true(aperture_m2(&r, 1) < 1e-9); /* neither plate alone looks at the radar */
    trace_records_free(&r);

    order.look.depression_deg = boresight;
    mesh_material(&m, "metal");
    shape_plate(&m, o, p, s, metal);
    shape_plate(&m, o, up, s, metal);
    shape_plate(&m, o, p, up, metal);
    trace_mesh(&m, &order, &r);
    assert_true(fabs(aperture_m2(&r, 3) - sqrt(3)) < 0.01);
    assert_true(aperture_m2(&r, 2) < 1e-9);
    trace_records_free(&r);

    mesh_material(&m, "metal");
    shape_triangle(&m, o, p, s, metal);
    shape_triangle(&m, o, s, up, metal);
    shape_triangle(&m, o, up, p, metal);
    trace_mesh(&m, &order, &r);
    assert_true(fabs(aperture_m2(&r, 3) - 1 / sqrt(3)) < 0.01);
    trace_records_free(&r);
}

/* Off its boresight too, what a trihedral returns after three bounces comes from its apex. */
TEST(three_bounces_of_a_trihedral_focus_in_its_apex)
{
    const struct vec apex = {0.2, 0.3, 0.1};
    for (double azimuth = 340; azimuth <= 380; azimuth += 10) {
        struct mesh m = {0};
        const uint32_t metal = mesh_material(&m, "metal");
        const struct vec s = {sqrt(0.5), sqrt(0.5), 0}, p = {sqrt(0.5), -sqrt(0.5), 0};
        const struct vec up = {0, 0, 1};
        shape_plate(&m, apex, p, s, metal);
        shape_plate(&m, apex, up, s, metal);
        shape_plate(&m, apex, p, up, metal);
        struct trace_order o = order_of(fmod(azimuth, 360), 25, 200, 0.02, 1);
        struct trace_records r;
        trace_mesh(&m, &o, &r);
        const double a = azimuth * pi / 180, psi = 25 * pi / 180;
        const double across = apex.x * sin(a) + apex.y * cos(a);
        const double range = -(apex.x * cos(a) - apex.y * sin(a)) * cos(psi) - apex.z * sin(psi);
        assert_true(r.bounces[2].count > 1000);
        for (uint32_t i = 0; i < r.bounces[2].count; i++) {
            assert_true(fabs((double)r.bounces[2].records[i].across_m - across) < 2e-6);
            assert_true(fabs((double)r.bounces[2].records[i].range_m - range) < 2e-6);
        }
        assert_int_equal(r.bounces[3].count, 0);
        trace_records_free(&r);
    }
}

/* A box hides the ground behind it from primary rays, and its own face from the echo of what lies
 * before it when the echo would pass through it. */
TEST(nothing_echoes_from_the_shadow)
{
    struct mesh m = {0};
    const double height = 1, psi = 30 * pi / 180;
    shape_box(&m, (struct vec){-0.5, -1, 0}, (struct vec){0.5, 1, height},
              mesh_material(&m, "metal"));
    struct trace_order o = order_of(0, 30, 160, 0.05, 2);
    struct scene s;
    struct trace_records r;
    assert_int_equal(scene_open(&s, &m, trace_ground_half_m(&o.grid, 30), "test"), 0);
    assert_int_equal(trace_run(&s, &o, "test", &r, NULL), 0);
    const uint32_t ground = mesh_material(&m, "ground");
    uint32_t lit_behind = 0;
    for (uint32_t i = 0; i < r.bounces[0].count; i++) {
        const struct trace_record *t = &r.bounces[0].records[i];
        const double away = (double)t->range_m / cos(psi);
        if (t->material == ground && fabsf(t->across_m) < 0.99f) {
            assert_false(away > -0.49 && away < 0.5 + height / tan(psi) - 0.02);
            lit_behind += away > 0.5 + height / tan(psi);
        }
    }
    assert_true(lit_behind > 1000);
    scene_close(&s);
    mesh_free(&m);
    trace_records_free(&r);
}

/* Under a roof: the echo of the floor's reflection is cut off, and said to be. */
TEST(an_echo_under_a_roof_is_blocked)
{
    struct mesh m = {0};
    const uint32_t metal = mesh_material(&m, "metal");
    /* A mirror ahead sends the rays back under the roof; from there the radar is not seen. */
    const struct vec mirror = {0, -0.5, 0};
    shape_plate(&m, mirror, (struct vec){0, 1, 0}, (struct vec){0, 0, 0.5}, metal);
    shape_plate(&m, (struct vec){0.2, -0.5, 0.9}, (struct vec){2, 0, 0}, (struct vec){0, 1, 0},
                metal);
    shape_plate(&m, (struct vec){0, -0.5, 0}, (struct vec){3, 0, 0}, (struct vec){0, 1, 0}, metal);
    struct trace_order o = order_of(0, 45, 400, 0.02, 1);
    struct trace_records r;
    trace_mesh(&m, &o, &r);
    uint32_t blocked = 0;
    for (uint32_t i = 0; i < r.bounces[0].count; i++) {
        blocked += r.bounces[0].records[i].flags & TRACE_BLOCKED;
    }
    assert_int_equal(blocked, 0); /* what a primary ray meets sees the radar */
    for (uint32_t b = 1; b < TRACE_BOUNCES_MAX; b++) {
        for (uint32_t i = 0; i < r.bounces[b].count; i++) {
            const struct trace_record *t = &r.bounces[b].records[i];
            blocked += t->echo_rad < 1.5f && (t->flags & TRACE_BLOCKED); /* facing the radar */
        }
    }
    assert_true(blocked > 100);
    trace_records_free(&r);
}

/* Moeller and Trumbore (1997), in double precision, over all triangles. */
static uint32_t brute_force(const struct mesh *m, struct vec from, struct vec along,
                            double *distance, double *edge_distance)
{
    uint32_t best = SCENE_MISS;
    *distance = INFINITY;
    *edge_distance = INFINITY;
    for (uint32_t i = 0; i < m->triangle_count; i++) {
        const uint32_t *c = m->triangles[i].corner;
        const struct vec a = m->vertices[c[0]], u = vec_sub(m->vertices[c[1]], a);
        const struct vec v = vec_sub(m->vertices[c[2]], a), p = vec_cross(along, v);
        const double det = vec_dot(u, p);
        const struct vec to = vec_sub(from, a), q = vec_cross(to, u);
        const double s = vec_dot(to, p) / det, t = vec_dot(along, q) / det;
        const double far = vec_dot(v, q) / det, margin = fmin(fmin(s, t), 1 - s - t);
        if (det != 0 && far > 0) {
            *edge_distance = fmin(*edge_distance, fabs(margin));
        }
        if (det != 0 && far > 0 && margin >= 0 && far < *distance) {
            *distance = far;
            best = i;
        }
    }
    return best;
}

TEST(embree_meets_what_brute_force_meets)
{
    struct mesh m = {0};
    model_tank(&m);
    struct scene s;
    assert_int_equal(scene_open(&s, &m, 0, "test"), 0);
    struct hs_rng rng;
    hs_rng_seed(&rng, 1);
    uint32_t met = 0, unsure = 0;
    for (int i = 0; i < 4000; i++) {
        struct scene_rays rays = {.count = 0};
        const struct vec at = {hs_rng_normal(&rng), hs_rng_normal(&rng), hs_rng_normal(&rng)};
        const struct vec from = vec_scale(at, 12 / vec_length(at));
        const struct vec aim = {7 * hs_rng_uniform(&rng) - 3.5, 3 * hs_rng_uniform(&rng) - 1.5,
                                2 * hs_rng_uniform(&rng)};
        const struct vec way = vec_sub(aim, from);
        const struct vec along = vec_scale(way, 1 / vec_length(way));
        scene_rays_add(&rays, from, along);
        uint32_t facet[SCENE_PACKET];
        scene_meet(&s, &rays, facet);
        double distance, edge;
        const uint32_t expected = brute_force(&m, from, along, &distance, &edge);
        assert_int_equal(scene_is_blocked(&s, &rays) & 1, facet[0] != SCENE_MISS);
        if (edge < 1e-4) { /* within single precision of an edge either answer is right */
            unsure++;
            continue;
        }
        if (expected != facet[0]) { /* the same place, where two bodies share a plane */
            assert_true(expected != SCENE_MISS && facet[0] != SCENE_MISS);
            const struct scene_facet *f = &s.facets[facet[0]];
            const double other =
                (f->offset_m - vec_dot(f->normal, from)) / vec_dot(f->normal, along);
            assert_true(fabs(other - distance) < 1e-5);
        }
        met += expected != SCENE_MISS;
    }
    assert_true(met > 2000 && unsure < 1000);
    scene_close(&s);
    mesh_free(&m);
}

TEST(the_records_do_not_depend_on_the_number_of_threads)
{
    struct mesh m = {0};
    model_slicy(&m);
    struct trace_order o = order_of(20, 15, TRACE_CHIP_CELLS, TRACE_CHIP_CELL_M, 1);
    struct scene s;
    assert_int_equal(scene_open(&s, &m, trace_ground_half_m(&o.grid, 15), "test"), 0);
    struct trace_records one, three;
    o.threads = 1;
    assert_int_equal(trace_run(&s, &o, "test", &one, NULL), 0);
    o.threads = 3;
    assert_int_equal(trace_run(&s, &o, "test", &three, NULL), 0);
    for (uint32_t b = 0; b < o.bounces; b++) {
        assert_int_equal(one.bounces[b].count, three.bounces[b].count);
        if (one.bounces[b].count > 0) {
            assert_memory_equal(one.bounces[b].records, three.bounces[b].records,
                                one.bounces[b].count * sizeof(struct trace_record));
        }
    }
    assert_true(one.bounces[4].count > 0);
    assert_int_equal(trace_records_check(&one, "test"), 0);
    trace_records_free(&one);
    trace_records_free(&three);
    scene_close(&s);
    mesh_free(&m);
}

/* How many records of one have no equal in the other, by ray. */
static uint32_t apart(const struct trace_bounce *one, const struct trace_bounce *other)
{
    uint32_t alike = 0;
    for (uint32_t i = 0, j = 0; i < one->count && j < other->count;) {
        const struct trace_record *a = &one->records[i], *b = &other->records[j];
        alike += a->ray == b->ray && fabsf(a->range_m - b->range_m) < 1e-4f &&
                 fabsf(a->across_m - b->across_m) < 1e-4f && a->flags == b->flags;
        i += a->ray <= b->ray;
        j += b->ray <= a->ray;
    }
    return one->count + other->count - 2 * alike;
}

/* The same tank, but full of small triangles that no ray sees: more of them than there are rays,
 * which are cast then. */
TEST(primary_rays_meet_the_same_drawn_or_cast)
{
    const struct trace_order o = order_of(33, 20, TRACE_CHIP_CELLS, TRACE_CHIP_CELL_M, 1);
    struct trace_records drawn, cast;
    for (int is_cast = 0; is_cast < 2; is_cast++) {
        struct mesh m = {0};
        struct scene s;
        model_tank(&m);
        const uint32_t first = mesh_add_vertex(&m, (struct vec){0, 0, 0.9});
        mesh_add_vertex(&m, (struct vec){0.01, 0, 0.9});
        mesh_add_vertex(&m, (struct vec){0, 0.01, 0.9});
        for (int i = 0; is_cast && i < 40000; i++) {
            mesh_add_triangle(&m, first, first + 1, first + 2, 0);
        }
        assert_int_equal(scene_open(&s, &m, trace_ground_half_m(&o.grid, 20), "test"), 0);
        assert_int_equal(trace_run(&s, &o, "test", is_cast ? &cast : &drawn, NULL), 0);
        scene_close(&s);
        mesh_free(&m);
    }
    assert_true(drawn.sensor.columns * drawn.sensor.rows < 40000);
    for (uint32_t b = 0; b < o.bounces; b++) {
        const uint32_t count = drawn.bounces[b].count;
        assert_true(count > 1000);
        assert_true(apart(&drawn.bounces[b], &cast.bounces[b]) <= count / 200);
    }
    trace_records_free(&drawn);
    trace_records_free(&cast);
}
