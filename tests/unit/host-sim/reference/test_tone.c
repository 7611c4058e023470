/* Speckle and tone of the reference, against the theory of the Gamma distribution. */
#include "check.h"
#include "reference/reference.h"

#include <math.h>

static const unsigned looks[] = {1, 2, 4, 8, 16};
enum { LOOKS = 5 };

TEST(speckle_has_mean_one_and_the_spread_of_its_looks)
{
    for (int i = 0; i < LOOKS; i++) {
        double table_db[REF_SPECKLE_SLICES], sum = 0, squares = 0;
        ref_speckle_table(looks[i], table_db);
        for (int k = 0; k < REF_SPECKLE_SLICES; k++) {
            const double power = pow(10, table_db[k] / 10);
            sum += power / REF_SPECKLE_SLICES;
            squares += power * power / REF_SPECKLE_SLICES;
        }
        assert_true(fabs(sum - 1) < 1e-9);
        const double theory = 1 / sqrt(looks[i]);
        assert_true(fabs(sqrt(squares - sum * sum) / theory - 1) < 0.01);
    }
}

/* Standard deviation of a Gamma variable of L looks in decibels, 10 / ln 10 times the root of the
 * trigamma function of L. */
TEST(speckle_in_decibels_has_the_published_spread)
{
    const double published_db[LOOKS] = {5.57, 3.49, 2.31, 1.58, 1.10};
    for (int i = 0; i < LOOKS; i++) {
        double table_db[REF_SPECKLE_SLICES], sum = 0, squares = 0;
        ref_speckle_table(looks[i], table_db);
        for (int k = 0; k < REF_SPECKLE_SLICES; k++) {
            sum += table_db[k] / REF_SPECKLE_SLICES;
            squares += table_db[k] * table_db[k] / REF_SPECKLE_SLICES;
        }
        assert_true(fabs(sqrt(squares - sum * sum) - published_db[i]) < 0.01 * published_db[i]);
    }
}

/* One look is exponential: slices end at -ln(1 - p), and the share of the mean below x is
 * 1 - (1 + x) exp(-x). */
TEST(slices_of_one_look_are_those_of_the_exponential)
{
    double table_db[REF_SPECKLE_SLICES];
    ref_speckle_table(1, table_db);
    double below = 0;
    for (int k = 0; k < REF_SPECKLE_SLICES - 1; k++) {
        const double end = -log1p(-(k + 1.0) / REF_SPECKLE_SLICES);
        const double share = 1 - (1 + end) * exp(-end);
        const double mean = (share - below) * REF_SPECKLE_SLICES;
        assert_true(fabs(table_db[k] - 10 * log10(mean)) < 1e-5);
        below = share;
    }
    const double last = table_db[REF_SPECKLE_SLICES - 1];
    assert_true(fabs(last - 10 * log10((1 - below) * REF_SPECKLE_SLICES)) < 1e-5);
}

TEST(speckle_rises_from_slice_to_slice)
{
    for (int i = 0; i < LOOKS; i++) {
        double table_db[REF_SPECKLE_SLICES];
        ref_speckle_table(looks[i], table_db);
        for (int k = 1; k < REF_SPECKLE_SLICES; k++) {
            assert_true(table_db[k] > table_db[k - 1]);
        }
    }
}

/* Every cell draws by itself: of 4096 pairs, four share a slice by chance. */
TEST(cells_columns_and_epochs_draw_by_themselves)
{
    int same[3] = {0};
    for (uint32_t n = 0; n < 4096; n++) {
        const uint32_t column = n / 64, cell = n % 64;
        const unsigned slice = ref_draw(LM_NOISE_RECEIVER, column, cell, 5);
        assert_true(slice < REF_SPECKLE_SLICES);
        assert_int_equal(slice, ref_draw(LM_NOISE_RECEIVER, column, cell, 5));
        same[0] += slice == ref_draw(LM_NOISE_RECEIVER, column, cell + 1, 5);
        same[1] += slice == ref_draw(LM_NOISE_RECEIVER, column + 1, cell, 5);
        same[2] += slice == ref_draw(LM_NOISE_RECEIVER, column, cell, 6);
    }
    for (int i = 0; i < 3; i++) {
        assert_in_range(same[i], 0, 20);
    }
}

TEST(noise_adds_to_the_power_before_speckle)
{
    double table_db[REF_GRAIN_VALUES];
    ref_grain_table(4, table_db);
    struct ref_bin bins[2] = {{.is_lit = false, .grain = -70},
                              {.is_lit = true, .level_db = -45, .grain = 100}};
    ref_speckle(bins, 2, table_db, -45);
    assert_true(fabs(bins[0].echo_db - (-45 + table_db[58])) < 1e-12);
    assert_true(fabs(bins[1].echo_db - (-45 + 10 * log10(2) + table_db[228])) < 1e-12);
}

TEST(tone_rises_from_black_to_white)
{
    struct ref_params params = ref_params_default();
    const double exponents[] = {0.4, 1, 2.2};
    for (int i = 0; i < 3; i++) {
        params.gamma_exponent = exponents[i];
        uint8_t before = 0;
        assert_int_equal(ref_grey(ref_brightness(params.black_db - 30, &params), &params), 0);
        assert_int_equal(ref_grey(ref_brightness(params.white_db + 30, &params), &params), 255);
        for (double db = params.black_db; db <= params.white_db; db += 1.0 / 256) {
            const uint8_t grey = ref_grey(ref_brightness(db, &params), &params);
            assert_true(grey >= before);
            before = grey;
        }
        assert_int_equal(before, 255);
        const double middle = (params.black_db + params.white_db) / 2;
        assert_int_equal(ref_grey(ref_brightness(middle, &params), &params),
                         lround(255 * pow(0.5, exponents[i])));
    }
}
