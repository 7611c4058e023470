/* Signatures against geometry: where things lie in a chip, what hides the ground, and how much
 * comes back. */
#include "check.h"
#include "shapes.h"
#include "tracer/accumulate.h"
#include "tracer/bake.h"
#include "tracer/models.h"

#include <math.h>
#include <string.h>

static const double pi = 3.14159265358979323846;

/* Every reflection returns the share `diffuse` and sends `specular` on, whatever its angles. */
struct plain {
    double diffuse, specular;
};

static int draw_plain(void *ctx, const struct trace_records *r, float *power)
{
    const struct plain *plain = ctx;
    struct reflect_law law = {.kind = REFLECT_RAYSAR, .wavelength_m = r->look.wavelength_m};
    for (uint32_t i = 0; i < r->material_count; i++) {
        law.materials[i] = (struct reflect_material){.permittivity = 1,
                                                     .specular = plain->specular,
                                                     .roughness = 1e-9, /* no lobe */
                                                     .diffuse = plain->diffuse,
                                                     .brilliance = 0};
    }
    return accumulate(r, &law, power);
}

static struct plain matt = {1, 0};

static struct bake_order order_of(const struct mesh *m, long aspects, uint32_t bounces,
                                  double pixel_m)
{
    struct bake_order o = {
        .name = "test",
        .place = "test",
        .looks = {.aspects = aspects, .depressions = 2, .depression_deg = {15, 40}},
        .wavelength_m = 0.03,
        .rays_per_cell = 2,
        .bounces = bounces,
        .threads = 1,
        .mean_dbsm = NAN,
        .maker = {&matt, draw_plain},
    };
    assert_int_equal(bake_layout(&o.layout, m, &o.looks, pixel_m, "test"), 0);
    return o;
}

static double rcs_of(uint8_t code)
{
    return code == 0 ? 0 : pow(10, (code / 2.0 - 80) / 10);
}

/* Its power, and the centre of that in pixels. */
static double weigh(const struct lm_chip *c, double *row, double *column)
{
    double sum = 0, rows = 0, columns = 0;
    for (int r = 0; r < LM_CHIP_SIDE; r++) {
        for (int k = 0; k < LM_CHIP_SIDE; k++) {
            const double rcs = rcs_of(c->level[r][k]);
            sum += rcs;
            rows += rcs * (r + 0.5);
            columns += rcs * (k + 0.5);
        }
    }
    *row = rows / sum;
    *column = columns / sum;
    return sum;
}

/* A cube of 0.2 m ahead, to the right and above: in each chip where the radar sees it. */
TEST(a_thing_lies_where_the_radar_puts_it)
{
    const struct vec at = {3, -1.2, 2}, half = {0.1, 0.1, 0.1};
    struct mesh m = {0};
    shape_box(&m, vec_sub(at, half), vec_add(at, half), mesh_material(&m, "metal"));
    const struct bake_order o = order_of(&m, 7, 1, 0);
    struct db_signature s;
    struct bake_report report;
    assert_int_equal(bake(&o, &m, &s, &report), 0);
    const double pixel_m = o.layout.pixel_mm / 1000.0;
    for (int i = 0; i < 14; i++) {
        const double turn = 2 * pi * (i % 7) / 7, psi = o.looks.depression_deg[i / 7] * pi / 180;
        const double toward = at.x * cos(turn) - at.y * sin(turn);
        const double across = at.x * sin(turn) + at.y * cos(turn);
        double row, column;
        (void)weigh(&s.chips[i], &row, &column);
        assert_true(fabs(row - o.layout.origin_row - (-toward - at.z * tan(psi)) / pixel_m) <
                    0.15 / pixel_m + 0.1);
        assert_true(fabs(column - 32 - across / pixel_m) < 0.05 / pixel_m + 0.1);
    }
    db_signature_free(&s);
    mesh_free(&m);
}

/* A wall of 2 x 3 m, square to the radar, in chips much shorter than the ground that lights it. Of
 * one reflection it returns its area as seen; the ground nothing. Of two, what goes by way of the
 * ground comes from the wall's foot: the same area both ways round, times what goes on. */
TEST(the_ground_returns_only_what_it_reflects)
{
    struct plain shiny = {1, 0.5};
    struct mesh m = {0};
    struct db_signature s;
    struct bake_report report;
    shape_box(&m, (struct vec){-0.02, -1.5, 0}, (struct vec){0, 1.5, 2},
              mesh_material(&m, "metal"));
    double total[2];
    for (uint32_t bounces = 1; bounces <= 2; bounces++) {
        struct bake_order o = order_of(&m, 4, bounces, 0.08);
        o.looks.aspects = o.looks.depressions = 1;
        o.maker.ctx = &shiny;
        assert_int_equal(bake(&o, &m, &s, &report), 0);
        total[bounces - 1] = pow(10, report.mean_dbsm / 10);
        assert_true(report.lost_share < 1e-3);
        const uint8_t *before_foot = s.chips[0].level[o.layout.origin_row + 1];
        for (int c = 0; c < LM_CHIP_SIDE; c++) {
            assert_int_equal(before_foot[c], 0); /* behind the wall's foot is nothing */
        }
        db_signature_free(&s);
    }
    const double psi = 15 * pi / 180, wall_m2 = 6 * cos(psi), top_m2 = 3 * 0.02 * sin(psi);
    assert_true(fabs(total[0] / (wall_m2 + top_m2) - 1) < 0.01);
    assert_true(fabs((total[1] - total[0]) / (2 * 0.5 * wall_m2) - 1) < 0.01);
    mesh_free(&m);
}

/* A box hides what lies under it and behind it as far as its height over the tangent. */
TEST(a_box_throws_the_shadow_of_its_height)
{
    struct mesh m = {0};
    struct db_signature s;
    struct bake_report report;
    shape_box(&m, (struct vec){-1, -2, 0}, (struct vec){1, 2, 1.5}, mesh_material(&m, "metal"));
    const struct bake_order o = order_of(&m, 4, 1, 0.2);
    assert_int_equal(bake(&o, &m, &s, &report), 0);
    int in_shadow = 0;
    for (int i = 0; i < 8; i++) {
        const double half_across = i % 2 ? 1 : 2, half_along = i % 2 ? 2 : 1;
        const double end = half_along + 1.5 / tan(o.looks.depression_deg[i / 4] * pi / 180);
        for (int k = 0; k < LM_CHIP_SIDE * LM_CHIP_SIDE; k++) {
            const int row = k / LM_CHIP_SIDE, column = k % LM_CHIP_SIDE;
            const double away = (row + 0.5 - o.layout.origin_row) * 0.2;
            const double across = fabs((column + 0.5 - 32) * 0.2);
            const bool is_hidden = s.chips[i].shadow[row][column / 8] >> column % 8 & 1;
            const bool is_near_edge = fabs(across - half_across) < 0.1 ||
                                      fabs(away + half_along) < 0.1 || fabs(away - end) < 0.1;
            if (!is_near_edge) {
                assert_int_equal(is_hidden,
                                 across < half_across && away > -half_along && away < end);
            }
            in_shadow += is_hidden;
        }
    }
    assert_true(in_shadow > 2000);
    db_signature_free(&s);
    mesh_free(&m);
}

TEST(the_mean_is_what_was_ordered_and_the_table_is_the_chips_sum)
{
    struct mesh m = {0};
    struct db_signature s;
    struct bake_report report;
    model_tank(&m);
    struct bake_order o = order_of(&m, 5, 2, 0);
    o.mean_dbsm = 17;
    assert_int_equal(bake(&o, &m, &s, &report), 0);
    assert_true(fabs(report.mean_dbsm - 17) < 1e-6);
    double mean = 0;
    for (int i = 0; i < 10; i++) {
        double row, column;
        const double table = rcs_of(s.head.rcs[i / 5][i % 5]);
        assert_true(fabs(10 * log10(weigh(&s.chips[i], &row, &column) / table)) < 0.3);
        mean += table / 10;
    }
    assert_true(fabs(10 * log10(mean) - 17) < 0.26);
    db_signature_seal(&s, 0, 0);
    assert_int_equal(lm_signature_check(&s.head, 10), LM_OK);
    assert_true(db_signature_rest_is_zero(&s.head));
    db_signature_free(&s);
    mesh_free(&m);
}

TEST(a_code_is_the_nearest_half_decibel)
{
    assert_int_equal(bake_code(0), 0);
    assert_int_equal(bake_code(1e-9), 0);
    assert_int_equal(bake_code(1), 160);
    assert_int_equal(bake_code(1e9), 255);
    for (double db = -79.5; db <= 47.5; db += 0.07) {
        const double back = bake_code(pow(10, db / 10)) / 2.0 - 80;
        assert_true(fabs(back - db) <= 0.25 + 1e-9);
    }
}

/* A mast far ahead: from all sides it, its lean and its shadow at 15 degrees are in the chip. */
TEST(the_pixels_hold_model_lean_and_shadow)
{
    struct mesh m = {0};
    struct db_signature s;
    struct bake_report report;
    struct bake_layout small;
    shape_box(&m, (struct vec){4.8, -1, 0}, (struct vec){5.2, 1, 10}, mesh_material(&m, "metal"));
    const struct bake_order o = order_of(&m, 4, 2, 0);
    assert_int_equal(bake(&o, &m, &s, &report), 0);
    assert_true(report.lost_share < 1e-4);
    for (int i = 0; i < 8; i++) {
        for (int c = 0; c < LM_CHIP_SIDE / 8; c++) {
            assert_int_equal(s.chips[i].shadow[LM_CHIP_SIDE - 1][c], 0);
        }
    }
    /* Not much larger than need be: the shadow from behind ends in the last rows. */
    uint32_t far = 0;
    for (int k = 0; k < 3 * LM_CHIP_SIDE / 8; k++) {
        far += s.chips[0].shadow[LM_CHIP_SIDE - 4 + k / 8][k % 8];
        far += s.chips[2].shadow[LM_CHIP_SIDE - 4 + k / 8][k % 8];
    }
    assert_true(far > 0);
    assert_int_equal(bake_layout(&small, &m, &o.looks, 0.1, "test"), -1);
    db_signature_free(&s);
    mesh_free(&m);
}

TEST(a_model_that_returns_nothing_is_refused)
{
    struct plain black = {0, 0};
    struct mesh m = {0};
    struct db_signature s;
    struct bake_report report;
    model_tank(&m);
    struct bake_order o = order_of(&m, 1, 1, 0);
    o.maker.ctx = &black;
    assert_int_equal(bake(&o, &m, &s, &report), -1);
    assert_null(s.chips);
    mesh_free(&m);
}
