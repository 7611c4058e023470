/* Where echoes come from: places, heights and parts, against models of known places. */
#include "check.h"
#include "shapes.h"
#include "tracer/echo_map.h"
#include "tracer/models.h"
#include "tracer/trace.h"

#include <math.h>
#include <string.h>

struct look {
    struct mesh mesh;
    struct scene scene;
    struct trace_records records;
    struct reflect_law law;
};

/* Trace a mesh from ahead, turned by `azimuth_deg`; every material reflects half either way. */
static struct look looked_at(struct mesh m, double azimuth_deg, double depression_deg,
                             double ground_half_m)
{
    struct look l = {.mesh = m,
                     .law = {.kind = REFLECT_RAYSAR, .wavelength_m = TRACE_WAVELENGTH_M}};
    const struct trace_order o = {.look = {azimuth_deg, depression_deg, TRACE_WAVELENGTH_M},
                                  .grid = {128, 128, 0.1},
                                  .rays_per_cell = 2,
                                  .bounces = TRACE_BOUNCES_MAX,
                                  .threads = 2};
    for (int i = 0; i < TRACE_MATERIALS_MAX; i++) {
        l.law.materials[i] =
            (struct reflect_material){.specular = 0.5, .roughness = 1, .diffuse = 0.5};
    }
    assert_int_equal(scene_open(&l.scene, &l.mesh, ground_half_m, "test"), 0);
    assert_int_equal(trace_run(&l.scene, &o, "test", &l.records, NULL), 0);
    return l;
}

static void close_look(struct look *l)
{
    trace_records_free(&l->records);
    scene_close(&l->scene);
    mesh_free(&l->mesh);
}

static struct vec in_model(const struct trace_look *look, struct vec v)
{
    const struct trace_axes a = trace_axes_of(look);
    return vec_add(vec_add(vec_scale(a.across, v.x), vec_scale(a.away, v.y)),
                   (struct vec){0, 0, v.z});
}

/* Is a place on some facet of the model or on the ground? */
static bool is_on_model(const struct scene *s, struct vec p)
{
    for (uint32_t i = 0; i < s->facet_count; i++) {
        if (fabs(vec_dot(s->facets[i].normal, p) - s->facets[i].offset_m) < 1e-4) {
            return true;
        }
    }
    return false;
}

/* Followed again from what was recorded, a ray is where the model is, at each of its reflections;
 * and the echo of the last is to the right, and as far, as was recorded. */
TEST(every_reflection_of_the_tank_lies_on_the_tank)
{
    struct mesh m = {0};
    model_tank(&m);
    struct look l = looked_at(m, 40, 15, 20);
    const double psi = 15 * 3.14159265358979323846 / 180;
    uint32_t seen = 0;
    for (uint32_t b = 0; b < l.records.bounce_count; b++) {
        for (uint32_t i = 0; i < l.records.bounces[b].count; i += 37) {
            const struct trace_record *t = &l.records.bounces[b].records[i];
            const struct origin o = origin_of(&l.records, b, t);
            const struct vec last = o.places[b], first = o.places[0];
            assert_int_equal(o.count, b + 1);
            assert_true(is_on_model(&l.scene, in_model(&l.records.look, last)));
            assert_true(fabs((first.x + last.x) / 2 - (double)t->across_m) < 1e-4);
            double way_m = first.y * cos(psi) - first.z * sin(psi);
            for (uint32_t k = 1; k <= b; k++) {
                way_m += vec_length(vec_sub(o.places[k], o.places[k - 1]));
            }
            way_m += last.y * cos(psi) - last.z * sin(psi);
            assert_true(fabs(way_m / 2 - (double)t->range_m) < 1e-4);
            seen++;
        }
    }
    assert_true(seen > 1000);
    close_look(&l);
}

/* A mast and its image in the ground: by way of the ground it seems to stand at its own foot. */
TEST(heights_are_those_of_the_place_or_of_the_seam)
{
    struct mesh m = {0};
    shape_box(&m, (struct vec){-0.1, -0.5, 0}, (struct vec){0.1, 0.5, 3},
              mesh_material(&m, "metal"));
    struct look l = looked_at(m, 0, 30, 20);
    uint32_t once = 0, twice = 0;
    for (uint32_t b = 0; b < 2; b++) {
        for (uint32_t i = 0; i < l.records.bounces[b].count; i++) {
            const struct trace_record *t = &l.records.bounces[b].records[i];
            const struct origin o = origin_of(&l.records, b, t);
            const bool is_wall = fabsf(t->normal[1] + 1) < 1e-5F;
            if (b == 0) {
                assert_true(fabs(o.height_m - o.places[0].z) < 1e-5);
                once += is_wall && o.height_m > 2.9;
            } else {
                assert_true(fabs(o.height_m) < 1e-4); /* the seam of wall and ground */
                twice++;
            }
        }
    }
    assert_true(once > 5 && twice > 100);
    close_look(&l);
}

/* Two boxes beside each other: each makes the cells at its own place, and the map's power is that
 * of all echoes in the grid. */
TEST(cells_know_their_part)
{
    struct mesh m = {0};
    const uint32_t metal = mesh_material(&m, "metal");
    shape_box(&m, (struct vec){-0.5, 1, 0.02}, (struct vec){0.5, 2, 1}, metal);
    shape_box(&m, (struct vec){-0.5, -2, 0.02}, (struct vec){0.5, -1, 1}, metal);
    struct look l = looked_at(m, 0, 45, 0);
    struct echo_map map;
    assert_int_equal(echo_map_make(&map, &l.records, &l.law, &l.scene, &l.mesh), 0);
    assert_int_equal(map.part_count, 2);
    int of[2] = {0, 0};
    for (int i = 0; i < 128 * 128; i++) {
        const struct echo_cell *c = &map.cells[i];
        if (c->reflections == 0) {
            assert_true(isnan(c->height_m) && c->power_m2 == 0);
            continue;
        }
        const int32_t part = c->parts[c->reflections - 1];
        assert_in_range(part, 0, 1);
        assert_int_equal(part, map.part_of[c->facets[c->reflections - 1]]);
        if (c->reflections == 1) {
            /* Seen from ahead, what is to the model's left is on the right. */
            assert_int_equal(part, i % 128 >= 64 ? 0 : 1);
            assert_true(c->height_m > 0 && c->height_m < 1.01 && c->height_spread_m < 0.75);
            of[part]++;
        }
    }
    assert_true(of[0] > 50 && of[1] > 50);
    echo_map_free(&map);
    close_look(&l);
}

/* Layover: the top of a mast lies before its foot, and only the heights tell it from the ground
 * there. */
TEST(layover_is_told_by_the_height)
{
    struct mesh m = {0};
    shape_box(&m, (struct vec){-0.2, -0.2, 0}, (struct vec){0.2, 0.2, 4},
              mesh_material(&m, "metal"));
    struct look l = looked_at(m, 0, 30, 20);
    struct echo_map map;
    assert_int_equal(echo_map_make(&map, &l.records, &l.law, &l.scene, &l.mesh), 0);
    /* The top's range is that of the foot less 4 m sin 30: 20 cells nearer, and its front 2 more.
     */
    const struct echo_cell *top = &map.cells[(64 - 21) * 128 + 64], *ground = top - 20;
    assert_int_equal(ground->parts[0], ECHO_MAP_GROUND);
    assert_true(fabs(ground->height_m) < 1e-4);
    assert_true(top->height_m > 1 && top->height_spread_m > 1);
    assert_int_equal(top->parts[0], 0);
    echo_map_free(&map);
    close_look(&l);
}
