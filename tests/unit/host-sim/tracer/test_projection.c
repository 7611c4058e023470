/* What is drawn against what is cast: Embree, and a surface without gaps. */
#include "check.h"
#include "shapes.h"
#include "tracer/models.h"
#include "tracer/projection.h"

#include "hs/rng.h"

#include <math.h>
#include <stdlib.h>

enum { STRIP_ROWS = 7 };

static const double grazing_cos = 2e-4;

/* Depths and facets of all rays of a sensor, row by row. */
struct drawing {
    struct trace_axes axes;
    struct trace_sensor sensor;
    uint32_t rays, *facets;
    float *depths_m;
};

/* Draw all of it, beyond near_m[row], with `strip_rows` rows in a strip. */
static void draw(struct drawing *d, const struct scene *s, const struct trace_order *o,
                 uint32_t strip_rows, const float *near_m, bool is_mirror)
{
    struct projection p;
    d->axes = trace_axes_of(&o->look);
    d->sensor = trace_sensor_for(s, o);
    d->rays = d->sensor.columns * d->sensor.rows;
    d->facets = malloc(d->rays * sizeof *d->facets);
    d->depths_m = malloc(d->rays * sizeof *d->depths_m);
    assert_true(d->facets && d->depths_m);
    for (uint32_t i = 0; i < d->rays; i++) {
        d->facets[i] = SCENE_MISS;
        d->depths_m[i] = INFINITY;
    }
    assert_int_equal(
        projection_open(&p, s, &d->axes, &d->sensor, strip_rows, grazing_cos, is_mirror), 0);
    for (uint32_t strip = 0; strip < p.strip_count; strip++) {
        const size_t at = (size_t)strip * strip_rows * d->sensor.columns;
        projection_draw(&p, strip, near_m + strip * strip_rows, d->depths_m + at, d->facets + at);
    }
    projection_close(&p);
}

static void drop(struct drawing *d)
{
    free(d->facets);
    free(d->depths_m);
}

static struct vec place_of(const struct drawing *d, uint32_t ray)
{
    const struct trace_sensor *s = &d->sensor;
    const double across_m = s->low_across_m + (ray % s->columns + 0.5) * s->step_across_m;
    const double up_m = s->low_up_m + (ray / s->columns + 0.5) * s->step_up_m;
    return vec_mad(vec_scale(d->axes.across, across_m), d->axes.rise, up_m);
}

/* How far along a ray its facet lies; 1000 for none. */
static double way_to(const struct scene *s, uint32_t facet, struct vec from, struct vec along)
{
    if (facet == SCENE_MISS) {
        return 1000;
    }
    const struct scene_facet *f = &s->facets[facet];
    return (f->offset_m - vec_dot(f->normal, from)) / vec_dot(f->normal, along);
}

static uint32_t cast(const struct scene *s, struct vec from, struct vec along)
{
    struct scene_rays rays = {.count = 0};
    uint32_t facets[SCENE_PACKET];
    scene_rays_add(&rays, from, along);
    scene_meet(s, &rays, facets);
    return facets[0];
}

/* Of rays that pass an edge within single precision either answer is right: one in some thousands.
 * Of facets in one plane, too. */
static void assert_few(uint32_t apart, uint32_t met, const char *what)
{
    print_message("# %s: %u of %u rays meet something else\n", what, apart, met);
    assert_true(met > 200 && apart < 2 + met / 2000);
}

static float *all_rows(const struct scene *s, const struct trace_order *o)
{
    const uint32_t rows = trace_sensor_for(s, o).rows;
    float *near_m = malloc(rows * sizeof *near_m);
    assert_non_null(near_m);
    for (uint32_t row = 0; row < rows; row++) {
        near_m[row] = -INFINITY;
    }
    return near_m;
}

static void compare_with_cast_rays(const struct scene *s, const struct trace_order *o)
{
    struct drawing d;
    uint32_t met = 0, apart = 0;
    float *near_m = all_rows(s, o);
    draw(&d, s, o, STRIP_ROWS, near_m, false);
    for (uint32_t i = 0; i < d.rays; i++) {
        const struct vec from = vec_mad(place_of(&d, i), d.axes.sight, -20);
        const uint32_t facet = cast(s, from, d.axes.sight);
        const double way_m = way_to(s, facet, from, d.axes.sight);
        const double drawn_m = way_to(s, d.facets[i], from, d.axes.sight);
        met += facet != SCENE_MISS;
        apart += fabs(way_m - drawn_m) > 1e-4;
        if (d.facets[i] != SCENE_MISS) {
            assert_true(fabs((double)d.depths_m[i] + 20 - drawn_m) < 1e-5);
        }
    }
    assert_few(apart, met, "primary");
    drop(&d);
    free(near_m);
}

/* Rays start on the ground, where the primary ray meets it. */
static void compare_with_reflected_rays(const struct scene *s, const struct trace_order *o)
{
    struct drawing d;
    uint32_t met = 0, apart = 0;
    float *near_m = all_rows(s, o);
    const struct trace_axes axes = trace_axes_of(&o->look);
    const struct trace_sensor sensor = trace_sensor_for(s, o);
    for (uint32_t row = 0; row < sensor.rows; row++) {
        const double up_m = sensor.low_up_m + (row + 0.5) * sensor.step_up_m;
        near_m[row] = (float)(-up_m * axes.rise.z / axes.sight.z + 1e-4);
    }
    draw(&d, s, o, STRIP_ROWS, near_m, true);
    const struct vec along = {axes.sight.x, axes.sight.y, -axes.sight.z};
    for (uint32_t i = 0; i < d.rays; i++) {
        const struct vec place = place_of(&d, i);
        struct vec from = vec_mad(place, axes.sight, -place.z / axes.sight.z);
        from.z = 1e-6;
        const uint32_t facet = cast(s, from, along);
        met += facet != SCENE_MISS;
        apart += fabs(way_to(s, facet, from, along) - way_to(s, d.facets[i], from, along)) > 1e-4;
    }
    assert_few(apart, met, "after the ground");
    drop(&d);
    free(near_m);
}

static void compare_model(void (*build)(struct mesh *m))
{
    static const double looks[][2] = {{20, 15}, {1, 30}, {133, 45}, {268, 5}};
    for (size_t i = 0; i < sizeof looks / sizeof looks[0]; i++) {
        struct mesh m = {0};
        struct scene s;
        build(&m);
        assert_int_equal(scene_open(&s, &m, 0, "test"), 0);
        struct trace_order o = {.look = {looks[i][0], looks[i][1], TRACE_WAVELENGTH_M},
                                .grid = {110, 60, 0.1},
                                .rays_per_cell = 2};
        compare_with_cast_rays(&s, &o);
        compare_with_reflected_rays(&s, &o);
        scene_close(&s);
        mesh_free(&m);
    }
}

TEST(what_is_drawn_of_slicy_is_what_cast_rays_meet)
{
    compare_model(model_slicy);
}

TEST(what_is_drawn_of_a_tank_is_what_cast_rays_meet)
{
    compare_model(model_tank);
}

/* Rough ground of triangles that share their sides, wider than the sensor, some corners and sides
 * of which lie exactly on rays: each ray meets one. */
TEST(no_ray_slips_between_triangles_that_share_a_side)
{
    enum { SIDE = 40 };
    struct hs_rng rng;
    hs_rng_seed(&rng, 1);
    for (double azimuth_deg = 0; azimuth_deg < 360; azimuth_deg += 45) {
        struct mesh m = {0};
        struct scene s;
        const uint32_t material = mesh_material(&m, "metal");
        for (int i = 0; i <= SIDE * (SIDE + 1) + SIDE; i++) {
            const double x = 0.25 * (i % (SIDE + 1)) - 5, y = 0.25 * (i / (SIDE + 1)) - 5;
            mesh_add_vertex(&m, (struct vec){x, y, i % 3 ? 0 : 0.1 * hs_rng_uniform(&rng)});
        }
        for (uint32_t i = 0; i < SIDE * SIDE; i++) {
            const uint32_t a = i / SIDE * (SIDE + 1) + i % SIDE, b = a + SIDE + 1;
            mesh_add_triangle(&m, a, a + 1, b + 1, material);
            mesh_add_triangle(&m, a, b + 1, b, material);
        }
        assert_int_equal(scene_open(&s, &m, 0, "test"), 0);
        const struct trace_order o = {.look = {azimuth_deg, 45, TRACE_WAVELENGTH_M},
                                      .grid = {51, 41, 0.125},
                                      .rays_per_cell = 1};
        struct drawing d;
        float *near_m = all_rows(&s, &o);
        draw(&d, &s, &o, 3, near_m, false);
        for (uint32_t i = 0; i < d.rays; i++) {
            assert_true(d.facets[i] < s.triangle_count);
        }
        drop(&d);
        free(near_m);
        scene_close(&s);
        mesh_free(&m);
    }
}

TEST(strips_of_any_height_give_the_same_drawing)
{
    struct mesh m = {0};
    struct scene s;
    model_tank(&m);
    assert_int_equal(scene_open(&s, &m, 0, "test"), 0);
    const struct trace_order o = {
        .look = {77, 15, TRACE_WAVELENGTH_M}, .grid = {90, 90, 0.1}, .rays_per_cell = 1};
    float *near_m = all_rows(&s, &o);
    struct drawing one, other;
    draw(&one, &s, &o, 1, near_m, false);
    draw(&other, &s, &o, trace_sensor_for(&s, &o).rows + 5, near_m, false);
    assert_memory_equal(one.facets, other.facets, one.rays * sizeof *one.facets);
    assert_memory_equal(one.depths_m, other.depths_m, one.rays * sizeof *one.depths_m);
    drop(&one);
    drop(&other);
    free(near_m);
    scene_close(&s);
    mesh_free(&m);
}
