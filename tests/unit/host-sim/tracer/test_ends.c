/* Transmitter and receiver near or apart, against geometry that uses nothing of the tracer: places
 * of the two ends by trigonometry, ways by subtraction. */
#include "check.h"
#include "shapes.h"
#include "tracer/accumulate.h"
#include "tracer/coherent.h"
#include "tracer/ends.h"
#include "tracer/origin.h"
#include "tracer/trace.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double pi = 3.14159265358979323846;
static const double lambda = TRACE_WAVELENGTH_M;

/* The radar is ahead (azimuth 0), at 30 degrees. */
static struct trace_order order_of(struct trace_ends ends, double cell_m, uint32_t rays)
{
    return (struct trace_order){.look = {0, 30, lambda},
                                .grid = {64, 64, cell_m},
                                .rays_per_cell = rays,
                                .bounces = 3,
                                .threads = 2,
                                .ends = ends};
}

static struct trace_records traced_on(struct mesh *m, const struct trace_order *o, bool has_ground)
{
    struct scene s;
    struct trace_records r;
    assert_int_equal(scene_open(&s, m, has_ground ? ends_ground_half_m(o) : 0, "test"), 0);
    assert_int_equal(trace_run(&s, o, "test", &r, NULL), 0);
    assert_int_equal(trace_records_check(&r, "test"), 0);
    scene_close(&s);
    mesh_free(m);
    return r;
}

static struct trace_records traced(struct mesh *m, struct trace_ends ends, double cell_m,
                                   uint32_t rays)
{
    const struct trace_order o = order_of(ends, cell_m, rays);
    return traced_on(m, &o, false);
}

static void assert_near(double found, double expected, double most)
{
    if (!(fabs(found - expected) <= most)) {
        print_error("%.9g is not within %g of %.9g\n", found, most, expected);
        fail();
    }
}

/* In the model's axes; far ends stand 1e9 m away. */
static struct vec place_of_end(double azimuth_deg, double depression_deg, double distance_m)
{
    const double a = azimuth_deg * pi / 180, d = depression_deg * pi / 180;
    const double r = distance_m > 0 ? distance_m : 1e9;
    return (struct vec){r * cos(d) * cos(a), -r * cos(d) * sin(a), r * sin(d)};
}

static struct vec transmitter(const struct trace_ends *e)
{
    return place_of_end(0, 30, e->distance_m);
}

static struct vec receiver(const struct trace_ends *e)
{
    return e->is_apart ? place_of_end(e->receiver_azimuth_deg, e->receiver_depression_deg,
                                      e->receiver_distance_m)
                       : transmitter(e);
}

/* |p - end| - |end|, in long double: the far ends need it. */
static double further_m(struct vec p, struct vec end)
{
    const long double x = p.x - (long double)end.x, y = p.y - (long double)end.y,
                      z = p.z - (long double)end.z;
    const long double own =
        sqrtl((long double)end.x * end.x + (long double)end.y * end.y + (long double)end.z * end.z);
    return (double)(sqrtl(x * x + y * y + z * z) - own);
}

/* How the way to an end changes when it flies level to its right, times its distance. */
static double across_m(struct vec p, struct vec end)
{
    const double level = hypot(end.x, end.y), step_m = vec_length(end) * 1e-6;
    const struct vec right = {-end.y / level * step_m, end.x / level * step_m, 0};
    const double gained_m = further_m(p, vec_sub(end, right)) - further_m(p, vec_add(end, right));
    return gained_m / 2e-6;
}

static const struct trace_ends all_ends[] = {
    {20, false, 0, 0, 0},    {0, true, 40, 30, 0},    {0, true, 300, 55, 0},
    {25, true, 310, 30, 25}, {15, true, 60, 20, 300}, {0, true, 90, 45, 12},
};
enum { ENDS = sizeof all_ends / sizeof all_ends[0] };

TEST(a_small_thing_lies_where_the_ways_to_both_ends_say)
{
    static const struct vec places[] = {{0, 0, 0}, {1.1, -0.6, 0.3}, {-0.8, 1.2, 0.9}};
    for (int k = 0; k < ENDS; k++) {
        const struct vec t = transmitter(&all_ends[k]), b = receiver(&all_ends[k]);
        for (int i = 0; i < 3; i++) {
            const struct vec p = places[i], half = {0.006, 0.006, 0.006};
            struct mesh m = {0};
            shape_box(&m, vec_sub(p, half), vec_add(p, half), mesh_material(&m, "metal"));
            struct trace_records r = traced(&m, all_ends[k], 0.03, 3);
            assert_true(r.bounces[0].count > 1);
            const double range_m = (further_m(p, t) + further_m(p, b)) / 2;
            const double aside_m = (across_m(p, t) + across_m(p, b)) / 2;
            for (uint32_t n = 0; n < r.bounces[0].count; n++) {
                const struct trace_record *e = &r.bounces[0].records[n];
                assert_near((double)e->range_m, range_m, 0.012);
                assert_near((double)e->across_m, aside_m, 0.012);
                assert_near(
                    remainder((double)e->phase_rad + 4 * pi / lambda * (double)e->range_m, 2 * pi),
                    0, 1e-3);
            }
            trace_records_free(&r);
        }
    }
}

/* Ends of one height h, 2 c apart: their ellipsoid cuts the ground in an ellipse of semi-axes a k
 * and b k, b^2 = a^2 - c^2, k^2 = 1 - h^2 / b^2. All of it has one range. */
TEST(places_of_one_range_lie_on_an_ellipse)
{
    const struct trace_ends ends = {20, true, 80, 30, 20};
    const struct vec t = transmitter(&ends), v = receiver(&ends);
    const struct vec middle = vec_scale(vec_add(t, v), 0.5), between = vec_sub(v, t);
    const double c = vec_length(between) / 2, a = 20, b = sqrt(a * a - c * c), h = t.z;
    const double k = sqrt(1 - h * h / b / b);
    const struct vec along = vec_scale(between, 1 / (2 * c)), away = {along.y, -along.x, 0};
    const double side = vec_dot(middle, away) > 0 ? -1 : 1;
    struct mesh m = {0};
    for (int i = -3; i <= 3; i++) {
        const double x = 0.4 * i, y = side * b * k * sqrt(1 - x * x / (a * a * k * k));
        const struct vec p =
            vec_mad(vec_mad((struct vec){middle.x, middle.y, 0}, along, x), away, y);
        const struct vec half = {0.006, 0.006, 0.006};
        assert_true(vec_length(p) < 1.6); /* the centre is on it */
        shape_box(&m, vec_sub(p, half), vec_add(p, half), mesh_material(&m, "metal"));
    }
    struct trace_records r = traced(&m, ends, 0.03, 3);
    double left_m = 0, right_m = 0;
    assert_true(r.bounces[0].count > 14);
    for (uint32_t i = 0; i < r.bounces[0].count; i++) {
        const struct trace_record *e = &r.bounces[0].records[i];
        assert_near((double)e->range_m, 0, 0.012);
        left_m = fmin(left_m, (double)e->across_m);
        right_m = fmax(right_m, (double)e->across_m);
    }
    assert_true(left_m < -0.8 && right_m > 0.8);
    trace_records_free(&r);
}

/* Three mirrors make of a transmitter at T one at 2 apex - T. After the third reflection at X the
 * way is |X - that|, and on to the receiver |X - R|. */
TEST(a_trihedral_echoes_as_the_transmitter_in_its_three_mirrors)
{
    for (int k = 0; k < ENDS; k++) {
        const double s = 0.5;
        const struct vec apex = {-0.3, 0.2, 0.1}, ahead = {s, s, 0}, aside = {s, -s, 0};
        const struct vec up = {0, 0, s};
        struct mesh m = {0};
        const uint32_t metal = mesh_material(&m, "metal");
        shape_plate(&m, apex, aside, ahead, metal);
        shape_plate(&m, apex, up, ahead, metal);
        shape_plate(&m, apex, aside, up, metal);
        struct trace_records r = traced(&m, all_ends[k], 0.06, 3);
        const struct vec t = transmitter(&all_ends[k]), b = receiver(&all_ends[k]);
        const struct vec image = vec_mad(vec_scale(apex, 2), t, -1);
        assert_true(r.bounces[2].count > 100);
        for (uint32_t i = 0; i < r.bounces[2].count; i++) {
            const struct trace_record *e = &r.bounces[2].records[i];
            const struct vec p = origin_of(&r, 2, e).places[2], x = {-p.y, p.x, p.z};
            /* The image's own distance differs from T's. */
            const double range_m = (further_m(x, image) + further_m(image, (struct vec){0, 0, 0}) -
                                    further_m(t, (struct vec){0, 0, 0}) + further_m(x, b)) /
                                   2;
            if (all_ends[k].distance_m > 0) {
                assert_near((double)e->range_m, range_m, 1e-4);
            } else {
                /* Plane waves: back along the line of sight as far as they came. */
                const struct vec sight = vec_scale(t, -1e-9);
                const double way_m = 2 * vec_dot(apex, sight) - vec_dot(x, sight);
                assert_near((double)e->range_m, (way_m + further_m(x, b)) / 2, 1e-4);
            }
        }
        trace_records_free(&r);
    }
}

/* ---- shadows ---- */

/* Records of the ground near (x, y): seen by the receiver, and lit alone. */
struct seen {
    uint32_t lit, dark;
};

static struct seen ground_near(const struct trace_records *r, double x, double y)
{
    struct seen seen = {0, 0};
    for (uint32_t i = 0; i < r->bounces[0].count; i++) {
        const struct trace_record *e = &r->bounces[0].records[i];
        const struct vec p = origin_of(r, 0, e).places[0];
        if (fabs(p.z) < 1e-6 && hypot(-p.y - x, p.x - y) < 0.05) {
            seen.lit += !(e->flags & TRACE_BLOCKED);
            seen.dark += (e->flags & TRACE_BLOCKED) != 0;
        }
    }
    return seen;
}

/* From an end at height H above a place of the ground, a mast of height h at distance d from that
 * place throws a shadow of d h / (H - h), straight away from the place. */
TEST(a_mast_throws_the_shadows_of_near_ends)
{
    const struct trace_ends ends[] = {{8, false, 0, 0, 0}, {12, true, 70, 40, 13}};
    const struct vec foot = {0.5, 0.4, 0};
    const double height_m = 0.5;
    for (int k = 0; k < 2; k++) {
        struct mesh m = {0};
        shape_box(&m, (struct vec){foot.x - 0.05, foot.y - 0.05, 0},
                  (struct vec){foot.x + 0.05, foot.y + 0.05, height_m}, mesh_material(&m, "metal"));
        const struct trace_order o = order_of(ends[k], 0.06, 2);
        struct trace_records r = traced_on(&m, &o, true);
        const struct vec stands[2] = {transmitter(&ends[k]), receiver(&ends[k])};
        for (int e = 0; e <= (ends[k].is_apart ? 1 : 0); e++) {
            const double dx = foot.x - stands[e].x, dy = foot.y - stands[e].y;
            const double shadow_m = hypot(dx, dy) * height_m / (stands[e].z - height_m);
            const double ux = dx / hypot(dx, dy), uy = dy / hypot(dx, dy);
            for (double share = 0.2; share < 1.2; share += 0.7) {
                const double x = foot.x + ux * shadow_m * share, y = foot.y + uy * shadow_m * share;
                const struct seen seen = ground_near(&r, x, y);
                const bool is_dark = share < 1;
                assert_true(is_dark ? seen.lit == 0 : seen.lit > 3);
                /* Ground that the transmitter lights and the receiver does not see is recorded. */
                assert_true(e == 0 ? seen.dark == 0 : is_dark ? seen.dark > 3 : seen.dark == 0);
                assert_true(ground_near(&r, x - uy * 0.3, y + ux * 0.3).lit > 3);
            }
            assert_true(
                ground_near(&r, foot.x + ux * (shadow_m + 0.18), foot.y + uy * (shadow_m + 0.18))
                    .lit > 3);
            assert_int_equal(
                ground_near(&r, foot.x + ux * (shadow_m - 0.14), foot.y + uy * (shadow_m - 0.14))
                    .lit,
                0);
        }
        trace_records_free(&r);
    }
}

/* ---- power ---- */

static struct reflect_law law_of(double specular, double diffuse)
{
    struct reflect_law law = {.kind = REFLECT_RAYSAR, .wavelength_m = lambda};
    for (int i = 0; i < TRACE_MATERIALS_MAX; i++) {
        law.materials[i] = (struct reflect_material){
            .name = "metal", .specular = specular, .diffuse = diffuse, .roughness = 1e-6};
    }
    return law;
}

static double power_of(const struct trace_records *r, const struct reflect_law *law)
{
    static float cells[64 * 64];
    double sum = 0;
    assert_int_equal(accumulate(r, law, cells), 0);
    for (int i = 0; i < 64 * 64; i++) {
        sum += (double)cells[i];
    }
    return sum;
}

/* A plate square to the line of sight, `further` m along it and `right` m aside. */
static struct trace_records traced_plate(double side_m, double further_m, double right_m,
                                         struct trace_ends ends, uint32_t rays)
{
    const struct trace_axes x = trace_axes_of(&(struct trace_look){0, 30, lambda});
    const struct vec u = vec_scale(x.across, side_m), v = vec_scale(x.rise, side_m);
    struct mesh m = {0};
    const struct vec middle = vec_mad(vec_scale(x.sight, further_m), x.across, right_m);
    shape_plate(&m, vec_mad(vec_mad(middle, u, -0.5), v, -0.5), u, v, mesh_material(&m, "metal"));
    return traced(&m, ends, 0.03, rays);
}

TEST(power_goes_by_the_fourth_power_of_range)
{
    const struct reflect_law law = law_of(0, 1), mirror = law_of(1, 0);
    for (double at_m = -0.9; at_m <= 0.91; at_m += 0.45) {
        struct trace_records r =
            traced_plate(0.2, at_m, 0, (struct trace_ends){5, false, 0, 0, 0}, 4);
        assert_near(power_of(&r, &law) / (0.04 * pow(5 / (5 + at_m), 4)), 1, 0.02);
        trace_records_free(&r);
        /* A small plate is in its far zone. */
        r = traced_plate(0.1, at_m, 0, (struct trace_ends){5, false, 0, 0, 0}, 8);
        const double whole = sqrt(4 * pi) / lambda * 0.01;
        assert_near(cabs(coherent_total(&r, &mirror, 1)) / (whole * pow(5 / (5 + at_m), 2)), 1,
                    0.03);
        trace_records_free(&r);
    }
}

/* A plate straight ahead of a radar at distance d, within its near zone: the field is that over the
 * plate of exp(-i 2 k (r - d)) (d / r)^3, which is Fresnel's integrals squared to first order. */
TEST(a_near_plate_echoes_as_fresnels_integrals_say)
{
    const struct reflect_law law = law_of(1, 0);
    const double side_m = 0.5, distances_m[] = {5, 6, 9, 20};
    for (int i = 0; i < 4; i++) {
        const double d = distances_m[i], k = 2 * pi / lambda, step_m = side_m / 400;
        double complex one = 0;
        for (int n = 0; n < 400; n++) {
            const double x = (n + 0.5) * step_m - side_m / 2;
            one += step_m * cexp(-I * k * x * x / d);
        }
        const double expected = sqrt(4 * pi) / lambda * pow(cabs(one), 2);
        struct trace_records r =
            traced_plate(side_m, 0, 0, (struct trace_ends){d, false, 0, 0, 0}, 4);
        assert_near(cabs(coherent_total(&r, &law, 1)) / expected, 1, 0.03);
        trace_records_free(&r);
    }
}

/* Aside, phases turn over each tube: all of the small plate's side lobe hangs on that. */
TEST(a_plate_aside_echoes_as_the_integral_over_it)
{
    const struct reflect_law law = law_of(1, 0);
    const double d = 5, aside_m = 1, side_m = 0.14, step_m = side_m / 200;
    double complex expected = 0;
    for (int n = 0; n < 200 * 200; n++) {
        const double x = aside_m + (n % 200 + 0.5) * step_m - side_m / 2;
        const double y = (n / 200 + 0.5) * step_m - side_m / 2, r = sqrt(d * d + x * x + y * y);
        expected += step_m * step_m * pow(d / r, 3) * cexp(-I * 4 * pi / lambda * r);
    }
    struct trace_records r =
        traced_plate(side_m, 0, aside_m, (struct trace_ends){d, false, 0, 0, 0}, 1);
    assert_near(cabs(coherent_total(&r, &law, 1)) * lambda / sqrt(4 * pi) / cabs(expected), 1,
                0.06);
    trace_records_free(&r);
}

/* Far away, both ways of tracing are one. */
TEST(a_thousand_kilometres_are_as_good_as_plane_waves)
{
    const struct reflect_law law = law_of(1, 0);
    double complex fields[2];
    for (int i = 0; i < 2; i++) {
        struct trace_records r =
            traced_plate(0.4, 0.3, 0.2, (struct trace_ends){i ? 1e6 : 0, false, 0, 0, 0}, 3);
        fields[i] = coherent_total(&r, &law, 1);
        trace_records_free(&r);
    }
    assert_near(cabs(fields[1] / fields[0] - 1), 0, 0.02);
}

static void add_sphere(struct mesh *m, double radius_m)
{
    enum { ROUND = 240 };
    const uint32_t metal = mesh_material(m, "metal");
    for (int i = 0; i < ROUND / 2; i++) {
        const double low = pi * (i - ROUND / 4) / (ROUND / 2), high = low + pi / (ROUND / 2);
        const struct shape_round ring = {.from = {0, 0, radius_m * sin(low)},
                                         .to = {0, 0, radius_m * sin(high)},
                                         .from_radius_m = fmax(radius_m * cos(low), 1e-9),
                                         .to_radius_m = fmax(radius_m * cos(high), 1e-9),
                                         .facets = ROUND};
        shape_round(m, &ring, metal);
    }
}

/* Geometrical optics: a sphere's cross section is pi r^2 for any angle b between the two ends, and
 * it echoes from r cos(b / 2) before its middle. */
TEST(a_sphere_is_as_large_and_lies_where_its_mirror_does_for_any_receiver)
{
    const struct reflect_law law = law_of(1, 0);
    const double radius_m = 0.25;
    double first_rad = 0;
    for (int turn_deg = 0; turn_deg <= 100; turn_deg += 20) {
        const struct trace_ends ends = {0, true, turn_deg, 30, 0};
        struct mesh m = {0};
        add_sphere(&m, radius_m);
        struct trace_records r = traced(&m, ends, 0.02, 4);
        const double complex total = coherent_total(&r, &law, 1);
        const double half = asin(cos(pi / 6) * sin(turn_deg * pi / 360));
        const double phase_rad = carg(total * cexp(-I * 4 * pi / lambda * radius_m * cos(half)));
        first_rad = turn_deg == 0 ? phase_rad : first_rad;
        assert_near(10 * log10(cabs(total) * cabs(total) / (pi * radius_m * radius_m)), 0, 1);
        assert_near(remainder(phase_rad - first_rad, 2 * pi), 0, 0.3);
        trace_records_free(&r);
    }
}

/* ---- what makes no sense ---- */

TEST(ends_without_sense_are_refused)
{
    static const struct {
        struct trace_ends ends;
        double cell_m;
        bool is_sound;
    } cases[] = {
        {{4, false, 0, 0, 0}, 0.05, true},    {{1, false, 0, 0, 0}, 0.05, false},
        {{2.1, false, 0, 0, 0}, 0.05, false}, {{4, false, 0, 0, 0}, 0.5, false},
        {{0, true, 235, 30, 0}, 0.05, false}, {{0, true, 240, 30, 0}, 0.05, true},
        {{0, true, 40, 30, 1}, 0.05, false},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        struct mesh m = {0};
        shape_box(&m, (struct vec){-0.5, -0.5, 0}, (struct vec){0.5, 0.5, 1.2},
                  mesh_material(&m, "metal"));
        const struct trace_order o = order_of(cases[i].ends, cases[i].cell_m, 1);
        struct scene s;
        struct trace_records r;
        assert_int_equal(scene_open(&s, &m, ends_ground_half_m(&o), "test"), 0);
        if ((trace_run(&s, &o, "test", &r, NULL) == 0) != cases[i].is_sound) {
            print_error("case %zu\n", i);
            fail();
        }
        trace_records_free(&r);
        scene_close(&s);
        mesh_free(&m);
    }
}
