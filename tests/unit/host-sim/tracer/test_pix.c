/* Impulse response, pixels and speckle. */
#include "check.h"
#include "support.h"
#include "tracer/pix.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SIDE = PIX_KERNEL_SIDE, MIDDLE = SIDE / 2 };

/* A system's published response: the same to the last digit, 72 samples of window in 107. */
TEST(the_taylor_response_is_the_published_one)
{
    char path[512];
    if (!support_data_path("slicy/Impt108.csv", path, sizeof path)) {
        skip();
    }
    double response[SIDE];
    static double published[SIDE][SIDE];
    FILE *in = fopen(path, "r");
    assert_non_null(in);
    for (int i = 0; i < SIDE * SIDE; i++) {
        assert_int_equal(fscanf(in, "%lf%*[,\n\r]", &published[i / SIDE][i % SIDE]), 1);
    }
    fclose(in);
    pix_taylor(72, response);
    const double peak = published[MIDDLE][MIDDLE];
    for (int i = 0; i < SIDE; i++) {
        for (int k = 0; k < SIDE; k++) {
            assert_true(fabs(published[i][k] / peak - response[i] * response[k]) < 1e-12);
        }
    }
}

static double db(double ratio)
{
    return 20 * log10(ratio);
}

/* What that response is known for: nulls every third sample, a first side lobe of -35.6 dB, 2.51
 * samples wide at half its height. */
TEST(the_response_has_its_nulls_side_lobe_and_width)
{
    double response[SIDE];
    pix_taylor(72, response);
    const double *h = response + MIDDLE;
    for (int i = 6; i < 24; i += 3) {
        assert_true(h[i] < h[i - 1] && h[i] < h[i + 1]);
    }
    assert_true(fabs(db(h[4]) + 35.6) < 0.05);
    assert_true(h[1] > 0.5 && h[2] < 0.5);
    const double half = 1 + (h[1] - 0.5) / (h[1] - h[2]);
    assert_true(fabs(2 * half - 2.51) < 0.01);
    for (int i = 1; i <= MIDDLE; i++) {
        assert_true(fabs(h[i] - h[-i]) < 1e-12);
    }
}

/* Widths between -3 dB points by interpolation, for resolutions that samples of 0.1 m can show. */
TEST(the_response_is_as_wide_as_asked)
{
    for (double width = 0.25; width < 1; width += 0.05) {
        double response[SIDE];
        pix_taylor(pix_aperture(width, 0.1), response);
        const double *h = response + MIDDLE, level = sqrt(0.5);
        int i = 0;
        while (h[i + 1] > level) {
            i++;
        }
        /* A parabola through the squares is closer than a line at the top of the lobe. */
        const double part = (h[i] - level) / (h[i] - h[i + 1]);
        assert_true(fabs(2 * (i + part) * 0.1 - width) < 0.06 * width);
    }
    assert_int_equal(pix_aperture(0.3, 0.1), 42);
}

TEST(spreading_keeps_the_power_and_the_place)
{
    enum { WIDTH = 240, HEIGHT = 220 };
    float *power = calloc(WIDTH * HEIGHT, sizeof *power);
    power[100 * WIDTH + 130] = 5;
    assert_int_equal(pix_spread(power, WIDTH, HEIGHT, 42), 0);
    double sum = 0, x = 0, y = 0;
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        sum += (double)power[i];
        x += (double)power[i] * (i % WIDTH);
        y += (double)power[i] * (i / WIDTH);
    }
    assert_true(fabs(sum - 5) < 1e-4);
    assert_true(fabs(x / sum - 130) < 1e-3 && fabs(y / sum - 100) < 1e-3);
    /* Power, not amplitude: the response squared. */
    double response[SIDE];
    pix_taylor(42, response);
    const double ratio = (double)power[100 * WIDTH + 134] / (double)power[100 * WIDTH + 130];
    assert_true(fabs(ratio - pow(response[MIDDLE + 4], 2)) < 1e-5);
    free(power);
}

TEST(level_ground_stays_level_to_the_edge)
{
    float power[60 * 90];
    for (int i = 0; i < 60 * 90; i++) {
        power[i] = 3;
    }
    assert_int_equal(pix_spread(power, 60, 90, 42), 0);
    for (int i = 0; i < 60 * 90; i++) {
        assert_true(fabsf(power[i] - 3) < 1e-4f);
    }
}

TEST(pixels_are_means_of_their_cells)
{
    const float cells[4 * 6] = {1, 2, 3, 4, 5, 6, 7,  8,  9,  10, 11, 12,
                                0, 0, 1, 1, 2, 2, 10, 10, 20, 20, 30, 30};
    float pixels[6];
    pix_coarsen(cells, 6, 4, 2, pixels);
    const float expected[6] = {4.5f, 6.5f, 8.5f, 5, 10.5f, 16};
    assert_memory_equal(pixels, expected, sizeof expected);
}

/* Intensity of L looks: mean 1 and variance 1 / L; of one look the chance to exceed x is exp(-x).
 */
TEST(speckle_has_the_statistics_of_its_looks)
{
    enum { COUNT = 200000 };
    float *power = malloc(COUNT * sizeof *power);
    for (int looks = 1; looks <= 16; looks *= 4) {
        struct hs_rng rng;
        hs_rng_seed(&rng, 7);
        double sum = 0, squares = 0, above = 0;
        for (int i = 0; i < COUNT; i++) {
            power[i] = 1;
        }
        pix_speckle(power, COUNT, looks, &rng);
        for (int i = 0; i < COUNT; i++) {
            sum += (double)power[i];
            squares += (double)power[i] * (double)power[i];
            above += power[i] > 2;
        }
        const double mean = sum / COUNT, variance = squares / COUNT - mean * mean;
        assert_true(fabs(mean - 1) < 4 / sqrt(COUNT * looks));
        assert_true(fabs(variance * looks - 1) < 0.03);
        assert_true(looks > 1 || fabs(above / COUNT - exp(-2)) < 0.004);
    }
    free(power);
}
