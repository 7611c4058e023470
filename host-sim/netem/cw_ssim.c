/* CW-SSIM: see score.h. Only the one level of the pyramid that counts is made, by multiplying the
 * spectrum with all its filters at once and keeping the middle of it. */
#include "hs/error.h"
#include "netem/score.h"

#include <fftw3.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { ORIENTATIONS = 8, WINDOW = 7, BAND_MIN = 16 };

static const double pi = 3.14159265358979323846;

struct band {
    int side, level;
    fftw_complex *spectrum, *values; /* owned; side x side */
    fftw_plan plan;
};

/* Halve as often as at least BAND_MIN pixels are left, as the pyramid does: rounding up. */
static void choose_level(int side, struct band *b)
{
    *b = (struct band){.side = side, .level = 1};
    while ((b->side + 1) / 2 >= BAND_MIN) {
        b->side = (b->side + 1) / 2;
        b->level++;
    }
}

/* The raised cosine in the logarithm of the frequency, an octave wide below `octave` = 0, and what
 * it leaves. */
static double high_pass(double octave)
{
    return octave >= 0 ? 1 : octave <= -1 ? 0 : cos(pi / 2 * octave);
}

static double low_pass(double octave)
{
    return octave >= 0 ? 0 : octave <= -1 ? 1 : -sin(pi / 2 * octave);
}

/* The lobe of one orientation on one side of the frequency plane: analytic, therefore complex. */
static double angle_pass(double angle, int orientation)
{
    const double c = cos(angle - pi * orientation / ORIENTATIONS);
    return c > 0 ? pow(c, ORIENTATIONS - 1) : 0;
}

static double filter(int kx, int ky, int side, int level, int orientation)
{
    if (kx == 0 && ky == 0) {
        return 0;
    }
    const double octave = log2(2 * hypot(kx, ky) / side);
    double pass = high_pass(octave + level);
    for (int l = 0; l < level; l++) {
        pass *= low_pass(octave + l);
    }
    return pass > 0 ? pass * angle_pass(atan2(ky, kx), orientation) : 0;
}

/* From the full spectrum to one band's values. */
static void make_band(const fftw_complex *full, int side, const struct band *b, int orientation,
                      fftw_complex *values)
{
    const int n = b->side;
    for (int i = 0; i < n * n; i++) {
        const int ky = (i / n + n / 2) % n - n / 2, kx = (i % n + n / 2) % n - n / 2;
        const double *from = full[(ky + side) % side * side + (kx + side) % side];
        const double pass = filter(kx, ky, side, b->level, orientation);
        b->spectrum[i][0] = pass * from[0];
        b->spectrum[i][1] = pass * from[1];
    }
    fftw_execute(b->plan);
    memcpy(values, b->values, (size_t)n * (size_t)n * sizeof *values);
}

static double window_index(const fftw_complex *a, const fftw_complex *b, int side)
{
    double re = 0, im = 0, power = 0;
    for (int i = 0; i < WINDOW * WINDOW; i++) {
        const double *p = a[i / WINDOW * side + i % WINDOW], *q = b[i / WINDOW * side + i % WINDOW];
        re += p[0] * q[0] + p[1] * q[1];
        im += p[1] * q[0] - p[0] * q[1];
        power += p[0] * p[0] + p[1] * p[1] + q[0] * q[0] + q[1] * q[1];
    }
    return power > 0 ? 2 * hypot(re, im) / power : 1;
}

static double band_index(const fftw_complex *a, const fftw_complex *b, int side)
{
    const int places = side - WINDOW + 1;
    const double middle = (places - 1) / 2.0, width = side / 4.0;
    double sum = 0, weights = 0;
    for (int y = 0; y < places; y++) {
        for (int x = 0; x < places; x++) {
            const double square = (x - middle) * (x - middle) + (y - middle) * (y - middle);
            const double weight = exp(-square / (2 * width * width));
            sum += weight * window_index(a + y * side + x, b + y * side + x, side);
            weights += weight;
        }
    }
    return sum / weights;
}

static void transform(const double *picture, int side, fftw_complex *full)
{
    fftw_plan plan = fftw_plan_dft_2d(side, side, full, full, FFTW_FORWARD, FFTW_ESTIMATE);
    for (int i = 0; i < side * side; i++) {
        full[i][0] = picture[i];
        full[i][1] = 0;
    }
    fftw_execute(plan);
    fftw_destroy_plan(plan);
}

int nm_score_cw_ssim(const double *a, const double *b, int side, double *score)
{
    struct band band;
    choose_level(side, &band);
    const size_t full = (size_t)side * (size_t)side, small = (size_t)band.side * (size_t)band.side;
    fftw_complex *all = fftw_alloc_complex(2 * full + 4 * small);
    if (!all) {
        return hs_error("score", "use smaller pictures", "out of memory");
    }
    fftw_complex *spectra[2] = {all, all + full}, *values[2];
    band.spectrum = all + 2 * full;
    band.values = band.spectrum + small;
    values[0] = band.values + small;
    values[1] = values[0] + small;
    band.plan = fftw_plan_dft_2d(band.side, band.side, band.spectrum, band.values, FFTW_BACKWARD,
                                 FFTW_ESTIMATE);
    transform(a, side, spectra[0]);
    transform(b, side, spectra[1]);
    double sum = 0;
    for (int o = 0; o < ORIENTATIONS; o++) {
        for (int i = 0; i < 2; i++) {
            make_band(spectra[i], side, &band, o, values[i]);
        }
        sum +=
            band_index((const fftw_complex *)values[0], (const fftw_complex *)values[1], band.side);
    }
    *score = sum / ORIENTATIONS;
    fftw_destroy_plan(band.plan);
    fftw_free(all);
    return 0;
}
