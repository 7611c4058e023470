/* Models: bodies are closed, files are believed only as far as they make sense. */
#include "check.h"
#include "shapes.h"
#include "support.h"
#include "tracer/mesh_audit.h"
#include "tracer/mesh_zones.h"
#include "tracer/model_file.h"
#include "tracer/models.h"
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

static double area_of(const struct mesh *m, const struct mesh_triangle *t)
{
    const struct vec a = m->vertices[t->corner[0]];
    return vec_length(vec_cross(vec_sub(m->vertices[t->corner[1]], a),
                                vec_sub(m->vertices[t->corner[2]], a))) /
           2;
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

/* Corners come back in the single precision of the reader. */
TEST(a_model_that_is_written_is_read_back)
{
    struct mesh m = {0}, again;
    model_tank(&m);
    assert_int_equal(model_file_write(&m, scratch()), 0);
    assert_int_equal(model_file_read(&again, scratch(), "z"), 0);
    const struct mesh_audit a = audited(&again);
    assert_true(is_clean(&a));
    assert_int_equal(again.triangle_count, m.triangle_count);
    assert_true(fabs(volume_of(&again) / volume_of(&m) - 1) < 1e-5);
    for (uint32_t name = 0; name < m.material_count; name++) {
        double area[2] = {0, 0};
        const struct mesh *both[2] = {&m, &again};
        for (int k = 0; k < 2; k++) {
            for (uint32_t i = 0; i < both[k]->triangle_count; i++) {
                const struct mesh_triangle *t = &both[k]->triangles[i];
                if (strcmp(both[k]->materials[t->material], m.materials[name]) == 0) {
                    area[k] += area_of(both[k], t);
                }
            }
        }
        assert_true(area[0] > 0 && fabs(area[1] / area[0] - 1) < 1e-5);
    }
    mesh_free(&m);
    mesh_free(&again);
}

static void write_text(const char *path, const char *text)
{
    FILE *out = fopen(path, "wb");
    assert_non_null(out);
    fputs(text, out);
    fclose(out);
}

static int read_text(struct mesh *m, const char *text)
{
    write_text(scratch(), text);
    return model_file_read(m, scratch(), NULL);
}

TEST(a_file_is_read_as_the_format_says)
{
    struct mesh m;
    assert_int_equal(read_text(&m,
                               "# y up\r\n"
                               "mtllib x.mtl\n"
                               "v 0 0 0\nv 1 0 0 1.0\nv\t1 2e0 0\nv 0 2 -3\nvn 0 0 1\n"
                               "usemtl metal\nf 1 2 3\n"
                               "usemtl rubber\n"
                               "f -4//1 -3//1 -2//1 \n"
                               "v 0 2 0\nf 1 2 3 5\n"),
                     0);
    assert_int_equal(m.triangle_count, 4);
    assert_int_equal(m.material_count, 2);
    double area_m2[2] = {0, 0};
    for (uint32_t i = 0; i < m.triangle_count; i++) {
        const bool is_rubber = strcmp(m.materials[m.triangles[i].material], "rubber") == 0;
        assert_true(is_rubber || strcmp(m.materials[m.triangles[i].material], "metal") == 0);
        area_m2[is_rubber] += area_of(&m, &m.triangles[i]);
    }
    assert_true(fabs(area_m2[0] - 1) < 1e-6 && fabs(area_m2[1] - 3) < 1e-6);
    mesh_free(&m);
    assert_int_equal(read_text(&m, "v 0 0 0\nv 1 0 0\nv 0 2 -3\nf 1 2 3\n"), 0);
    struct vec low, high;
    mesh_bounds(&m, &low, &high);
    assert_true(high.x == 1 && high.y == 3 && high.z == 2);
    mesh_free(&m);
}

/* An L, a comb and a star, extruded in thought only: the triangles of a face have its area and
 * never turn against it. A fan from the first corner would cover more. */
TEST(concave_faces_are_filled_and_no_more)
{
    static const struct {
        const char *corners;
        int count;
        double area_m2;
    } faces[] = {
        {"0 0 0,2 0 0,2 1 0,1 1 0,1 3 0,0 3 0", 6, 4},
        {"0 0 0,4 0 0,1 1 0,0 4 0", 4, 4},
        {"0 0 0,7 0 0,7 5 0,6 5 0,6 1 0,4 1 0,4 5 0,3 5 0,3 1 0,1 1 0,1 5 0,0 5 0", 12, 19},
        {"0 0 0,4 -1 0,5 -5 0,6 -1 0,10 0 0,6 1 0,5 5 0,4 1 0", 8, 20},
    };
    for (size_t i = 0; i < sizeof faces / sizeof faces[0]; i++) {
        for (int first = 0; first < faces[i].count; first++) {
            char text[1024], *to = text;
            to += sprintf(to, "v ");
            for (const char *c = faces[i].corners; *c; c++) {
                to += sprintf(to, *c == ',' ? "\nv " : "%c", *c);
            }
            to += sprintf(to, "\nf");
            for (int k = 0; k < faces[i].count; k++) {
                to += sprintf(to, " %d", 1 + (first + k) % faces[i].count);
            }
            struct mesh m;
            assert_int_equal(read_text(&m, text), 0);
            double sum = 0;
            for (uint32_t t = 0; t < m.triangle_count; t++) {
                sum += area_of(&m, &m.triangles[t]);
            }
            assert_true(fabs(sum - faces[i].area_m2) < 1e-5);
            mesh_free(&m);
        }
    }
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
        "v 0 0 0\nv 1 0\nv 0 1 0\nv 0 2 0\nf 1 2 3\n",             /* which shifts the others */
        "v 0 0 0\nv 1 .5 0\nv 0 1 0\nv 0 2 0\nf 1 2 3\n",          /* taken for two */
        "v 0 0 0\nv 1 0 0\n v 0 1 0\nv 0 2 0\nf 1 2 3\n",          /* not seen */
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n\tf 1 3 2\n",         /* nor that */
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nusemtl a\nf 1 3 2\n", /* whose is the first? */
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n",                    /* no such vertex */
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 0\n",                    /* counted from 1 */
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 -4\n",                   /* too far back */
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2\n",                      /* a line */
        "v 0 0 0\nv 2 0 0\nv 0 2 0\nv 2 2 0\nf 1 2 3 4\n",         /* crosses itself */
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a b\nf 1 2 3\n",        /* no table has such names */
        "v 0 0 0\ncurv 0 1 1\n",                                   /* curved */
    };
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        struct mesh m;
        assert_int_equal(read_text(&m, bad[i]), -1);
        assert_null(m.vertices);
    }
}

/* A square of two metres in other formats; glTF is in metres with y up by its standard. */
TEST(other_formats_are_read_by_the_same_door)
{
    static const char ply[] =
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty "
        "float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
        "0 0 1\n2 0 1\n2 2 1\n0 2 1\n4 0 1 2 3\n";
    static const char stl[] =
        "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 1\nvertex 2 0 1\nvertex 2 2 1\n"
        "endloop\nendfacet\nfacet normal 0 0 1\nouter loop\nvertex 0 0 1\nvertex 2 2 1\n"
        "vertex 0 2 1\nendloop\nendfacet\nendsolid a\n";
    static const char *const endings[] = {"ply", "stl"}, *const texts[] = {ply, stl};
    for (int i = 0; i < 2; i++) {
        char path[300];
        struct mesh m;
        struct vec low, high;
        snprintf(path, sizeof path, "%s/tmp/model.%s", support_build_dir(), endings[i]);
        write_text(path, texts[i]);
        assert_int_equal(model_file_read(&m, path, "z"), 0);
        assert_int_equal(m.triangle_count, 2);
        assert_string_equal(m.materials[m.triangles[0].material], "metal");
        mesh_bounds(&m, &low, &high);
        assert_true(low.z == 1 && high.z == 1 && high.x == 2 && high.y == 2);
        assert_true(fabs(area_of(&m, &m.triangles[0]) - 2) < 1e-6);
        mesh_free(&m);
    }
}

/* What Assimp makes of a damaged file is its own affair: it reads in a process of its own. What
 * comes back is whole, or there is an error. */
TEST(damaged_models_give_an_error_or_a_whole_mesh)
{
    struct mesh m = {0};
    static char whole[1 << 16];
    add_box(&m);
    assert_int_equal(model_file_write(&m, scratch()), 0);
    mesh_free(&m);
    FILE *in = fopen(scratch(), "rb");
    const size_t size = fread(whole, 1, sizeof whole, in);
    fclose(in);
    struct hs_rng rng;
    hs_rng_seed(&rng, 3);
    int read = 0;
    for (int i = 0; i < 150; i++) {
        char text[sizeof whole];
        memcpy(text, whole, size);
        for (uint32_t k = 0; k <= hs_rng_below(&rng, 3); k++) {
            text[hs_rng_below(&rng, (uint32_t)size)] = hs_rng_below(&rng, 2)
                                                           ? (char)hs_rng_below(&rng, 256)
                                                           : " \n-.e0/9fvn"[hs_rng_below(&rng, 11)];
        }
        FILE *out = fopen(scratch(), "wb");
        fwrite(text, 1, hs_rng_below(&rng, 4) ? size : hs_rng_below(&rng, (uint32_t)size), out);
        fclose(out);
        read += model_file_read(&m, scratch(), NULL) == 0;
        for (uint32_t t = 0; t < m.triangle_count; t++) {
            assert_true(m.triangles[t].material < m.material_count);
            assert_true(isfinite(area_of(&m, &m.triangles[t])));
        }
        mesh_free(&m);
    }
    assert_in_range(read, 20, 140);
}

/* The size is looked at before anything is read. */
TEST(a_file_of_gigabytes_is_refused_at_once)
{
    struct mesh m;
    FILE *out = fopen(scratch(), "wb");
    assert_int_equal(ftruncate(fileno(out), 3LL << 30), 0);
    fclose(out);
    assert_int_equal(model_file_read(&m, scratch(), NULL), -1);
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
    model_find("tank-bare")->build(&m); /* no gun and no skirts: the hull alone */
    mesh_bounds(&m, &low, &high);
    assert_true(fabs(high.y - low.y - 3.49) < 1e-3 && fabs(high.z - 2.23) < 1e-3 && low.z == 0);
    assert_true(fabs(high.x - low.x - 6.95) < 1e-3);
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
    assert_int_equal(model_file_read(&theirs, path, NULL), 0);
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

/* ---- zones ---- */

static double whole_area_of(const struct mesh *m)
{
    double sum = 0;
    for (uint32_t i = 0; i < m->triangle_count; i++) {
        sum += area_of(m, &m->triangles[i]);
    }
    return sum;
}

/* The piece of low..high that x lies in, from 1. */
static int piece(double x, double low, double high, int count)
{
    const int i = (int)floor((x - low) / (high - low) * count) + 1;
    return i < 1 ? 1 : i > count ? count : i;
}

/* The middle of each triangle is where its material's digits say. */
static void assert_zones_are_named(const struct mesh *m, const struct mesh_zones *z)
{
    struct vec low, high;
    mesh_bounds(m, &low, &high);
    const double wide = fmax(-low.y, high.y);
    for (uint32_t i = 0; i < m->triangle_count; i++) {
        const struct mesh_triangle *t = &m->triangles[i];
        struct vec middle = {0, 0, 0};
        for (int k = 0; k < 3; k++) {
            middle = vec_mad(middle, m->vertices[t->corner[k]], 1.0 / 3);
        }
        const char *digits = strchr(m->materials[t->material], '.');
        char expected[8];
        snprintf(expected, sizeof expected, ".%d%d%d%s", piece(middle.x, low.x, high.x, z->along),
                 piece(fabs(middle.y), 0, wide, z->aside), piece(middle.z, low.z, high.z, z->high),
                 z->has_sides && middle.y < 0 ? "r" : "");
        assert_non_null(digits);
        assert_string_equal(digits, expected);
    }
}

TEST(zones_cut_a_model_and_lose_nothing)
{
    for (int has_sides = 0; has_sides < 2; has_sides++) {
        const struct mesh_zones zones = {4, 2, 3, has_sides};
        struct mesh whole = {0}, cut = {0};
        model_tank(&whole);
        model_tank(&cut);
        assert_int_equal(mesh_zone(&cut, &zones, "tank"), 0);
        assert_true(cut.triangle_count > whole.triangle_count);
        assert_true(fabs(whole_area_of(&cut) - whole_area_of(&whole)) < 1e-6);
        assert_true(fabs(volume_of(&cut) - volume_of(&whole)) < 1e-6);
        assert_zones_are_named(&cut, &zones);
        struct vec low, high, cut_low, cut_high;
        mesh_bounds(&whole, &low, &high);
        mesh_bounds(&cut, &cut_low, &cut_high);
        assert_true(vec_length(vec_sub(low, cut_low)) + vec_length(vec_sub(high, cut_high)) <
                    1e-12);
        mesh_free(&whole);
        mesh_free(&cut);
    }
}

/* A face that lies in a border belongs to one zone: it would be traced twice. */
TEST(a_face_in_a_border_is_there_once)
{
    const struct mesh_zones zones = {2, 2, 2, false};
    struct mesh m = {0};
    const uint32_t metal = mesh_material(&m, "metal");
    shape_box(&m, (struct vec){-1, -1, 0}, (struct vec){1, 1, 1}, metal);
    shape_box(&m, (struct vec){0, 0, 0}, (struct vec){1, 1, 0.5}, metal);
    const double area = whole_area_of(&m);
    assert_int_equal(mesh_zone(&m, &zones, "boxes"), 0);
    assert_true(fabs(whole_area_of(&m) - area) < 1e-9);
    mesh_free(&m);
}

TEST(more_zones_than_materials_fit_are_refused_and_the_model_is_as_it_was)
{
    const struct mesh_zones zones = {9, 3, 4, true};
    struct mesh m = {0};
    model_tank(&m);
    const uint32_t triangles = m.triangle_count;
    assert_int_equal(mesh_zone(&m, &zones, "tank"), -1);
    assert_int_equal(m.triangle_count, triangles);
    assert_string_equal(m.materials[0], "metal");
    mesh_free(&m);
}
