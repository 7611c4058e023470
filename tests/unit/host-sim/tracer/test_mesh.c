/* Models: bodies are closed, files are believed only as far as they make sense. */
#include "check.h"
#include "shapes.h"
#include "support.h"
#include "tracer/mesh_audit.h"
#include "tracer/models.h"
#include "tracer/obj_file.h"
#include "tracer/scene.h"

#include "hs/rng.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const char *scratch(void)
{
    static char path[256];
    support_run("mkdir -p %s/tmp", support_build_dir());
    snprintf(path, sizeof path, "%s/tmp/model.obj", support_build_dir());
    return path;
}

static struct mesh_audit audited(const struct mesh *m)
{
    struct mesh_audit audit;
    assert_false(m->is_full);
    assert_int_equal(mesh_audit(m, "test", &audit), 0);
    return audit;
}

static bool is_clean(const struct mesh_audit *a)
{
    return a->degenerate + a->open_edges + a->turned_edges + a->inside_out == 0;
}

static void add_box(struct mesh *m)
{
    shape_box(m, (struct vec){-1, -2, 0}, (struct vec){1, 2, 3}, mesh_material(m, "metal"));
}

static double volume_of(const struct mesh *m)
{
    double sum = 0;
    for (uint32_t i = 0; i < m->triangle_count; i++) {
        const uint32_t *c = m->triangles[i].corner;
        sum += vec_dot(m->vertices[c[0]], vec_cross(m->vertices[c[1]], m->vertices[c[2]])) / 6;
    }
    return sum;
}

TEST(bodies_are_closed_and_have_the_volume_of_their_formula)
{
    struct mesh m = {0};
    add_box(&m);
    struct mesh_audit a = audited(&m);
    assert_true(is_clean(&a) && a.part_count == 1);
    assert_true(fabs(volume_of(&m) - 24) < 1e-9);
    mesh_free(&m);

    const struct shape_round cone = {{1, 2, 3}, {1, 4, 3}, 2, 1, 720, true};
    shape_round(&m, &cone, mesh_material(&m, "metal"));
    a = audited(&m);
    assert_true(is_clean(&a));
    /* A frustum of height 2 and radii 2 and 1: pi h (R^2 + R r + r^2) / 3. */
    assert_true(fabs(volume_of(&m) - 3.14159265 * 2 * 7 / 3) < 1e-3);
    mesh_free(&m);

    const double wedge[][2] = {{0, 0}, {3, 0}, {0, 1}};
    shape_profile(&m, wedge, 3, -1, 1, mesh_material(&m, "metal"));
    a = audited(&m);
    assert_true(is_clean(&a));
    assert_true(fabs(volume_of(&m) - 3) < 1e-9);
    mesh_free(&m);

    for (int i = 0; i < model_kind_count; i++) {
        model_kinds[i].build(&m);
        a = audited(&m);
        assert_true(is_clean(&a) || model_kinds[i].is_open);
        mesh_free(&m);
    }
}

TEST(the_aircraft_has_its_public_dimensions)
{
    struct mesh m = {0};
    struct vec low, high;
    const double foot_m = 0.3048;
    model_aircraft(&m);
    mesh_bounds(&m, &low, &high);
    assert_true(fabs(high.x - low.x - (49 + 5 / 12.0) * foot_m) < 0.02);
    assert_true(fabs(high.y - low.y - (32 + 8 / 12.0) * foot_m) < 0.02);
    assert_true(fabs(high.z - 16 * foot_m) < 0.02);
    assert_true(low.z >= 0 && low.z < 0.01);
    mesh_free(&m);
}

TEST(each_fault_of_a_body_is_counted)
{
    struct mesh m = {0};
    add_box(&m);
    m.triangle_count--; /* a hole */
    struct mesh_audit a = audited(&m);
    assert_int_equal(a.open_edges, 3);
    assert_int_equal(mesh_require_closed(&a, "test"), -1);
    m.triangle_count++;

    uint32_t *c = m.triangles[4].corner; /* one triangle turned over */
    const uint32_t kept = c[0];
    c[0] = c[1];
    c[1] = kept;
    a = audited(&m);
    assert_int_equal(a.turned_edges, 3);
    assert_int_equal(a.open_edges, 0);

    for (uint32_t i = 0; i < m.triangle_count; i++) { /* now all but that one */
        uint32_t *t = m.triangles[i].corner, k = t[0];
        if (i != 4) {
            t[0] = t[1];
            t[1] = k;
        }
    }
    a = audited(&m);
    assert_int_equal(a.inside_out, 1);
    assert_int_equal(a.turned_edges, 0);

    mesh_add_triangle(&m, 0, 0, 1, 0);
    mesh_add_triangle(&m, 0, 1, mesh_add_vertex(&m, m.vertices[1]), 0);
    a = audited(&m);
    assert_int_equal(a.degenerate, 2);
    assert_int_equal(mesh_drop_degenerate(&m), 2);
    assert_int_equal(m.triangle_count, 12);
    mesh_free(&m);
}

/* Files repeat the corners of each face: they count as one place. */
TEST(corners_at_one_place_are_one)
{
    struct mesh box = {0}, loose = {0};
    add_box(&box);
    mesh_material(&loose, "metal");
    for (uint32_t i = 0; i < box.triangle_count; i++) {
        const uint32_t *c = box.triangles[i].corner;
        shape_triangle(&loose, box.vertices[c[0]], box.vertices[c[1]], box.vertices[c[2]], 0);
    }
    const struct mesh_audit a = audited(&loose);
    assert_true(is_clean(&a) && a.part_count == 1);
    mesh_free(&box);
    mesh_free(&loose);
}

TEST(a_model_that_is_written_is_read_back)
{
    struct mesh m = {0}, again;
    model_tank(&m);
    assert_int_equal(obj_write(&m, scratch()), 0);
    assert_int_equal(obj_read(&again, scratch(), OBJ_UP_Z), 0);
    assert_int_equal(again.vertex_count, m.vertex_count);
    assert_int_equal(again.triangle_count, m.triangle_count);
    for (uint32_t i = 0; i < m.triangle_count; i++) {
        assert_memory_equal(again.triangles[i].corner, m.triangles[i].corner, 12);
        assert_string_equal(again.materials[again.triangles[i].material],
                            m.materials[m.triangles[i].material]);
    }
    for (uint32_t i = 0; i < m.vertex_count; i++) {
        assert_true(vec_length(vec_sub(again.vertices[i], m.vertices[i])) == 0);
    }
    mesh_free(&m);
    mesh_free(&again);
}

static int read_text(struct mesh *m, const char *text)
{
    FILE *out = fopen(scratch(), "wb");
    fputs(text, out);
    fclose(out);
    return obj_read(m, scratch(), OBJ_UP_Y);
}

TEST(a_file_is_read_as_the_format_says)
{
    struct mesh m;
    assert_int_equal(read_text(&m,
                               "# y up\r\n"
                               "mtllib x.mtl\n"
                               "v 0 0 0\nv 1 0 0 1.0\n\tv 1 2e0 0\nv 0 2 -3\nvn 0 0 1\n"
                               "f 1 2 3 # behind\n"
                               "usemtl rubber tyre\n"
                               "f -4//1 -3//1 -2//1 \n"
                               "v 0 2 0\nf 1/1 2/2 3/3 5/4\n"),
                     0);
    assert_int_equal(m.triangle_count, 4);
    assert_string_equal(m.materials[m.triangles[0].material], "metal");
    assert_string_equal(m.materials[m.triangles[1].material], "rubber");
    assert_int_equal(m.triangles[1].corner[0], 0);
    assert_true(m.vertices[3].x == 0 && m.vertices[3].y == 3 && m.vertices[3].z == 2);
    mesh_free(&m);
}

TEST(a_file_that_makes_no_sense_is_refused)
{
    static const char *const bad[] = {
        "",
        "v 0 0 0\nv 1 0 0\nv 0 1 0\n",                             /* no face */
        "v 0 0 0\nv 1 0 0\nv 0 nan 0\nf 1 2 3\n",                  /* no number */
        "v 0 0 0\nv 1 0 0\nv 0 inf 0\nf 1 2 3\n",                  /* endless */
        "v 0 0 0\nv 1 0 0\nv 0 1e300 0\nf 1 2 3\n",                /* out of the world */
        "v 0 0 0\nv 1 0\nv 0 1 0\nf 1 2 3\n",                      /* two numbers */
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n",                    /* no such vertex */
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 0\n",                    /* counted from 1 */
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 -4\n",                   /* too far back */
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 99999999999999999999\n", /* no number holds it */
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 x\n",                    /* a letter */
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2\n",                      /* a line */
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 \\\n3\n",                /* a broken line */
        "v 0 0 0\nv 2 0 0\nv 1 .1 0\nv 0 2 0\nf 1 2 3 4\n",        /* not convex */
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl \x01\nf 1 2 3\n",       /* not printable */
        "v 0 0 0\ncurv 0 1 1\n",                                   /* curved */
    };
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        struct mesh m;
        assert_int_equal(read_text(&m, bad[i]), -1);
        assert_null(m.vertices);
    }
}

/* The size is looked at before anything is read. */
TEST(a_file_of_gigabytes_is_refused_at_once)
{
    struct mesh m;
    FILE *out = fopen(scratch(), "wb");
    assert_int_equal(ftruncate(fileno(out), 3LL << 30), 0);
    fclose(out);
    assert_int_equal(obj_read(&m, scratch(), OBJ_UP_Y), -1);
    unlink(scratch());
}

TEST(the_models_have_their_dimensions)
{
    struct mesh m = {0};
    struct vec low, high;
    model_slicy(&m);
    mesh_bounds(&m, &low, &high);
    assert_true(fabs(high.x - low.x - 2.445) < 1e-3 && fabs(high.y - low.y - 2.75) < 1e-3);
    assert_true(fabs(high.z - 1.689) < 1e-3 && low.z == 0);
    mesh_free(&m);
    model_tank(&m);
    mesh_bounds(&m, &low, &high);
    assert_true(fabs(high.y - low.y - 3.59) < 1e-3 && fabs(high.z - 2.23) < 1e-3 && low.z == 0);
    assert_true(fabs(high.x + 6.95 / 2 - 9.53) < 1e-3); /* muzzle to the hull's rear */
    mesh_free(&m);
}

/* How far a ray goes before it meets the scene; 100 when it does not. */
static double reach_m(const struct scene *s, struct vec from, struct vec along)
{
    struct scene_rays ray = {.count = 0};
    uint32_t facet[SCENE_PACKET];
    scene_rays_add(&ray, from, along);
    scene_meet(s, &ray, facet);
    if (facet[0] == SCENE_MISS) {
        return 100;
    }
    const struct scene_facet *f = &s->facets[facet[0]];
    return (f->offset_m - vec_dot(f->normal, from)) / vec_dot(f->normal, along);
}

/* Rays from all sides meet ours where they meet the published one: all parts are in their places.
 */
TEST(slicy_is_met_where_the_published_mesh_is)
{
    char path[512];
    if (!support_data_path("slicy/SLICY1.obj", path, sizeof path)) {
        skip();
    }
    struct mesh ours = {0}, theirs;
    struct scene our_scene, their_scene;
    model_slicy(&ours);
    assert_int_equal(obj_read(&theirs, path, OBJ_UP_Y), 0);
    assert_int_equal(scene_open(&our_scene, &ours, 0, "ours"), 0);
    assert_int_equal(scene_open(&their_scene, &theirs, 0, "theirs"), 0);
    struct hs_rng rng;
    hs_rng_seed(&rng, 1);
    int met = 0, apart = 0;
    for (int i = 0; i < 20000; i++) {
        const struct vec side = {hs_rng_normal(&rng), hs_rng_normal(&rng),
                                 fabs(hs_rng_normal(&rng))};
        const struct vec aim = {2.5 * hs_rng_uniform(&rng) - 1.1, 2.8 * hs_rng_uniform(&rng) - 1.4,
                                1.7 * hs_rng_uniform(&rng)};
        const struct vec along = vec_scale(side, -1 / vec_length(side));
        const struct vec from = vec_mad(aim, along, -6);
        const double our_m = reach_m(&our_scene, from, along);
        const double their_m = reach_m(&their_scene, from, along);
        met += their_m < 100;
        apart += fabs(our_m - their_m) > 0.005;
    }
    assert_true(met > 15000);
    assert_true(apart < met / 200); /* rays along edges and facets */
    scene_close(&our_scene);
    scene_close(&their_scene);
    mesh_free(&ours);
    mesh_free(&theirs);
}
