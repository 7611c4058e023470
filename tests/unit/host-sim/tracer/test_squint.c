/* Squint, against the places of small things by vector algebra. */
#include "check.h"
#include "shapes.h"
#include "tracer/squint.h"
#include "tracer/trace.h"

#include <math.h>

static struct trace_records traced(struct mesh *m, double depression_deg, double ground_half_m)
{
    const struct trace_order o = {.look = {0, depression_deg, TRACE_WAVELENGTH_M},
                                  .grid = {128, 128, 0.05},
                                  .rays_per_cell = 8,
                                  .bounces = 2,
                                  .threads = 2};
    struct scene s;
    struct trace_records r;
    assert_int_equal(scene_open(&s, m, ground_half_m, "test"), 0);
    assert_int_equal(trace_run(&s, &o, "test", &r, NULL), 0);
    scene_close(&s);
    mesh_free(m);
    return r;
}

/* The direction along which a radar's place among the directions to it changes: from two places of
 * the flight, far away, by the difference of their ways to p. Half the way's change, over the angle
 * that it turned, is the cross-range of p. */
static double cross_range_by_flying(struct vec p, double squint_deg, double depression_deg)
{
    const double sigma = squint_deg * 3.14159265358979323846 / 180;
    const double psi = depression_deg * 3.14159265358979323846 / 180;
    const double far_m = 1e6, step_m = 1e3;
    const struct vec at = {0, -far_m * cos(psi), far_m * sin(psi)};
    const struct vec flight = {cos(sigma), sin(sigma), 0};
    double way_m[2], turned[2][3];
    for (int i = 0; i < 2; i++) {
        const struct vec radar = vec_mad(at, flight, i ? step_m : -step_m);
        /* Against the scene's centre, as a focused picture has it. */
        way_m[i] = vec_length(vec_sub(p, radar)) - vec_length(radar);
        const struct vec sight = vec_scale(radar, -1 / vec_length(radar));
        turned[i][0] = sight.x;
        turned[i][1] = sight.y;
        turned[i][2] = sight.z;
    }
    const double angle =
        sqrt(pow(turned[1][0] - turned[0][0], 2) + pow(turned[1][1] - turned[0][1], 2) +
             pow(turned[1][2] - turned[0][2], 2));
    return -(way_m[1] - way_m[0]) / angle;
}

TEST(a_small_thing_lies_where_flying_past_it_says)
{
    static const struct vec places[] = {{0, 0, 0}, {1, 0.5, 0.2}, {-0.7, -0.3, 1.1}};
    static const double squints[] = {0, 20, -35, 50};
    for (int k = 0; k < 3; k++) {
        for (int i = 0; i < 4; i++) {
            /* From ahead: across is the model's left, away is behind it. */
            const struct vec p = places[k], model = {-p.y, p.x, p.z};
            struct mesh m = {0};
            const struct vec half = {0.01, 0.01, 0.01};
            shape_box(&m, vec_sub(model, half), vec_add(model, half), mesh_material(&m, "metal"));
            struct trace_records r = traced(&m, 30, 0);
            squint_records(&r, squints[i]);
            assert_true(r.bounces[0].count > 3);
            const double expected = cross_range_by_flying(p, squints[i], 30);
            for (uint32_t n = 0; n < r.bounces[0].count; n++) {
                assert_true(fabs((double)r.bounces[0].records[n].across_m - expected) < 0.02);
            }
            trace_records_free(&r);
        }
    }
}

/* A wall on level ground: by way of the ground it lies at its foot, with squint too. */
TEST(a_seam_lies_at_its_place)
{
    struct mesh m = {0};
    shape_box(&m, (struct vec){-0.1, -0.01, 0}, (struct vec){0.1, 0.01, 1},
              mesh_material(&m, "metal"));
    struct trace_records r = traced(&m, 30, 10);
    squint_records(&r, 40);
    const double expected = cross_range_by_flying((struct vec){0, -0.1, 0}, 40, 30);
    assert_true(r.bounces[1].count > 20);
    for (uint32_t i = 0; i < r.bounces[1].count; i++) {
        assert_true(fabs((double)r.bounces[1].records[i].across_m - expected) < 0.011);
    }
    trace_records_free(&r);
}
