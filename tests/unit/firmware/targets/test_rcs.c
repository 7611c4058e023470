/* Radar cross sections, against published values, an integral over the plate and areas cut out of
 * polygons. */
#include "lm/rcs.h"

#include "check.h"
#include "hs/rng.h"
#include "reference/rcs.h"

#include <math.h>
#include <stdlib.h>

static const double pi = 3.14159265358979323846;
static const double x_band_m = 0.03; /* 10 GHz, as in [Heaton]: 0.1 m are 3 wavelengths or so */

static struct lm_direction fixed_of(struct ref_vector v)
{
    return (struct lm_direction){(int32_t)lround(v.ahead * (1 << 30)),
                                 (int32_t)lround(v.right * (1 << 30)),
                                 (int32_t)lround(v.up * (1 << 30))};
}

/* Angles from the boresight, to the right and then up. */
static struct ref_vector at(double right_deg, double up_deg)
{
    const double a = right_deg * pi / 180, e = up_deg * pi / 180;
    return (struct ref_vector){cos(e) * cos(a), cos(e) * sin(a), sin(e)};
}

static struct ref_vector direction_near_axis(struct hs_rng *r, double spread_deg)
{
    const double up_deg = spread_deg * (2 * hs_rng_uniform(r) - 1);
    return at(spread_deg * (2 * hs_rng_uniform(r) - 1), up_deg);
}

static double rcs_db(const struct lm_shape *s, double wavelength_m, struct ref_vector v)
{
    return lm_rcs_dbsm_q8(s, (uint32_t)lround(wavelength_m * 1e6), fixed_of(v)) / 256.0;
}

static double ref_db(const struct lm_shape *s, double wavelength_m, struct ref_vector v)
{
    return 10 * log10(ref_rcs_m2(s, wavelength_m, v));
}

static struct ref_vector random_direction(struct hs_rng *r)
{
    struct ref_vector v = {hs_rng_normal(r), hs_rng_normal(r), hs_rng_normal(r)};
    const double length = sqrt(v.ahead * v.ahead + v.right * v.right + v.up * v.up);
    return (struct ref_vector){v.ahead / length, v.right / length, v.up / length};
}

/* ---- Heaton ---- */

/* [Heaton], Table 1, as printed: size in metres and in wavelengths, null to null in degrees. The
 * printed angles are those of a ONE-way pattern, 2 asin(lambda / a), and the printed wavelengths
 * are round. What a radar receives back is the two-way pattern beside it, half as wide: that is the
 * one which the firmware uses. The 3-wavelength row is outside the optical region, as its footnote
 * says. */
static const struct {
    double metres, wavelengths, printed_deg, printed_to_deg, two_way_deg;
} table_1[] = {{0.1, 3, 38, 1, 19.2},
               {0.3, 10, 12, 0.6, 5.73},
               {3, 100, 1, 0.2, 0.573},
               {30, 1000, 0.1, 0.02, 0.0573}};

TEST(table_1_as_printed_is_the_one_way_lobe)
{
    for (size_t i = 0; i < sizeof table_1 / sizeof table_1[0]; i++) {
        const double one_way = ref_plate_lobe_deg(table_1[i].wavelengths, 1);
        const double two_way = ref_plate_lobe_deg(table_1[i].wavelengths, 2);
        print_message("# %5g wavelengths: printed %5g, one way %8.4f, two ways %8.4f degrees\n",
                      table_1[i].wavelengths, table_1[i].printed_deg, one_way, two_way);
        assert_true(fabs(one_way - table_1[i].printed_deg) < table_1[i].printed_to_deg);
        assert_true(fabs(two_way / table_1[i].two_way_deg - 1) < 0.002);
    }
}

/* From inside the lobe, walk out until the return rises again. */
static double first_null_deg(const struct lm_shape *s, double start_deg, double step_deg)
{
    double before = 1e9, angle = start_deg;
    for (double here = rcs_db(s, x_band_m, at(angle, 0)); here < before; angle += step_deg) {
        before = here;
        here = rcs_db(s, x_band_m, at(angle + step_deg, 0));
    }
    return angle - step_deg;
}

TEST(a_plate_returns_the_two_way_lobe_and_not_the_table)
{
    for (size_t i = 0; i < sizeof table_1 / sizeof table_1[0]; i++) {
        const uint32_t side_mm = (uint32_t)lround(table_1[i].wavelengths * x_band_m * 1e3);
        const struct lm_shape plate = {LM_SHAPE_PLATE, false, {side_mm, side_mm}};
        const double expected = ref_plate_lobe_deg(table_1[i].wavelengths, 2);
        const double found = 2 * first_null_deg(&plate, expected / 4, expected / 2000);
        assert_true(fabs(found / expected - 1) < 0.003);
    }
}

TEST(the_papers_three_formulas_hold_on_axis)
{
    const double a = 0.7, b = 1.9, l = 0.0313;
    const struct lm_shape sphere = {LM_SHAPE_SPHERE, false, {700, 0}};
    const struct lm_shape plate = {LM_SHAPE_PLATE, false, {700, 1900}};
    const struct lm_shape corner = {LM_SHAPE_TRIHEDRAL, false, {700, 0}};
    const struct lm_shape dihedral = {LM_SHAPE_DIHEDRAL, false, {700, 1900}};
    assert_true(fabs(rcs_db(&sphere, l, at(77, -30)) - 10 * log10(pi * a * a)) < 0.01);
    assert_true(fabs(rcs_db(&plate, l, at(0, 0)) - 10 * log10(4 * pi * a * b * a * b / (l * l))) <
                0.01);
    assert_true(fabs(rcs_db(&corner, l, at(0, 0)) -
                     10 * log10(4 * pi * a * a * a * a / (3 * l * l))) < 0.01);
    assert_true(
        fabs(rcs_db(&dihedral, l, at(0, 0)) - 10 * log10(8 * pi * a * a * b * b / (l * l))) < 0.01);
}

/* "Large corner reflectors ... presenting strong returns over incident angles of roughly 45
 * degrees". */
TEST(a_corner_is_strong_over_roughly_45_degrees)
{
    const struct lm_shape corner = {LM_SHAPE_TRIHEDRAL, false, {1000, 0}};
    const double peak = rcs_db(&corner, x_band_m, at(0, 0));
    double width[2] = {0, 0};
    for (int way = 0; way < 2; way++) {
        for (double deg = -60; deg <= 60; deg += 0.1) {
            const struct ref_vector v = way == 0 ? at(deg, 0) : at(0, deg);
            width[way] += rcs_db(&corner, x_band_m, v) > peak - 3 ? 0.1 : 0;
        }
    }
    print_message("# trihedral: within 3 dB of the peak over %.1f degrees across, %.1f up\n",
                  width[0], width[1]);
    assert_true(width[0] > 35 && width[0] < 50 && width[1] > 35 && width[1] < 50);
}

/* Along a face the corner shows nothing of it. There the shared area is the difference of equal
 * numbers, which rounding makes a little less than nothing: it must not become the greatest echo of
 * all. The directions are all those within a few of the last places of the diagonal of each face.
 */
TEST(a_corner_seen_along_a_face_is_not_there)
{
    enum { NEAR = 6 };
    const struct lm_shape corner = {LM_SHAPE_TRIHEDRAL, false, {1000, 0}};
    const double peak = rcs_db(&corner, x_band_m, at(0, 0));
    /* Legs of the corner: the first two are right and left below, the third is above. */
    const double r2 = sqrt(2), r3 = sqrt(3), r6 = sqrt(6);
    const struct ref_vector leg[3] = {
        {1 / r3, 1 / r2, -1 / r6}, {1 / r3, -1 / r2, -1 / r6}, {1 / r3, 0, r2 / r3}};
    double most = -1000;
    for (int face = 0; face < 3; face++) {
        const struct ref_vector a = leg[face], b = leg[(face + 1) % 3];
        const struct lm_direction d = fixed_of((struct ref_vector){
            (a.ahead + b.ahead) / r2, (a.right + b.right) / r2, (a.up + b.up) / r2});
        for (int i = 0; i < NEAR * NEAR * NEAR; i++) {
            const struct lm_direction near = {d.ahead_q30 + i % NEAR - NEAR / 2,
                                              d.right_q30 + i / NEAR % NEAR - NEAR / 2,
                                              d.up_q30 + i / NEAR / NEAR - NEAR / 2};
            most = fmax(most, lm_rcs_dbsm_q8(&corner, 30000, near) / 256.0);
        }
    }
    print_message("# along a face: at most %.1f dB below the peak\n", peak - most);
    assert_true(most < peak - 60);
}

/* ---- the whole pattern ---- */

/* Worst difference from the reference over random directions, where the pattern is within `depth`
 * dB of the on-axis value. */
static double worst_db(const struct lm_shape *s, double wavelength_m, double depth_db,
                       double spread_deg, int *seen)
{
    struct hs_rng rng;
    double worst = 0;
    const double peak = ref_db(s, wavelength_m, at(0, 0));
    hs_rng_seed(&rng, s->kind);
    for (int i = 0; i < 5000; i++) {
        const struct ref_vector v =
            spread_deg > 90 ? random_direction(&rng) : direction_near_axis(&rng, spread_deg);
        const double expected = ref_db(s, wavelength_m, v);
        if (expected > peak - depth_db) {
            worst = fmax(worst, fabs(rcs_db(s, wavelength_m, v) - expected));
            (*seen)++;
        }
    }
    return worst;
}

TEST(every_pattern_is_within_a_hundredth_of_a_decibel_of_the_reference)
{
    static const struct {
        struct lm_shape shape;
        double spread_deg;
    } cases[] = {
        {{LM_SHAPE_SPHERE, false, {300, 0}}, 180},    {{LM_SHAPE_PLATE, false, {100, 100}}, 30},
        {{LM_SHAPE_PLATE, true, {300, 700}}, 6},      {{LM_SHAPE_PLATE, false, {3000, 3000}}, 0.6},
        {{LM_SHAPE_DIHEDRAL, false, {500, 200}}, 40}, {{LM_SHAPE_TRIHEDRAL, false, {500, 0}}, 180}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        int seen = 0;
        const double worst = worst_db(&cases[i].shape, 0.0313, 30, cases[i].spread_deg, &seen);
        print_message("# kind %d, %u mm: worst %.4f dB over %d directions\n", cases[i].shape.kind,
                      cases[i].shape.size_mm[0], worst, seen);
        assert_true(seen > 400);
        assert_true(worst < 0.01);
    }
}

TEST(a_face_answers_on_its_side_only_unless_it_has_two)
{
    struct lm_shape plate = {LM_SHAPE_PLATE, false, {300, 300}};
    const double front = rcs_db(&plate, x_band_m, at(1, 1));
    assert_true(rcs_db(&plate, x_band_m, at(181, 1)) <= LM_RCS_NONE_DBSM_Q8 / 256.0);
    plate.is_two_sided = true;
    assert_true(fabs(rcs_db(&plate, x_band_m, at(181, 1)) - front) < 0.01);
    for (int kind = LM_SHAPE_DIHEDRAL; kind <= LM_SHAPE_TRIHEDRAL; kind++) {
        const struct lm_shape corner = {(uint8_t)kind, false, {300, 300}};
        assert_true(rcs_db(&corner, x_band_m, at(180, 0)) <= LM_RCS_NONE_DBSM_Q8 / 256.0);
        assert_true(rcs_db(&corner, x_band_m, at(90, 0)) <= LM_RCS_NONE_DBSM_Q8 / 256.0);
    }
}

/* The largest and smallest of everything: what does not overflow comes out right. */
TEST(the_limits_of_size_and_wavelength_are_inside_the_arithmetic)
{
    const uint32_t sizes[] = {1, LM_SHAPE_SIZE_MAX_MM};
    const uint32_t waves[] = {LM_WAVELENGTH_MIN_UM, LM_WAVELENGTH_MAX_UM};
    const int32_t one = 1 << 30;
    for (uint32_t i = 0; i < 4 * LM_SHAPE_KINDS; i++) {
        const uint8_t kind = (uint8_t)(i / 4);
        const struct lm_shape s = {kind, true, {sizes[i & 1], sizes[i & 1]}};
        const uint32_t wave = waves[i >> 1 & 1];
        const struct lm_direction dirs[] = {{one, 0, 0},  {-one, 0, 0}, {0, one, 0},
                                            {0, 0, -one}, {0, 0, one},  {one - 1, 46340, 0}};
        for (size_t d = 0; d < sizeof dirs / sizeof dirs[0]; d++) {
            const int32_t q8 = lm_rcs_dbsm_q8(&s, wave, dirs[d]);
            assert_in_range(q8 - LM_RCS_NONE_DBSM_Q8, 0, 300 * 256);
        }
        const double area = s.size_mm[0] * 1e-3 * s.size_mm[0] * 1e-3;
        if (kind == LM_SHAPE_PLATE) {
            const double expected = 10 * log10(4 * pi * area * area / (wave * 1e-6 * wave * 1e-6));
            const double found = lm_rcs_dbsm_q8(&s, wave, dirs[0]) / 256.0;
            assert_true(fabs(found - fmax(expected, -100)) < 0.01);
        }
    }
}
