/* Diffraction by edges, against the textbook's plate and what Ufimtsev's waves must keep. */
#include "check.h"
#include "metal.h"
#include "shapes.h"
#include "tracer/edges.h"
#include "tracer/trace.h"

#include <math.h>
#include <stdlib.h>

static const double pi = 3.14159265358979323846;
static const double lambda = TRACE_WAVELENGTH_M;
static const struct trace_look look = {0, 30, TRACE_WAVELENGTH_M};

static void assert_near(double found, double expected, double most)
{
    if (!(fabs(found - expected) <= most)) {
        print_error("%g is not within %g of %g\n", found, most, expected);
        fail();
    }
}

/* A plate of width a, turned by `turn` about its side of length b, which is upright on the plane:
 * along the electric vector of VV, across that of HH. */
static void add_turned_plate(struct mesh *m, double a, double b, double turn)
{
    const struct trace_axes x = trace_axes_of(&look);
    const struct vec u = vec_mad(vec_scale(x.across, a * cos(turn)), x.sight, a * sin(turn));
    const struct vec v = vec_scale(x.rise, b);
    shape_plate(m, vec_scale(vec_add(u, v), -0.5), u, v, mesh_material(m, "metal"));
}

static struct edge_echoes echoes_of(const struct mesh *m, const struct trace_look *l,
                                    double ground_half_m, enum reflect_kind kind)
{
    struct reflect_law law = metal_law(kind);
    struct scene s;
    struct edge_echoes e;
    law.wavelength_m = l->wavelength_m;
    assert_int_equal(scene_open(&s, m, ground_half_m, "test"), 0);
    assert_int_equal(edges_make(&e, m, &s, l, &law, 0.01), 0);
    scene_close(&s);
    return e;
}

static double complex sum_of(struct edge_echoes *e)
{
    double complex sum = 0;
    for (size_t i = 0; i < e->count; i++) {
        sum += e->echoes[i].field;
    }
    edges_free(e);
    return sum;
}

static double complex edges_of_plate(double a, double b, double turn, const struct trace_look *l,
                                     enum reflect_kind kind)
{
    struct mesh m = {0};
    add_turned_plate(&m, a, b, turn);
    struct edge_echoes e = echoes_of(&m, l, 0, kind);
    mesh_free(&m);
    return sum_of(&e);
}

/* sin x / sin t for x = k a sin t. */
static double sines(double x, double turn, double ka)
{
    return turn == 0 ? ka : sin(x) / sin(turn);
}

/* Keller's half planes at both edges of length b (Ross, IEEE Trans. AP-14, 1966, first order):
 * cos x +- i sin x / sin t in units of b / sqrt pi, less physical optics, sin x / tan t. The other
 * two edges are seen square to their faces: -+ i a / sqrt pi sin x / x. */
TEST(the_edges_of_a_plate_return_what_diffraction_has_beyond_optics)
{
    const double a = 0.2, b = 0.3, k = 2 * pi / lambda;
    for (double turn_deg = 0; turn_deg <= 85; turn_deg += 2.5) {
        const double t = turn_deg * pi / 180, x = k * a * sin(t), ratio = sines(x, t, k * a);
        const double complex side = I * ratio / (k * b), beyond = -ratio * (1 - cos(t));
        const double complex hh = edges_of_plate(a, b, t, &look, REFLECT_FRESNEL_HH);
        const double complex vv = edges_of_plate(a, b, t, &look, REFLECT_FRESNEL_VV);
        const double unit = b / sqrt(pi);
        assert_near(cabs(vv / unit - (I * cos(x) + beyond - side)), 0, 2e-3);
        assert_near(cabs(hh / unit - (-I * cos(x) + beyond + side)), 0, 2e-3);
    }
}

/* Ross's formula whole, with what goes from edge to edge, for his plate of 10.16 cm at 3.25 cm and
 * the electric vector along the edges. Optics alone is 3 dB and more off beyond 50 degrees. */
TEST(ross_plate_has_his_cross_section)
{
    const double a = 0.1016, wave_m = 0.0325, ka = 2 * pi * a / wave_m;
    const struct trace_look l = {0, 30, wave_m};
    double most_off_db = 0;
    for (double turn_deg = 2; turn_deg <= 75; turn_deg += 1) {
        const double t = turn_deg * pi / 180, s = sin(t), x = ka * s;
        const double complex across = cexp(I * (ka - pi / 4)) / (sqrt(2 * pi) * pow(ka, 1.5));
        const double complex rim =
            (1 + s) * cexp(-I * x) / pow(1 - s, 2) + (1 - s) * cexp(I * x) / pow(1 + s, 2);
        const double complex loop = 1 - cexp(I * (2 * ka - pi / 2)) / (8 * pi * pow(ka, 3));
        const double complex ross =
            cos(x) - I * sin(x) / s - across * (1 / cos(t) + across / 4 * rim) / loop;
        const double optics = sin(x) / s * cos(t);
        const double complex edges = edges_of_plate(a, a, t, &l, REFLECT_FRESNEL_VV);
        const double found_db = 20 * log10(cabs(edges / (a / sqrt(pi)) - optics));
        assert_near(found_db, 20 * log10(cabs(ross)), 0.6);
        most_off_db = turn_deg > 50 ? fmax(most_off_db, fabs(20 * log10(fabs(optics) / cabs(ross))))
                                    : most_off_db;
    }
    assert_true(most_off_db > 3);
}

/* What rays find and what edges add have one phase and one scale. */
TEST(rays_and_edges_make_a_plate_together)
{
    const double a = 0.2, b = 0.3, k = 2 * pi / lambda, unit = b / sqrt(pi);
    for (double turn_deg = 10; turn_deg <= 70; turn_deg += 20) {
        const double t = turn_deg * pi / 180, x = k * a * sin(t);
        const struct trace_order o = {.look = look,
                                      .grid = {64, 64, 0.0078},
                                      .rays_per_cell = 12,
                                      .bounces = 1,
                                      .threads = 2};
        const struct reflect_law law = metal_law(REFLECT_FRESNEL_VV);
        struct mesh m = {0};
        struct scene s;
        struct trace_records r;
        add_turned_plate(&m, a, b, t);
        assert_int_equal(scene_open(&s, &m, 0, "test"), 0);
        assert_int_equal(trace_run(&s, &o, "test", &r, NULL), 0);
        const double complex optics = coherent_total(&r, &law, 1);
        const double complex all = optics + edges_of_plate(a, b, t, &look, REFLECT_FRESNEL_VV);
        assert_near(cabs(all) / unit, cabs(cos(x) + I * sin(x) / sin(t)), 0.1);
        assert_true(turn_deg < 60 || cabs(optics) / unit < 0.5);
        trace_records_free(&r);
        scene_close(&s);
        mesh_free(&m);
    }
}

/* A flat wedge has none; faces may be counted from either side; nothing jumps where a face comes
 * into light or is seen straight on. On the face itself no electric field along the edge is left.
 */
TEST(waves_of_a_wedge_keep_what_they_must)
{
    for (double phi = 0.05; phi < pi; phi += 0.1) {
        assert_near(edges_waves(pi * 1.0001, phi).soft, 0, 1e-3);
        assert_near(edges_waves(pi * 1.0001, phi).hard, 0, 1e-3);
    }
    for (double n = 1.1; n <= 2; n += 0.1) {
        struct edge_waves before = edges_waves(n * pi, 1e-3);
        assert_near(before.soft + tan(1e-3) / 2 + (n * pi < pi ? tan(n * pi) / 2 : 0), 0, 2e-3);
        for (double phi = 1e-3; phi < n * pi; phi += 1e-3) {
            const struct edge_waves w = edges_waves(n * pi, phi);
            const struct edge_waves other = edges_waves(n * pi, n * pi - phi);
            assert_near(w.soft, other.soft, 1e-3);
            assert_near(w.hard, other.hard, 1e-3);
            assert_near(w.soft, before.soft, 0.01);
            assert_near(w.hard, before.hard, 0.01);
            before = w;
        }
        for (int face = 0; face < 2; face++) {
            const double straight_on = face == 0 ? pi / 2 : n * pi - pi / 2;
            const struct edge_waves w = edges_waves(n * pi, straight_on);
            assert_near(w.soft, edges_waves(n * pi, straight_on + 1e-3).soft, 0.01);
            assert_near(w.hard, edges_waves(n * pi, straight_on + 1e-3).hard, 0.01);
        }
    }
}

/* ---- which edges count ---- */

static size_t count_of(const struct mesh *m, double ground_half_m)
{
    const struct trace_look aside = {20, 30, lambda};
    struct edge_echoes e = echoes_of(m, &aside, ground_half_m, REFLECT_FRESNEL_HH);
    const size_t count = e.count;
    edges_free(&e);
    return count;
}

TEST(only_edges_that_the_radar_sees_and_that_are_edges_return)
{
    struct mesh m = {0};
    const uint32_t metal = mesh_material(&m, "metal");
    /* A box of 1 x 1 x 1 m from 20 degrees aside: 100 pieces an edge. Two of the nine that are seen
     * stand on the ground; three are behind it. */
    shape_box(&m, (struct vec){-0.5, -0.5, 0}, (struct vec){0.5, 0.5, 1}, metal);
    assert_int_equal(count_of(&m, 0), 900);
    assert_int_equal(count_of(&m, 10), 700);
    /* A wall before it hides all, and has four edges of its own, two of them upright. */
    shape_plate(&m, (struct vec){1, -3, 0}, (struct vec){0, 6, 0}, (struct vec){0, 0, 3}, metal);
    assert_int_equal(count_of(&m, 0), 2 * 600 + 2 * 300);
    mesh_free(&m);
    /* Of a round body only the rims; an inner corner is none. */
    const struct shape_round round = {{0, 0, 0.5}, {0, 0, 1.5}, 0.5, 0.5, 180, true};
    shape_round(&m, &round, mesh_material(&m, "metal"));
    const double rim_pieces = 180 * ceil(2 * pi * 0.5 / 180 / 0.01);
    const size_t rims = count_of(&m, 0);
    assert_true((double)rims > rim_pieces && (double)rims < 2 * rim_pieces);
    mesh_free(&m);
    shape_plate(&m, (struct vec){0, -0.5, 0}, (struct vec){0, 1, 0}, (struct vec){0, 0, 1},
                mesh_material(&m, "metal"));
    const size_t alone = count_of(&m, 0);
    shape_plate(&m, (struct vec){0, -0.5, 0}, (struct vec){1, 0, 0}, (struct vec){0, 1, 0}, 0);
    assert_int_equal(alone, 400);
    assert_int_equal(count_of(&m, 0), 600);
    mesh_free(&m);
}
