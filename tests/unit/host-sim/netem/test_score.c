/* The scores beside other people's implementations, and the identities of their definitions. */
#include "check.h"
#include "hs/rng.h"
#include "netem/score.h"
#include "netem/speckle.h"
#include "tracer/pix.h"

#include <math.h>
#include <stdlib.h>

enum { LARGEST = 128 };

/* Two pictures that are alike and not equal. */
static void make_pair(double *a, double *b, int side)
{
    for (int i = 0; i < side * side; i++) {
        const double x = i % side, y = i / side;
        const double dy = y - 0.6 * side, da = x - 0.4 * side, db = x - 0.45 * side;
        a[i] = 0.5 + 0.3 * sin(0.37 * x + 0.11 * y) * cos(0.23 * y) +
               0.2 * exp(-(da * da + dy * dy) / 18);
        b[i] = 0.45 + 0.25 * sin(0.37 * x + 0.11 * y + 0.8) * cos(0.21 * y) +
               0.3 * exp(-(db * db + dy * dy) / 30);
    }
}

static void shift_right(const double *a, double *b, int side)
{
    for (int i = 0; i < side * side; i++) {
        b[i] = a[i / side * side + (i % side + side - 1) % side];
    }
}

/* Reference values: scikit-image 0.19.3, structural_similarity with gaussian_weights, sigma 1.5, no
 * sample covariance, range 1; and the steerable pyramid of T. Runia's PyTorchSteerablePyramid (the
 * NumPy class, 8 bands) with the sums of Sampat's eq. 9 by scipy.signal.convolve2d. That pyramid
 * looks its filters up in tables, hence 1e-4. */
TEST(the_scores_agree_with_other_peoples_programs)
{
    static const struct {
        int side;
        double cw_ssim, shifted, ssim, mse;
    } known[] = {
        {54, 0.823256757, 0.993763209, 0.596837747, 0.020505467},
        {64, 0.885459924, 0.996363491, 0.562271944, 0.021070998},
        {128, 0.573724827, 0.996700331, 0.288794782, 0.035825735},
    };
    static double a[LARGEST * LARGEST], b[LARGEST * LARGEST];
    for (int i = 0; i < 3; i++) {
        struct nm_score s;
        double shifted;
        make_pair(a, b, known[i].side);
        assert_int_equal(nm_score(a, b, known[i].side, &s), 0);
        assert_true(fabs(s.cw_ssim - known[i].cw_ssim) < 1e-4);
        assert_true(fabs(s.ssim - known[i].ssim) < 1e-8);
        assert_true(fabs(s.mse - known[i].mse) < 1e-8);
        shift_right(a, b, known[i].side);
        assert_int_equal(nm_score_cw_ssim(a, b, known[i].side, &shifted), 0);
        assert_true(fabs(shifted - known[i].shifted) < 1e-4);
    }
}

TEST(equal_pictures_score_one_and_the_order_does_not_matter)
{
    static double a[64 * 64], b[64 * 64];
    struct nm_score ab, ba, aa;
    make_pair(a, b, 64);
    nm_score(a, b, 64, &ab);
    nm_score(b, a, 64, &ba);
    nm_score(a, a, 64, &aa);
    assert_true(fabs(aa.cw_ssim - 1) < 1e-12 && fabs(aa.ssim - 1) < 1e-12 && aa.mse == 0);
    assert_true(fabs(ab.cw_ssim - ba.cw_ssim) < 1e-12 && fabs(ab.ssim - ba.ssim) < 1e-12);
}

/* |c| of a sum of 49 unrelated complex products is about 1 / sqrt(49) of the sum of their sizes. */
TEST(unrelated_noise_scores_little)
{
    static double a[128 * 128], b[128 * 128];
    struct hs_rng rng;
    hs_rng_seed(&rng, 1);
    for (int i = 0; i < 128 * 128; i++) {
        a[i] = hs_rng_uniform(&rng);
        b[i] = hs_rng_uniform(&rng);
    }
    struct nm_score s;
    nm_score(a, b, 128, &s);
    assert_true(s.cw_ssim > 0.05 && s.cw_ssim < 0.4);
    assert_true(fabs(s.ssim) < 0.05);
    assert_true(fabs(s.mse - 1.0 / 6) < 0.01);
}

/* With K = 0 a change of brightness of one picture only counts as 2 g / (1 + g^2). */
TEST(cw_ssim_sees_contrast_as_its_formula_says)
{
    static double a[64 * 64], b[64 * 64];
    make_pair(a, b, 64);
    for (int i = 0; i < 64 * 64; i++) {
        b[i] = 0.5 * a[i] + 0.2;
    }
    double score;
    assert_int_equal(nm_score_cw_ssim(a, b, 64, &score), 0);
    assert_true(fabs(score - 2 * 0.5 / 1.25) < 1e-9);
}

/* Power of one look is exponential, and that of neighbours goes together as the square of the
 * response's autocorrelation: fields are Gaussian. */
TEST(speckle_has_the_grain_of_the_response)
{
    enum { SIDE_PX = 256, APERTURE = 84 };
    double line[PIX_KERNEL_SIDE], energy = 0, lag = 0, sum = 0, square = 0, along = 0, up = 0;
    struct hs_rng rng;
    double *pixels = malloc(SIDE_PX * SIDE_PX * sizeof *pixels);
    hs_rng_seed(&rng, 4);
    pix_taylor(APERTURE, line);
    for (int i = 0; i < PIX_KERNEL_SIDE; i++) {
        energy += line[i] * line[i];
        lag += i > 0 ? line[i] * line[i - 1] : 0;
    }
    for (int i = 0; i < SIDE_PX * SIDE_PX; i++) {
        pixels[i] = 1e-3;
    }
    assert_int_equal(nm_speckle(pixels, SIDE_PX, APERTURE, 1, &rng), 0);
    for (int i = 0; i < SIDE_PX * SIDE_PX; i++) {
        pixels[i] = pixels[i] * pixels[i] / 1e-6;
        sum += pixels[i] / (SIDE_PX * SIDE_PX);
    }
    for (int i = 0; i < SIDE_PX * (SIDE_PX - 1) - 1; i++) {
        const double p = pixels[i] - sum;
        square += p * p;
        along += p * (pixels[i + 1] - sum);
        up += p * (pixels[i + SIDE_PX] - sum);
    }
    const double expected = lag / energy * (lag / energy);
    assert_true(expected > 0.1);
    assert_true(fabs(sum - 1) < 0.02);
    assert_true(fabs(sqrt(square / (SIDE_PX * (SIDE_PX - 1) - 1)) / sum - 1) < 0.03);
    assert_true(fabs(along / square - expected) < 0.03);
    assert_true(fabs(up / square - expected) < 0.03);
    free(pixels);
}
