/* Draws of the receiver's noise against the statistics of a Gamma distribution. */
#include "check.h"
#include "lm/noise.h"

#include <math.h>
#include <stdlib.h>

enum { SIDE = 256 };

/* Slices that the cells of SIDE lines draw, each line a column by itself. */
static void fill_slices(uint32_t slice[SIDE][SIDE], enum lm_noise_kind kind, uint32_t epoch)
{
    for (uint32_t line = 0; line < SIDE; line++) {
        const struct lm_noise_key noise_key = lm_noise_key_of(kind, line, epoch);
        for (uint32_t i = 0; i < SIDE; i++) {
            const uint32_t entry =
                lm_noise_entry(&noise_key, i / LM_NOISE_BLOCK) + i % LM_NOISE_BLOCK;
            slice[line][i] = lm_noise_slice(entry);
        }
    }
}

/* Powers after speckle of `looks_log2` on a field of 0 dB. */
static void fill_powers(double *power, uint8_t looks_log2, uint32_t epoch)
{
    for (uint32_t line = 0; line < SIDE; line++) {
        const struct lm_noise_key noise_key = lm_noise_key_of(LM_NOISE_RECEIVER, line, epoch);
        for (uint32_t i = 0; i < SIDE; i++) {
            power[line * SIDE + i] =
                pow(10, lm_noise_cell_db_q8(looks_log2, &noise_key, i) / 2560.0);
        }
    }
}

static void moments(const double *x, double *mean, double *variance)
{
    const int n = SIDE * SIDE;
    double sum = 0, squares = 0;
    for (int i = 0; i < n; i++) {
        sum += x[i];
        squares += x[i] * x[i];
    }
    *mean = sum / n;
    *variance = squares / n - *mean * *mean;
}

TEST(one_look_has_a_coefficient_of_variation_of_one)
{
    static double power[SIDE * SIDE];
    double mean, variance;
    fill_powers(power, 0, 5);
    moments(power, &mean, &variance);
    print_message("# one look: mean %.4f, CV %.4f\n", mean, sqrt(variance) / mean);
    assert_true(fabs(mean - 1) < 0.02);
    assert_true(fabs(sqrt(variance) / mean - 1) < 0.03);
}

TEST(the_equivalent_number_of_looks_is_the_number_of_looks)
{
    static double power[SIDE * SIDE];
    for (uint8_t log2 = 0; log2 <= LM_NOISE_LOOKS_LOG2_MAX; log2++) {
        double mean, variance;
        fill_powers(power, log2, 6);
        moments(power, &mean, &variance);
        const double looks = mean * mean / variance;
        print_message("# %d looks: mean %.4f, ENL %.3f\n", 1 << log2, mean, looks);
        assert_true(fabs(mean - 1) < 0.02);
        assert_true(fabs(looks / (1 << log2) - 1) < 0.1);
    }
}

/* Of the numbers of a row with those so many entries on, the first ones following the last. */
static double correlation_along(const double x[LM_NOISE_SLICES], int apart)
{
    double sum = 0, squares = 0, products = 0;
    for (int n = 0; n < LM_NOISE_SLICES; n++) {
        sum += x[n];
        squares += x[n] * x[n];
        products += x[n] * x[(n + apart) % LM_NOISE_SLICES];
    }
    const double mean = sum / LM_NOISE_SLICES;
    return (products / LM_NOISE_SLICES - mean * mean) / (squares / LM_NOISE_SLICES - mean * mean);
}

TEST(every_slice_stands_once_in_a_row_and_the_first_ones_again_behind_it)
{
    int count[LM_NOISE_SLICES] = {0};
    for (uint32_t entry = 0; entry < LM_NOISE_SLICES; entry++) {
        const uint32_t slice = lm_noise_slice(entry);
        assert_in_range(slice, 0, LM_NOISE_SLICES - 1);
        assert_int_equal(count[slice]++, 0);
    }
    for (int row = 0; row <= LM_NOISE_LOOKS_LOG2_MAX; row++) {
        int16_t sorted_q8[LM_NOISE_SLICES];
        for (uint32_t entry = 0; entry < LM_NOISE_SLICES; entry++) {
            sorted_q8[lm_noise_slice(entry)] = lm_noise_db_q8[row][entry];
        }
        for (int n = 1; n < LM_NOISE_SLICES; n++) {
            assert_true(sorted_q8[n] >= sorted_q8[n - 1]);
        }
        for (int k = 0; k < LM_NOISE_BLOCK; k++) {
            assert_int_equal(lm_noise_db_q8[row][LM_NOISE_SLICES + k], lm_noise_db_q8[row][k]);
        }
    }
}

/* The correlation that lm_noise_slice promises, of slices and of one look's powers. */
TEST(the_order_of_a_row_keeps_neighbours_independent)
{
    double slice[LM_NOISE_SLICES], power[LM_NOISE_SLICES];
    for (uint32_t entry = 0; entry < LM_NOISE_SLICES; entry++) {
        slice[entry] = lm_noise_slice(entry);
        power[entry] = pow(10, lm_noise_db_q8[0][entry] / 2560.0);
    }
    for (int apart = 1; apart < LM_NOISE_BLOCK; apart++) {
        assert_true(fabs(correlation_along(slice, apart)) < 0.0136);
        assert_true(fabs(correlation_along(power, apart)) < 0.0136);
    }
}

/* 65,536 draws into 1024 slices: chi-square has mean 1023. Its deviation is that of single draws,
 * 45, times the root of 1 + 2 (7^2 + 6^2 + .. + 1) / 8^2, which is 2.3, since eight neighbouring
 * entries come together. */
TEST(every_slice_is_drawn_equally_often)
{
    static uint32_t slice[SIDE][SIDE];
    for (uint32_t epoch = 0; epoch < 4; epoch++) {
        int count[LM_NOISE_SLICES] = {0};
        fill_slices(slice, LM_NOISE_RECEIVER, epoch);
        for (int i = 0; i < SIDE * SIDE; i++) {
            count[slice[i / SIDE][i % SIDE]]++;
        }
        double chi_square = 0;
        for (int n = 0; n < LM_NOISE_SLICES; n++) {
            chi_square += (count[n] - 64.0) * (count[n] - 64.0) / 64;
        }
        print_message("# chi-square %.0f of 1023\n", chi_square);
        assert_true(fabs(chi_square - 1023) < 4 * 45 * 2.3);
    }
}

/* Correlation of the draws of cells (line, i) of one field and (line + down, i + along) of another:
 * for independent ones its deviation is 1/256. */
static double correlation(uint32_t a[SIDE][SIDE], uint32_t b[SIDE][SIDE], int down, int along)
{
    double sum = 0;
    int n = 0;
    for (int line = 0; line + down < SIDE; line++) {
        for (int i = 0; i + along < SIDE; i++, n++) {
            sum += (a[line][i] - 511.5) * (b[line + down][i + along] - 511.5);
        }
    }
    return sum / n / (1024.0 * 1024 / 12);
}

TEST(neighbouring_cells_are_independent)
{
    static uint32_t slice[SIDE][SIDE];
    double worst = 0;
    for (uint32_t epoch = 0; epoch < 3; epoch++) {
        fill_slices(slice, LM_NOISE_RECEIVER, epoch);
        for (int down = 0; down <= 3; down++) {
            for (int along = down == 0; along <= 9; along++) {
                worst = fmax(worst, fabs(correlation(slice, slice, down, along)));
            }
        }
    }
    print_message("# neighbours correlate by %.4f at most\n", worst);
    assert_true(worst < 0.0136 + 4.0 / SIDE);
}

/* One look's powers, line by line: 256 spectra's mean has a deviation of 1/16 at each frequency. */
TEST(no_frequency_along_the_lines_stands_out)
{
    static double power[SIDE * SIDE];
    double mean, variance, most = 0, least = 2;
    fill_powers(power, 0, 11);
    moments(power, &mean, &variance);
    for (int frequency = 1; frequency < SIDE / 2; frequency++) {
        double sum = 0;
        for (int line = 0; line < SIDE; line++) {
            double re = 0, im = 0;
            for (int i = 0; i < SIDE; i++) {
                const double turn = 2 * acos(-1) * frequency * i / SIDE;
                re += (power[line * SIDE + i] - mean) * cos(turn);
                im += (power[line * SIDE + i] - mean) * sin(turn);
            }
            sum += (re * re + im * im) / (SIDE * variance) / SIDE;
        }
        most = fmax(most, sum);
        least = fmin(least, sum);
    }
    print_message("# spectrum from %.3f to %.3f\n", least, most);
    assert_true(least > 1 - 5.0 / 16 && most < 1 + 5.0 / 16);
}

TEST(epochs_know_nothing_of_each_other)
{
    static uint32_t a[SIDE][SIDE], b[SIDE][SIDE];
    fill_slices(a, LM_NOISE_RECEIVER, 7);
    fill_slices(b, LM_NOISE_RECEIVER, 8);
    assert_true(fabs(correlation(a, b, 0, 0)) < 5.0 / SIDE);
    fill_slices(b, LM_NOISE_RECEIVER, 7);
    assert_memory_equal(a, b, sizeof a);
}

TEST(lines_of_one_column_draw_alike_and_columns_may_grow_along_a_line)
{
    const struct lm_noise_key grown = {.column_q32 = ((uint64_t)70 << 32) - 1, 1, 3};
    const struct lm_noise_key before = {.column_q32 = (uint64_t)69 << 32, 0, 3};
    const struct lm_noise_key behind = {.column_q32 = (uint64_t)70 << 32, 0, 3};
    struct lm_noise_line line;
    lm_noise_line_set(&line, &grown, 64);
    assert_int_equal(line.entry[0], lm_noise_entry(&before, 0));
    for (uint32_t block = 1; block < 8; block++) {
        assert_int_equal(line.entry[block], lm_noise_entry(&behind, block));
        assert_int_equal(line.entry[block], lm_noise_entry(&grown, block));
    }
}
