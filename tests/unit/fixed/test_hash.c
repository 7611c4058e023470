/* The noise: does the hash look like random numbers where the picture would show that it is none?
 * Limits are given in standard deviations of true randomness. */
#include "check.h"
#include "fx/hash.h"
#include "hs/rng.h"

#include <math.h>
#include <stdlib.h>

enum { LOWEST_OF_HASH3 = 12 }; /* the bits that fx_hash3 promises are this and those above it */

/* The largest distance from one half, over input bits and output bits, of the chance that an output
 * bit flips with an input bit. `which` is the input (0..2) that is flipped. Inputs are as small as
 * the ones of a picture. */
static double worst_avalanche(int which)
{
    enum { SAMPLES = 1 << 14 };
    struct hs_rng rng;
    hs_rng_seed(&rng, 1);
    static int flips[32][32];
    for (int i = 0; i < 32 * 32; i++) {
        flips[i / 32][i % 32] = 0;
    }
    for (int sample = 0; sample < SAMPLES; sample++) {
        const uint32_t in[3] = {hs_rng_below(&rng, 1 << 20), hs_rng_below(&rng, 1 << 20),
                                hs_rng_below(&rng, 1 << 10)};
        for (int bit = 0; bit < 32; bit++) {
            uint32_t changed[3] = {in[0], in[1], in[2]};
            changed[which] ^= 1u << bit;
            const uint32_t differ =
                fx_hash3(in[0], in[1], in[2]) ^ fx_hash3(changed[0], changed[1], changed[2]);
            for (int out = 0; out < 32; out++) {
                flips[bit][out] += (int)(differ >> out & 1u);
            }
        }
    }
    double worst = 0;
    for (int bit = 0; bit < 32; bit++) {
        for (int out = LOWEST_OF_HASH3; out < 32; out++) {
            worst = fmax(worst, fabs((double)flips[bit][out] / SAMPLES - 0.5));
        }
    }
    return worst;
}

/* One standard deviation of 2^14 coins is 0.0039; the largest of 1024 such is about 0.013. */
TEST(each_input_bit_flips_each_output_bit_half_of_the_time)
{
    for (int which = 0; which < 3; which++) {
        const double worst = worst_avalanche(which);
        print_message("# avalanche, input %d: worst bias %.4f\n", which, worst);
        assert_true(worst < 0.03);
    }
}

/* Pearson's statistic of the byte at `shift` over 256 x 256 cells: 255 expected, deviation 22.6. */
static double chi_square(uint32_t epoch, int shift)
{
    int count[256] = {0};
    for (uint32_t cell = 0; cell < 65536; cell++) {
        count[fx_hash3(cell & 255u, cell >> 8, epoch) >> shift & 255u]++;
    }
    double sum = 0;
    for (int i = 0; i < 256; i++) {
        sum += (count[i] - 256.0) * (count[i] - 256.0) / 256.0;
    }
    return sum;
}

TEST(every_byte_is_uniform_over_a_grid_of_cells_at_each_epoch)
{
    double total = 0;
    for (uint32_t epoch = 0; epoch < 32; epoch++) {
        for (int shift = 0; shift < 32; shift += 8) {
            const double statistic = chi_square(epoch, shift);
            assert_true(fabs(statistic - 255) < 5 * 22.6);
            total += statistic;
        }
    }
    /* 128 statistics: their mean has a deviation of 2. */
    print_message("# uniformity: mean chi-square %.1f of 255\n", total / 128);
    assert_true(fabs(total / 128 - 255) < 10);
}

static double centred(uint32_t column, uint32_t row, uint32_t epoch)
{
    return fx_hash3(column, row, epoch) / 4294967296.0 - 0.5;
}

/* Correlation of the noise with itself some cells and looks further, in standard deviations. */
static double correlation(uint32_t columns, uint32_t rows, uint32_t epochs)
{
    enum { SIDE = 256 };
    double sum = 0;
    for (uint32_t cell = 0; cell < SIDE * SIDE; cell++) {
        const uint32_t column = 3000 + cell % SIDE, row = 1000 + cell / SIDE;
        sum += centred(column, row, 7) * centred(column + columns, row + rows, 7 + epochs);
    }
    return sum * 12 / SIDE; /* a product has deviation 1/12, and there are SIDE^2 of them */
}

TEST(neighbouring_cells_rows_and_epochs_are_uncorrelated)
{
    double worst = 0, squares = 0;
    int pairs = 0;
    for (uint32_t rows = 0; rows <= 8; rows++) {
        for (uint32_t columns = 0; columns <= 8; columns++) {
            for (uint32_t epochs = 0; epochs <= 2; epochs++) {
                if (rows + columns + epochs > 0) {
                    const double deviations = correlation(columns, rows, epochs);
                    worst = fmax(worst, fabs(deviations));
                    squares += deviations * deviations;
                    pairs++;
                }
            }
        }
    }
    print_message("# correlation: worst %.2f, mean square %.2f deviations over %d shifts\n", worst,
                  squares / pairs, pairs);
    assert_true(worst < 4.5);
    assert_true(fabs(squares / pairs - 1) < 0.45); /* five deviations of a mean of 242 squares */
}

static int compare_u64(const void *a, const void *b)
{
    const uint64_t x = *(const uint64_t *)a, y = *(const uint64_t *)b;
    return (x > y) - (x < y);
}

/* Sorts the values and counts those that equal another. */
static int count_shared(uint64_t *values, size_t n)
{
    qsort(values, n, sizeof *values, compare_u64);
    int shared = 0;
    for (size_t i = 1; i < n; i++) {
        shared += values[i] == values[i - 1];
    }
    return shared;
}

/* A hash that merely starts each line at a random place of one long sequence, lowbias32 of
 * (b + start), would overlap in about four pairs of these 8192 lines. Two values in a row are 64
 * bits, which none of 2^21 places shares by chance. */
TEST(no_line_is_a_shifted_copy_of_another_line_or_look)
{
    enum { CELLS = 1 << 21 };
    uint64_t *values = malloc(CELLS * sizeof *values);
    assert_non_null(values);
    for (uint32_t cell = 0; cell < CELLS; cell++) {
        const uint32_t column = cell & 255u, row = cell >> 8 & 1023u, look = cell >> 18;
        values[cell] =
            (uint64_t)fx_hash3(row, column, look) << 32 | fx_hash3(row, column + 1, look);
    }
    const int shared = count_shared(values, CELLS);
    free(values);
    assert_int_equal(shared, 0);
}

/* 2^20 values of 32 bits would share 128 by chance. */
TEST(no_two_cells_of_a_few_looks_share_a_value)
{
    enum { CELLS = 1 << 20 };
    uint64_t *values = malloc(CELLS * sizeof *values);
    assert_non_null(values);
    for (uint32_t cell = 0; cell < CELLS; cell++) {
        values[cell] = fx_hash3(cell >> 9 & 511u, cell & 511u, cell >> 18);
    }
    const int shared = count_shared(values, CELLS);
    free(values);
    assert_int_equal(shared, 0);
}
