/* The grain against theory: Gamma marginals of any number of looks, and the correlation of a
 * processor that weights as the point response does. docs/EQUATIONS.md, "Speckle". */
#include "check.h"
#include "hs/rng.h"
#include "lm/grain.h"
#include "lm/level.h"
#include "reference/reference.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SIDE = 256 };

/* Powers of an even field of SIDE x SIDE cells, as a patch draws it. */
static void fill_powers(double power[SIDE][SIDE], double looks, uint32_t epoch)
{
    struct lm_grain_curve curve;
    struct lm_grain_place place = lm_grain_start(LM_GRAIN_SPECKLE, epoch);
    lm_grain_curve_set(&curve, (uint32_t)lround(looks * 256));
    for (int row = 0; row < SIDE; row++, place.row++) {
        int16_t level_q8[SIDE] = {0};
        lm_grain_run(&curve, place, level_q8, SIDE);
        for (int i = 0; i < SIDE; i++) {
            power[row][i] = pow(10, level_q8[i] / 2560.0);
        }
    }
}

static void moments(double x[SIDE][SIDE], double *mean, double *variance)
{
    double sum = 0, squares = 0;
    for (int i = 0; i < SIDE * SIDE; i++) {
        const double power = x[i / SIDE][i % SIDE];
        sum += power;
        squares += power * power;
    }
    *mean = sum / (SIDE * SIDE);
    *variance = squares / (SIDE * SIDE) - *mean * *mean;
}

static double correlation(double a[SIDE][SIDE], double b[SIDE][SIDE], int down, int along)
{
    double mean_a, mean_b, variance_a, variance_b, sum = 0;
    int n = 0;
    moments(a, &mean_a, &variance_a);
    moments(b, &mean_b, &variance_b);
    for (int row = 0; row + down < SIDE; row++) {
        for (int i = along < 0 ? -along : 0; i + (along > 0 ? along : 0) < SIDE; i++, n++) {
            sum += (a[row][i] - mean_a) * (b[row + down][i + along] - mean_b);
        }
    }
    return sum / n / sqrt(variance_a * variance_b);
}

static double field[SIDE][SIDE], other[SIDE][SIDE];

TEST(the_equivalent_number_of_looks_is_any_number_of_looks)
{
    for (double looks = 1; looks < 65; looks *= 1.17) {
        double mean, variance;
        fill_powers(field, looks, 6);
        moments(field, &mean, &variance);
        const double found = mean * mean / variance;
        print_message("# %.2f looks: mean %.4f, ENL %.3f\n", looks, mean, found);
        assert_true(fabs(mean - 1) < 0.01);
        assert_true(fabs(found / looks - 1) < 0.03);
    }
}

/* The greatest distance of two distribution functions. */
TEST(one_look_is_exponential)
{
    double worst = 0;
    fill_powers(field, 1, 5);
    for (double x = 0.01; x < 8; x *= 1.05) {
        int below = 0;
        for (int i = 0; i < SIDE * SIDE; i++) {
            below += field[i / SIDE][i % SIDE] < x;
        }
        worst = fmax(worst, fabs(below / (double)(SIDE * SIDE) - (1 - exp(-x))));
    }
    print_message("# distance to the exponential law: %.4f\n", worst);
    assert_true(worst < 0.01); /* a step of the field has 1/80 of it at most */
}

/* Taylor weighting, -35 dB: |0.546|^2 = 0.298 at one cell, 0.005 at two (EQUATIONS.md). */
TEST(neighbours_correlate_as_the_weighting_says)
{
    const double looks[] = {1, 2, 4, 11, 18, 64};
    for (size_t n = 0; n < sizeof looks / sizeof *looks; n++) {
        fill_powers(field, looks[n], 9);
        const double along = correlation(field, field, 0, 1),
                     down = correlation(field, field, 1, 0);
        print_message("# %.0f looks: %.3f along, %.3f down, %.3f and %.3f two away\n", looks[n],
                      along, down, correlation(field, field, 0, 2),
                      correlation(field, field, 2, 0));
        assert_true(fabs(along - 0.30) < 0.05 && fabs(down - 0.30) < 0.05);
        assert_true(fabs(correlation(field, field, 1, 1) - 0.09) < 0.04);
        assert_true(fabs(correlation(field, field, 1, -1) - 0.09) < 0.04);
        for (int away = 2; away < 12; away++) {
            assert_true(fabs(correlation(field, field, 0, away)) < 0.03);
            assert_true(fabs(correlation(field, field, away, 0)) < 0.03);
        }
    }
}

/* The field is smaller than a patch. It goes on without a seam, and its copy stands aside. */
TEST(there_is_no_seam_where_the_field_begins_again)
{
    double sum = 0, squares = 0;
    for (uint32_t i = 0; i < LM_GRAIN_COLUMNS; i++) {
        const int a = lm_grain_at((struct lm_grain_place){LM_GRAIN_ROWS - 1, i});
        const int b = lm_grain_at((struct lm_grain_place){LM_GRAIN_ROWS, i});
        sum += a * b;
        squares += (a * a + b * b) / 2.0;
    }
    assert_true(sum / squares > 0.31 - 4 / 16.0); /* 256 pairs */
    sum = squares = 0;
    for (uint32_t i = 0; i < LM_GRAIN_ROWS; i++) {
        const int a = lm_grain_at((struct lm_grain_place){i, LM_GRAIN_COLUMNS - 1});
        const int b = lm_grain_at((struct lm_grain_place){i, LM_GRAIN_COLUMNS});
        sum += a * b;
        squares += (a * a + b * b) / 2.0;
    }
    assert_true(sum / squares > 0.31 - 4 / 11.3);
}

TEST(a_patch_does_not_repeat_itself)
{
    fill_powers(field, 4, 3);
    const int down = LM_GRAIN_ROWS;
    for (int aside = -3; aside <= 3; aside++) {
        assert_true(fabs(correlation(field, field, down, aside)) < 0.04);
    }
    /* The copy is where lm/grain.h says. */
    assert_true(field[down][0] == field[0][LM_GRAIN_TWIST]);
}

TEST(epochs_and_uses_know_nothing_of_each_other)
{
    struct lm_grain_place a = lm_grain_start(LM_GRAIN_SPECKLE, 7);
    const struct lm_grain_place b = lm_grain_start(LM_GRAIN_NOISE, 7);
    assert_true(a.row != b.row || a.column != b.column);
    fill_powers(field, 4, 7);
    for (uint32_t epoch = 8; epoch < 40; epoch++) {
        fill_powers(other, 4, epoch);
        assert_true(fabs(correlation(field, other, 0, 0)) < 0.05);
    }
    fill_powers(other, 4, 7);
    assert_memory_equal(field, other, sizeof field);
}

/* Of the number of the field, the speckle by its definition. */
TEST(curves_are_the_quantiles_of_gamma_variables)
{
    for (double looks = 1; looks < 65; looks *= 1.31) {
        struct lm_grain_curve curve;
        double worst_db = 0, worst_far_db = 0;
        lm_grain_curve_set(&curve, (uint32_t)lround(looks * 256));
        for (int grain = -128; grain < 128; grain++) {
            const double wanted_db = ref_grain_db((double)lround(looks * 256) / 256, grain / 32.0);
            const double off_db = fabs(lm_grain_db_q8(&curve, (int8_t)grain) / 256.0 - wanted_db);
            /* Beyond three deviations there are 2.7 of 1000. */
            double *worst = abs(grain) > 96 ? &worst_far_db : &worst_db;
            *worst = fmax(*worst, off_db);
        }
        print_message("# %.2f looks: off by %.3f dB at most, in the tails %.3f\n", looks, worst_db,
                      worst_far_db);
        assert_true(worst_db < 0.2);
        assert_true(worst_far_db < 0.3);
    }
}

TEST(every_cell_gains_the_speckle_of_its_place)
{
    for (uint32_t row = 0; row < 300; row++) {
        const struct lm_grain_place place = {row * 77, row * 1001};
        struct lm_grain_curve curve;
        int16_t level[48], over_nothing[48], none[48];
        lm_grain_curve_set(&curve, 256 + row * 50);
        for (int i = 0; i < 48; i++) {
            level[i] = none[i] = (int16_t)(1000 * i - 80 * 256);
        }
        lm_grain_run(&curve, place, level, 48);
        lm_grain_floor_run(&curve, place, -1000 * 256, none, over_nothing, 48);
        for (uint32_t i = 0; i < 48; i++) {
            const struct lm_grain_place at = {place.row, place.column + i};
            assert_int_equal(lm_grain_at(at), ref_grain(at.row, at.column));
            assert_int_equal(level[i], 1000 * (int32_t)i - 80 * 256 +
                                           lm_grain_db_q8(&curve, lm_grain_at(at)));
            assert_in_range(over_nothing[i] - level[i], 0, 1);
        }
    }
}

TEST(looks_beyond_the_table_count_as_its_ends)
{
    struct lm_grain_curve least, none, most, many;
    lm_grain_curve_set(&least, 256);
    lm_grain_curve_set(&none, 0);
    lm_grain_curve_set(&most, LM_GRAIN_LOOKS_MAX_Q8);
    lm_grain_curve_set(&many, UINT32_MAX);
    assert_memory_equal(&least, &none, sizeof least);
    assert_memory_equal(&most, &many, sizeof most);
    for (uint32_t n = 0; n < LM_GRAIN_LINES; n++) {
        assert_int_equal(least.base_db_q8[n], lm_grain_knot_db_q8[0][n]);
        assert_int_equal(most.base_db_q8[n], lm_grain_knot_db_q8[LM_GRAIN_LOOKS_ROWS - 1][n]);
        assert_in_range(least.rise_db_q8[n], 0, 4369);
    }
}

/* A level over a floor, without the speckle of the sum; *speckle_q8 gets that. */
static int32_t over_floor_q8(int32_t floor_q8, int16_t level_q8, int32_t *speckle_q8)
{
    enum { ROOM = 16 };
    const struct lm_grain_place place = {700, 2};
    struct lm_grain_curve curve;
    int16_t level[ROOM] = {level_q8}, speckled_q8[ROOM];
    lm_grain_curve_set(&curve, 1024);
    lm_grain_floor_run(&curve, place, floor_q8, level, speckled_q8, 1);
    *speckle_q8 = lm_grain_db_q8(&curve, lm_grain_at(place));
    return speckled_q8[0] - *speckle_q8;
}

TEST(the_floor_adds_as_power_to_every_level)
{
    struct hs_rng rng;
    int32_t speckle_q8;
    hs_rng_seed(&rng, 4);
    for (int n = 0; n < 20000; n++) {
        const int32_t floor_q8 = (int32_t)hs_rng_below(&rng, 40000) - 30000;
        const int16_t level_q8 = (int16_t)((int32_t)hs_rng_below(&rng, 52768) - 32768);
        const int32_t sum_q8 = over_floor_q8(floor_q8, level_q8, &speckle_q8);
        const double expected = 10 * log10(pow(10, level_q8 / 2560.0) + pow(10, floor_q8 / 2560.0));
        assert_true(fabs(sum_q8 / 256.0 - expected) < 0.018);
    }
    assert_in_range(over_floor_q8(-46 * 256, LM_LEVEL_SHADOW, &speckle_q8) + 46 * 256, 0, 1);
    /* Sum and result are held within 16 bits, one after the other. */
    const int32_t held_q8 = over_floor_q8(0, INT16_MAX, &speckle_q8);
    assert_int_equal(held_q8, INT16_MAX - (speckle_q8 > 0 ? speckle_q8 : 0));
    assert_int_equal(over_floor_q8(1 << 20, 0, &speckle_q8), held_q8);
}
