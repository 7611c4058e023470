/* Coherent sum and complex chips, against cross sections and responses of the textbooks. */
#include "check.h"
#include "metal.h"
#include "shapes.h"
#include "tracer/coherent.h"
#include "tracer/focus.h"
#include "tracer/trace.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double pi = 3.14159265358979323846;
static const double lambda = TRACE_WAVELENGTH_M;

/* Looks from ahead; without ground. The mesh is freed. */
static struct trace_records traced(struct mesh *m, double depression_deg, double cell_m,
                                   uint32_t rays)
{
    const struct trace_order o = {.look = {0, depression_deg, lambda},
                                  .grid = {128, 128, cell_m},
                                  .rays_per_cell = rays,
                                  .bounces = TRACE_BOUNCES_MAX,
                                  .threads = 2};
    struct scene s;
    struct trace_records r;
    assert_int_equal(scene_open(&s, m, 0, "test"), 0);
    assert_int_equal(trace_run(&s, &o, "test", &r, NULL), 0);
    scene_close(&s);
    mesh_free(m);
    return r;
}

static double dbsm(double complex field)
{
    return 20 * log10(cabs(field));
}

static double total_dbsm(const struct trace_records *r, enum reflect_kind kind)
{
    const struct reflect_law law = metal_law(kind);
    return dbsm(coherent_total(r, &law, 1));
}

static void assert_near(double found, double expected, double most)
{
    if (!(fabs(found - expected) <= most)) {
        print_error("%g is not within %g of %g\n", found, most, expected);
        fail();
    }
}

/* Knott, Shaeffer, Tuley, Radar Cross Section, chapter 5: physical optics of a plate a x b, turned
 * by t: 4 pi (a b cos t / l)^2 (sin x / x)^2, x = k a sin t. The root, over that at t = 0. */
static double plate_lobe(double a, double turn)
{
    const double x = 2 * pi / lambda * a * sin(turn);
    return cos(turn) * (x == 0 ? 1 : fabs(sin(x) / x));
}

TEST(a_plate_has_the_main_lobe_and_side_lobes_of_physical_optics)
{
    const double a = 0.4, b = 0.3, peak = sqrt(4 * pi) * a * b / lambda;
    const struct trace_axes x = trace_axes_of(&(struct trace_look){0, 30, lambda});
    const struct reflect_law law = metal_law(REFLECT_FRESNEL_HH);
    for (double turn_deg = 0; turn_deg <= 14; turn_deg += 0.25) {
        const double turn = turn_deg * pi / 180;
        const struct vec u = vec_mad(vec_scale(x.across, a * cos(turn)), x.sight, a * sin(turn));
        const struct vec v = vec_scale(x.rise, b);
        struct mesh m = {0};
        shape_plate(&m, vec_scale(vec_add(u, v), -0.5), u, v, mesh_material(&m, "metal"));
        struct trace_records r = traced(&m, 30, 0.0078, 4);
        /* The first side lobe is 0.217 of the peak. A ray too many at the edge is 0.005. */
        assert_near(cabs(coherent_total(&r, &law, 1)) / peak, plate_lobe(a, turn), 0.008);
        trace_records_free(&r);
    }
}

/* Knott, Shaeffer, Tuley, table 6.1: of plates with sides of 0.5 m. */
TEST(corners_have_the_cross_sections_of_the_textbook)
{
    const double boresight = atan(sqrt(0.5)) * 180 / pi, a = 0.5, all = pow(a, 4) / lambda / lambda;
    const struct vec s = {a * sqrt(0.5), a * sqrt(0.5), 0}, p = {a * sqrt(0.5), -a * sqrt(0.5), 0};
    const struct vec o = {0, 0, 0}, up = {0, 0, a};
    struct mesh m = {0};
    uint32_t metal = mesh_material(&m, "metal");
    shape_plate(&m, (struct vec){0, -a / 2, 0}, (struct vec){0, a, 0}, up, metal);
    shape_plate(&m, (struct vec){0, -a / 2, 0}, (struct vec){a, 0, 0}, (struct vec){0, a, 0},
                metal);
    struct trace_records r = traced(&m, 45, 0.01, 4);
    assert_near(total_dbsm(&r, REFLECT_FRESNEL_HH), 10 * log10(8 * pi * all), 0.15);
    trace_records_free(&r);

    metal = mesh_material(&m, "metal");
    shape_plate(&m, o, p, s, metal);
    shape_plate(&m, o, up, s, metal);
    shape_plate(&m, o, p, up, metal);
    r = traced(&m, boresight, 0.01, 4);
    assert_near(total_dbsm(&r, REFLECT_FRESNEL_VV), 10 * log10(12 * pi * all), 0.15);
    trace_records_free(&r);

    metal = mesh_material(&m, "metal");
    shape_triangle(&m, o, p, s, metal);
    shape_triangle(&m, o, s, up, metal);
    shape_triangle(&m, o, up, p, metal);
    r = traced(&m, boresight, 0.01, 4);
    assert_near(total_dbsm(&r, REFLECT_RAYSAR), 10 * log10(4 * pi / 3 * all), 0.15);
    trace_records_free(&r);
}

/* The same book: a cylinder of radius r and length l, seen from the side, k r l^2. Nothing is flat:
 * the sum over many rays finds the zone that counts. */
TEST(a_cylinder_has_the_cross_section_of_its_curvature)
{
    const double radius = 0.2, length = 0.4;
    const struct trace_axes x = trace_axes_of(&(struct trace_look){0, 30, lambda});
    struct mesh m = {0};
    const struct shape_round round = {.from = vec_scale(x.rise, -length / 2),
                                      .to = vec_scale(x.rise, length / 2),
                                      .from_radius_m = radius,
                                      .to_radius_m = radius,
                                      .facets = SHAPE_CORNERS_MAX,
                                      .has_caps = true};
    shape_round(&m, &round, mesh_material(&m, "metal"));
    struct trace_records r = traced(&m, 30, 0.0078, 8);
    const double expected = 10 * log10(2 * pi / lambda * radius * length * length);
    assert_near(total_dbsm(&r, REFLECT_FRESNEL_HH), expected, 0.7);
    trace_records_free(&r);
}

static double turn_between(struct trace_records *r)
{
    const struct reflect_law hh = metal_law(REFLECT_FRESNEL_HH), vv = metal_law(REFLECT_FRESNEL_VV);
    const double turn = carg(coherent_total(r, &hh, 1) / coherent_total(r, &vv, 1));
    trace_records_free(r);
    return fabs(turn);
}

/* What tells walls from roofs in polarimetry: HH and VV of a dihedral are opposite. */
TEST(polarisations_agree_after_odd_reflections_and_oppose_after_even_ones)
{
    const struct trace_axes x = trace_axes_of(&(struct trace_look){0, 30, lambda});
    struct mesh m = {0};
    shape_plate(&m, vec_scale(vec_add(x.across, x.rise), -0.2), vec_scale(x.across, 0.4),
                vec_scale(x.rise, 0.4), mesh_material(&m, "metal"));
    struct trace_records r = traced(&m, 30, 0.01, 2);
    assert_near(turn_between(&r), 0, 1e-3);
    shape_plate(&m, (struct vec){0, -0.2, 0}, (struct vec){0, 0.4, 0}, (struct vec){0, 0, 0.3},
                mesh_material(&m, "metal"));
    shape_plate(&m, (struct vec){0, -0.2, 0}, (struct vec){0.6, 0, 0}, (struct vec){0, 0.4, 0}, 0);
    r = traced(&m, 30, 0.01, 2);
    assert_near(turn_between(&r), pi, 0.1); /* the wall alone has a side lobe, an odd one */
}

/* ---- tubes: few rays, far apart ---- */

/* A tube of plane waves that flat mirrors lead to a small plate, which sends it back to the radar.
 * The plate is cut so that it takes `columns` x `rows` tubes whole, and is tilted so that the phase
 * makes so many turns over it, either way. */
struct relay {
    uint32_t mirrors, columns, rows;
    double turns_aside, turns_above;
    const char *material; /* of the plate */
};

enum { RELAY_MIRRORS_MAX = 2 };
static const double relay_step_m = 0.05, relay_depression_deg = 30, relay_way_m = 0.9;

static struct vec mirrored_by(struct vec v, struct vec normal)
{
    return vec_mad(v, normal, -2 * vec_dot(v, normal));
}

static struct vec unit(struct vec v)
{
    return vec_scale(v, 1 / vec_length(v));
}

/* A square of 0.5 m about `centre`. */
static void add_mirror(struct mesh *m, struct vec centre, struct vec normal)
{
    const struct vec any = fabs(normal.z) < 0.7 ? (struct vec){0, 0, 1} : (struct vec){1, 0, 0};
    const struct vec u = vec_scale(unit(vec_cross(any, normal)), 0.5);
    const struct vec v = vec_cross(normal, u);
    const struct vec corner = vec_mad(vec_mad(centre, u, -0.5), v, -0.5);
    shape_plate(m, corner, u, v, mesh_material(m, "metal"));
}

/* What the sight must have of an edge `across`, so that its image turns the phase so often. `back`
 * is where the sight comes from when it is led the other way. */
static double sight_part(const struct trace_axes *x, struct vec across, struct vec back,
                         double turns)
{
    return (turns * lambda - vec_dot(across, back)) / (1 + vec_dot(x->sight, back));
}

/* Fill `normals` of the mirrors that lead the sight along fixed ways, none of them along an axis.
 */
static void lead(const struct trace_axes *x, struct vec normals[RELAY_MIRRORS_MAX])
{
    const struct vec first = unit(vec_mad(vec_mad(x->across, x->rise, 0.35), x->sight, 0.2));
    const struct vec second = unit(vec_mad(vec_mad(x->rise, x->across, 0.25), x->sight, -0.3));
    normals[0] = unit(vec_sub(first, x->sight));
    normals[1] = unit(vec_sub(second, first));
}

static struct mesh relay_mesh(const struct relay *r)
{
    const struct trace_axes x =
        trace_axes_of(&(struct trace_look){0, relay_depression_deg, lambda});
    struct vec normals[RELAY_MIRRORS_MAX], back = x.sight, along = x.sight;
    const double step_up_m = relay_step_m * tan(relay_depression_deg * pi / 180);
    struct vec at = vec_mad(vec_scale(x.across, r->columns % 2 * relay_step_m / 2), x.rise,
                            r->rows % 2 * step_up_m / 2);
    struct vec u = vec_scale(x.across, r->columns * relay_step_m);
    struct vec v = vec_scale(x.rise, r->rows * step_up_m);
    struct mesh m = {0};
    lead(&x, normals);
    for (uint32_t i = r->mirrors; i-- > 0;) {
        back = mirrored_by(back, normals[i]);
    }
    u = vec_mad(u, x.sight, sight_part(&x, u, back, r->turns_aside));
    v = vec_mad(v, x.sight, sight_part(&x, v, back, r->turns_above));
    for (uint32_t i = 0; i < r->mirrors; i++) {
        add_mirror(&m, at, normals[i]);
        along = mirrored_by(along, normals[i]);
        u = mirrored_by(u, normals[i]);
        v = mirrored_by(v, normals[i]);
        at = vec_mad(at, along, relay_way_m);
    }
    shape_plate(&m, vec_mad(vec_mad(at, u, -0.5), v, -0.5), u, v, mesh_material(&m, r->material));
    return m;
}

/* Leave the echoes of the plate by way of all mirrors, and count them. */
static uint32_t block_others(struct trace_records *t, const struct relay *r)
{
    uint32_t left = 0;
    for (uint32_t b = 0; b < t->bounce_count; b++) {
        for (uint32_t i = 0; i < t->bounces[b].count; i++) {
            struct trace_record *echo = &t->bounces[b].records[i];
            const bool is_plate = strcmp(t->materials[echo->material], r->material) == 0;
            if (b == r->mirrors && is_plate) {
                left += !(echo->flags & TRACE_BLOCKED);
            } else {
                echo->flags |= TRACE_BLOCKED;
            }
        }
    }
    return left;
}

/* Field of the echo from the plate alone, over that of a mirror of its area seen straight on. */
static double relayed(const struct relay *r)
{
    const struct reflect_law law = metal_law(REFLECT_FRESNEL_HH);
    struct mesh m = relay_mesh(r);
    struct trace_records t = traced(&m, relay_depression_deg, relay_step_m, 1);
    assert_int_equal(block_others(&t, r), r->columns * r->rows);
    const double plate_m2 = r->columns * t.sensor.step_across_m * (r->rows * t.sensor.step_up_m);
    const double field = cabs(coherent_total(&t, &law, 1));
    trace_records_free(&t);
    return field / (sqrt(4 * pi) / lambda * plate_m2);
}

static double sinc(double turns)
{
    return turns == 0 ? 1 : fabs(sin(pi * turns) / (pi * turns));
}

/* Physical optics of a flat plate is the product of two sincs of the turns over it, wherever the
 * wave comes from. Tubes as wide as a third of the plate give it, because each is the sum over its
 * own width; point by point it would be wrong by a tenth and more. Mirrors turn the tubes over. */
TEST(few_wide_tubes_give_what_physical_optics_says)
{
    static const double turns[][2] = {{0, 0}, {0.9, 0}, {0, 1.2}, {1.3, 0.7}, {-0.8, 1.4}};
    for (uint32_t mirrors = 0; mirrors <= RELAY_MIRRORS_MAX; mirrors++) {
        for (size_t i = 0; i < sizeof turns / sizeof turns[0]; i++) {
            const struct relay r = {mirrors, 3, 4, turns[i][0], turns[i][1], "plate"};
            assert_near(relayed(&r), sinc(turns[i][0]) * sinc(turns[i][1]), 1e-3);
        }
    }
}

/* Up to half a turn over one tube it is a sinc; beyond, either way, what rays cannot show. */
TEST(a_tube_of_more_than_half_a_turn_is_left_out)
{
    static const double turns[][2] = {{0.49, 0}, {0, 0.49}, {-0.49, 0.49}, {0.3, -0.4}};
    static const double beyond[][2] = {{0.51, 0}, {0, 0.51}, {-0.51, 0.1}, {0.1, -0.51}};
    for (int i = 0; i < 4; i++) {
        const struct relay within = {0, 1, 1, turns[i][0], turns[i][1], "plate"};
        assert_near(relayed(&within), sinc(turns[i][0]) * sinc(turns[i][1]), 1e-3);
        const struct relay left_out = {0, 1, 1, beyond[i][0], beyond[i][1], "plate"};
        assert_near(relayed(&left_out), 0, 1e-9);
    }
}

/* The ground's own first reflection is left out, and no other. */
TEST(ground_returns_as_a_mirror_does_after_the_first_reflection_alone)
{
    for (uint32_t mirrors = 0; mirrors <= RELAY_MIRRORS_MAX; mirrors++) {
        const struct relay r = {mirrors, 3, 4, 0, 0, "ground"};
        assert_near(relayed(&r), mirrors > 0 ? 1 : 0, 1e-3);
    }
}

/* ---- the response ---- */

enum { SIDE = 512, MIDDLE = SIDE / 2 };

/* A mirror of one square metre and one ray, at that place. */
static float complex *point_chip(double across_m, double range_m, const struct focus_order *o)
{
    struct trace_record t = {.across_m = (float)across_m,
                             .range_m = (float)range_m,
                             .normal = {0, (float)-sqrt(0.5), (float)sqrt(0.5)}};
    t.phase_rad = (float)remainder(-4 * pi * (double)t.range_m / lambda, 2 * pi);
    const struct trace_records r = {
        .look = {0, 45, lambda},
        .grid = {SIDE, SIDE, 0.05},
        .sensor = {1, 1, 1, 1, -0.5, -0.5},
        .material_count = 1,
        .materials = {"metal"},
        .bounce_count = 1,
        .bounces = {{&t, 1}},
    };
    const struct reflect_law law = metal_law(REFLECT_FRESNEL_HH);
    float complex *chip = focus_chip(&r, &law, o);
    assert_non_null(chip);
    return chip;
}

/* Highest value beyond the first minimum on a cut through the middle, over the peak. */
static double side_lobe_db(const float complex *first, int step)
{
    int i = MIDDLE;
    while (cabsf(first[(i + 1) * step]) < cabsf(first[i * step])) {
        i++;
    }
    float most = 0;
    for (; i < SIDE; i++) {
        most = fmaxf(most, cabsf(first[i * step]));
    }
    return 20 * log10((double)(most / cabsf(first[MIDDLE * step])));
}

static double width_m(const float complex *first, int step)
{
    const float half = cabsf(first[MIDDLE * step]) * (float)sqrt(0.5);
    int i = MIDDLE;
    while (cabsf(first[(i + 1) * step]) > half) {
        i++;
    }
    const float here = cabsf(first[i * step]), next = cabsf(first[(i + 1) * step]);
    return 2 * 0.05 * (i - MIDDLE + (double)((here - half) / (here - next)));
}

/* The sinc's -13.26 dB; Hamming's -43 dB in F. J. Harris, "On the use of windows", Proc. IEEE 66,
 * 1978, table 1, and -42.7 as computed from its formula; Taylor's design of -35 dB, which with nbar
 * 4 is -35.2 dB. */
TEST(a_point_has_the_side_lobes_of_its_weighting)
{
    static const double expected_db[FOCUS_WEIGHTINGS] = {-13.26, -42.7, -35.2};
    for (int w = 0; w < FOCUS_WEIGHTINGS; w++) {
        const struct focus_order o = {(enum focus_weighting)w, 0.6, 1, 1};
        float complex *chip = point_chip(0.025, 0.025, &o); /* a pixel's middle */
        const float complex *row = chip + MIDDLE * SIDE, *column = chip + MIDDLE;
        const double peak = 4 * pi / lambda / lambda;
        assert_near(pow(cabs(row[MIDDLE]), 2) / peak, 1, 2e-4);
        assert_near(side_lobe_db(row, 1), expected_db[w], 0.3);
        assert_near(side_lobe_db(column, SIDE), expected_db[w], 0.3);
        assert_near(width_m(row, 1), 0.6, 0.012);
        assert_near(width_m(column, SIDE), 0.6, 0.012);
        free(chip);
    }
}

/* Wherever it lies between the pixels: the response of 49 equal frequencies in 33.6 m (512 cells,
 * and a quarter of them to spare), a sinc that repeats itself there, phase and all. */
static double sinc_of_49(double metres)
{
    const double x = pi * metres / 33.6;
    return sin(49 * x) / (49 * sin(x));
}

TEST(a_point_between_pixels_is_the_sinc_at_its_place)
{
    for (double shift = 0.003; shift < 0.05; shift += 0.009) {
        const struct focus_order o = {FOCUS_UNIFORM, 0.6, 1, 1};
        float complex *chip = point_chip(0.025 + shift, 0.025 - shift, &o);
        const double range_m = (double)(float)(0.025 - shift);
        const double complex peak = -sqrt(4 * pi) / lambda * cexp(-4 * pi * I * range_m / lambda);
        for (int k = -60; k <= 60; k++) {
            const double complex expected =
                peak * sinc_of_49(0.05 * k - shift) * sinc_of_49(0.05 * k + shift);
            const double complex found = (double complex)chip[(MIDDLE + k) * SIDE + MIDDLE + k];
            assert_true(cabs(found - expected) < 2e-4 * cabs(peak));
        }
        free(chip);
    }
}

/* ---- speckle ---- */

static double share_above(const double *power, int count, double level)
{
    int above = 0;
    for (int i = 0; i < count; i++) {
        above += power[i] > level;
    }
    return (double)above / count;
}

/* Level ground, of which each ray is a scatterer, 36 in a resolution cell. Nothing is drawn for a
 * pixel, yet its intensity is exponential: contrast 1 (Goodman). The mean is what the law says of
 * its cross section, by the cell of Hamming's weighting: 1.36 bins (Harris) either way. */
TEST(rough_ground_speckles_by_the_sum_of_its_scatterers)
{
    enum { CELLS = 960, STEP = 6 };
    struct mesh m = {0};
    struct scene s;
    struct trace_records r;
    const struct trace_order o = {.look = {0, 15, lambda},
                                  .grid = {CELLS, CELLS, 0.1},
                                  .rays_per_cell = 2,
                                  .bounces = 1,
                                  .threads = 2};
    shape_box(&m, (struct vec){0, 0, 0}, (struct vec){0.01, 0.01, 0.01},
              mesh_material(&m, "metal"));
    assert_int_equal(scene_open(&s, &m, trace_ground_half_m(&o.grid, 15), "test"), 0);
    assert_int_equal(trace_run(&s, &o, "test", &r, NULL), 0);
    struct reflect_law law = metal_law(REFLECT_FRESNEL_HH);
    law.materials[1].diffuse = 0.05; /* F_b = 0: at all angles */
    const struct focus_order order = {FOCUS_HAMMING, 0.3, 1, 7};
    float complex *chip = focus_chip(&r, &law, &order);
    assert_non_null(chip);
    static double power[CELLS * CELLS / STEP / STEP];
    int count = 0;
    double sum = 0, squares = 0;
    for (int row = 30; row < CELLS - 30; row += STEP) {
        for (int column = 30; column < CELLS - 30; column += STEP) {
            power[count] = pow(cabs(chip[row * CELLS + column]), 2);
            sum += power[count];
            squares += power[count] * power[count];
            count++;
        }
    }
    const double mean = sum / count, side_m = 1.36 / focus_band(FOCUS_HAMMING, 0.3);
    assert_true(count > 20000);
    assert_near(sqrt(squares / count - mean * mean) / mean, 1, 0.03);
    for (int k = 1; k <= 4; k++) {
        assert_near(share_above(power, count, k * mean), exp(-k), 0.01);
    }
    /* A ray's tube is step by step tan 15 degrees; a cell of 0.01 m^2 has four. */
    const double sigma_m2 = 4 * 0.05 * 4 * 0.05 * 0.05 * tan(15 * pi / 180) / 0.01;
    assert_near(mean / (sigma_m2 * side_m * side_m), 1, 0.03);
    free(chip);
    trace_records_free(&r);
    scene_close(&s);
    mesh_free(&m);
}

TEST(pixels_too_coarse_for_the_band_are_refused)
{
    const struct trace_records r = {.look = {0, 45, lambda}, .grid = {64, 64, 0.1}};
    const struct reflect_law law = metal_law(REFLECT_RAYSAR);
    assert_null(focus_chip(&r, &law, &(struct focus_order){FOCUS_UNIFORM, 0.3, 4, 1}));
    assert_null(focus_chip(&r, &law, &(struct focus_order){FOCUS_UNIFORM, 4, 1, 1}));
}
