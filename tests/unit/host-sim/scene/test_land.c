/* The invented country obeys the laws that real country obeys: water runs down, lakes lie level,
 * and slopes follow the law that the erosion claims to solve. */
#include "check.h"
#include "erosion.h"
#include "noise.h"
#include "scene/land.h"
#include "scene/shape.h"

#include <math.h>
#include <stdlib.h>

/* cmocka compares single precision only. */
static void assert_near(double is, double wanted, double tolerance)
{
    assert_true(fabs(is - wanted) <= tolerance);
}

static int make_land(void **state)
{
    struct land *l = malloc(sizeof *l);
    *state = l;
    return land_make(l, 5, LAND_DESIGN_M);
}

static int free_land(void **state)
{
    land_free(*state);
    free(*state);
    return 0;
}

/* Sampled every 10 m, the ground under the river falls from the hills to the sea. 5 cm are allowed,
 * because in a bend the posts on the two banks belong to different stretches. */
TEST(the_river_runs_downhill_all_the_way)
{
    const struct land *l = *state;
    double last = 0, top = 0;
    for (int i = 0; i + 1 < l->river_count; i++) {
        double east, north;
        land_from_design(l->river[i], &east, &north);
        if (fmax(fabs(east), fabs(north)) > LAND_DESIGN_M / 2) {
            continue;
        }
        for (int k = 0; k < 4; k++) {
            const struct point p = point_between(l->river[i], l->river[i + 1], k / 4.0);
            const double h = land_at(l, l->height_m, p);
            assert_true(h >= last - 0.05);
            last = fmax(last, h);
            top = fmax(top, h);
        }
    }
    assert_true(top > 15);
    assert_true(land_at(l, l->height_m, l->river[0]) < 0.5);
}

/* Nothing within 300 m of the river lies below its surface there, but for the 10 cm that posts 25 m
 * apart take from a bend of the upper river, whose surface falls 2 cm a metre. */
TEST(the_river_lies_lowest_in_its_valley)
{
    const struct land *l = *state;
    for (int i = 1; i + 1 < l->river_count; i += 3) {
        const struct point a = l->river[i - 1], b = l->river[i + 1];
        const double length = point_distance(a, b);
        const struct frame f = {l->river[i], (b.u - a.u) / length, (b.v - a.v) / length};
        double east, north;
        land_from_design(f.origin, &east, &north);
        if (fmax(fabs(east), fabs(north)) > LAND_DESIGN_M / 2 - 400) {
            continue;
        }
        for (double y = -300; y <= 300; y += 20) {
            const struct point p = frame_point(&f, 0, y);
            double along = 0;
            line_distance(l->river, l->river_count, p, &along);
            if (land_at(l, l->shore_m, p) > 60) {
                assert_true(land_at(l, l->height_m, p) >= land_river_level(along) - 0.1);
            }
        }
    }
}

TEST(the_lake_is_level_and_no_shore_lies_below_it)
{
    const struct land *l = *state;
    int water = 0, island = 0;
    for (int i = 0; i < l->posts * l->posts; i++) {
        if (l->lake_m[i] > 0) {
            assert_near(l->height_m[i], l->lake_level_m, 1e-4);
            water++;
        } else if (l->lake_m[i] > -50) {
            assert_true(l->height_m[i] >= l->lake_level_m);
            island++;
        }
    }
    const double hectares = water * l->spacing_m * l->spacing_m / 1e4;
    assert_true(hectares > 60 && hectares < 600);
    assert_true(island > 0);
}

TEST(the_sea_is_at_zero_and_all_land_above)
{
    const struct land *l = *state;
    for (int i = 0; i < l->posts * l->posts; i++) {
        if (l->shore_m[i] <= 0) {
            assert_true(l->height_m[i] == 0);
        } else {
            assert_true(l->height_m[i] >= 0);
        }
    }
}

TEST(the_runway_is_level)
{
    const struct land *l = *state;
    const struct frame f = land_airfield();
    for (double x = -1100; x <= 1100; x += 50) {
        assert_near(land_at(l, l->height_m, frame_point(&f, x, 0)), l->airfield_level_m, 0.01);
    }
}

TEST(the_hills_rise_several_hundred_metres)
{
    const struct land *l = *state;
    float top = 0;
    for (int i = 0; i < l->posts * l->posts; i++) {
        top = fmaxf(top, l->height_m[i]);
    }
    assert_true(top > 400 && top < 1000);
}

static int start_hills(struct erosion *e)
{
    if (erosion_init(e, 60, 60, 50) != 0) {
        return -1;
    }
    for (int i = 0; i < 60 * 60; i++) {
        e->is_base[i] = i % 60 == 0;
        e->steepness[i] = 20;
        e->z_m[i] = e->is_base[i] ? 0 : 1 + noise_at(3, i, 0);
    }
    return 0;
}

/* In the steady state uplift equals erosion, U = K sqrt(A) S, wherever the slope is not held by the
 * talus: the slope times the root of the drained area is U / K. */
TEST(slopes_settle_to_the_stream_power_law)
{
    struct erosion e;
    assert_int_equal(start_hills(&e), 0);
    erosion_run(&e, 3000, 0.25, 10);
    int checked = 0;
    for (int i = 0; i < 60 * 60; i++) {
        const int r = e.receiver[i];
        if (e.is_base[i]) {
            continue;
        }
        const double dx = (i % 60 - r % 60) * 50.0, dy = (i / 60 - r / 60) * 50.0;
        const double slope = (e.z_m[i] - e.z_m[r]) / hypot(dx, dy);
        assert_near(slope * sqrt(e.area_m2[i]), 20, 0.2);
        checked++;
    }
    assert_int_equal(checked, 60 * 59);
    erosion_free(&e);
}

TEST(every_place_drains_to_a_base_and_no_water_is_lost)
{
    struct erosion e;
    assert_int_equal(start_hills(&e), 0);
    erosion_run(&e, 200, 0.25, 0.7);
    double at_bases = 0;
    for (int i = 0; i < 60 * 60; i++) {
        int node = i, steps = 0;
        while (e.receiver[node] != node && steps++ < 3600) {
            assert_true(e.z_m[e.receiver[node]] < e.z_m[node]);
            node = e.receiver[node];
        }
        assert_true(e.is_base[node]);
        at_bases += e.is_base[i] ? e.area_m2[i] : 0;
    }
    assert_near(at_bases, 60 * 60 * 2500.0, 1);
    erosion_free(&e);
}

TEST(cutting_land_loses_none_of_it)
{
    struct hs_rng r;
    hs_rng_seed(&r, 11);
    const struct frame f = frame_at((struct point){300, -200}, 31);
    struct shape s = frame_rectangle(&f, -400, -150, 400, 150);
    assert_near(shape_area(&s), 800 * 300, 1e-6);
    for (int i = 0; i < 6; i++) {
        struct shape half[2];
        shape_split(&s, &r, 0, 0.2, 8, half);
        assert_near(shape_area(&half[0]) + shape_area(&half[1]), shape_area(&s), 1e-6);
        assert_true(shape_area(&half[0]) > 0.1 * shape_area(&s));
        s = half[i % 2];
    }
    const struct shape field = frame_rectangle(&f, 0, 0, 100, 60), inner = shape_inset(&field, 10);
    assert_near(shape_area(&inner), 80 * 40, 1e-6);
}

TEST_GROUP(make_land, free_land);
