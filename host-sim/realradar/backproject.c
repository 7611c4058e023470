#include "realradar/backproject.h"

#include "hs/error.h"
#include "hs/png.h"
#include "hs/progress.h"
#include "hs/taylor.h"

#include <fftw3.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { OVERSAMPLING = 16, TAYLOR_N_BAR = 5 };

static const double pi = 3.14159265358979323846;

static int bins_for(int frequencies)
{
    int bins = 1;
    while (bins < OVERSAMPLING * frequencies) {
        bins *= 2;
    }
    return bins;
}

static int profiles_alloc(struct rr_profiles *p, const struct rr_phase_history *ph)
{
    const size_t pulses = (size_t)ph->pulses;
    *p = (struct rr_profiles){.bins = bins_for(ph->frequencies), .pulses = ph->pulses};
    p->value = calloc(pulses * (size_t)p->bins, sizeof *p->value);
    p->antenna = malloc(pulses * sizeof *p->antenna);
    p->reference_m = malloc(pulses * sizeof *p->reference_m);
    if (!p->value || !p->antenna || !p->reference_m) {
        rr_profiles_free(p);
        return hs_error("range compression", NULL, "out of memory");
    }
    memcpy(p->antenna, ph->antenna, pulses * sizeof *p->antenna);
    memcpy(p->reference_m, ph->reference_m, pulses * sizeof *p->reference_m);
    return 0;
}

static double sum_of(const double *values, int count)
{
    double sum = 0;
    for (int i = 0; i < count; i++) {
        sum += values[i];
    }
    return sum;
}

/* Weighted echo of one pulse, the middle frequency in bin 0 and lower ones wrapped to the end. */
static void place_spectrum(double complex *bins, int bin_count, const double complex *echo,
                           const double *weight, int frequencies, double gain)
{
    const int middle = frequencies / 2;
    memset(bins, 0, (size_t)bin_count * sizeof *bins);
    for (int n = 0; n < frequencies; n++) {
        const int bin = n < middle ? n - middle + bin_count : n - middle;
        bins[bin] = echo[n] * (weight[n] * gain);
    }
}

int rr_compress(struct rr_profiles *profiles, const struct rr_phase_history *ph, double taylor_db)
{
    if (profiles_alloc(profiles, ph) != 0) {
        return -1;
    }
    const int most = ph->frequencies > ph->pulses ? ph->frequencies : ph->pulses;
    double *weight = malloc(2 * (size_t)most * sizeof *weight);
    if (!weight) {
        rr_profiles_free(profiles);
        return hs_error("range compression", NULL, "out of memory");
    }
    double *by_frequency = weight, *by_pulse = weight + most;
    hs_taylor(by_frequency, ph->frequencies, taylor_db, TAYLOR_N_BAR);
    hs_taylor(by_pulse, ph->pulses, taylor_db, TAYLOR_N_BAR);
    profiles->bin_m = rr_light_m_s / (2 * ph->step_hz * profiles->bins);
    profiles->carrier_rad_m =
        4 * pi * (ph->first_hz + ph->frequencies / 2 * ph->step_hz) / rr_light_m_s;
    profiles->gain = 1 / (sum_of(by_frequency, ph->frequencies) * sum_of(by_pulse, ph->pulses));
    for (int p = 0; p < ph->pulses; p++) {
        double complex *row = profiles->value + (size_t)p * (size_t)profiles->bins;
        fftw_plan plan = fftw_plan_dft_1d(profiles->bins, row, row, FFTW_BACKWARD, FFTW_ESTIMATE);
        place_spectrum(row, profiles->bins, ph->echo + (size_t)p * (size_t)ph->frequencies,
                       by_frequency, ph->frequencies, by_pulse[p]);
        fftw_execute(plan);
        fftw_destroy_plan(plan);
    }
    free(weight);
    return 0;
}

void rr_profiles_free(struct rr_profiles *profiles)
{
    free(profiles->value);
    free(profiles->antenna);
    free(profiles->reference_m);
    *profiles = (struct rr_profiles){0};
}

void rr_focus(const struct rr_profiles *profiles, const struct rr_place *points, size_t count,
              double complex *out)
{
    const int mask = profiles->bins - 1; /* the number of bins is a power of two */
    memset(out, 0, count * sizeof *out);
    for (int p = 0; p < profiles->pulses; p++) {
        const double complex *row = profiles->value + (size_t)p * (size_t)profiles->bins;
        const struct rr_place antenna = profiles->antenna[p];
        for (size_t i = 0; i < count; i++) {
            const double range_m = rr_distance_m(antenna, points[i]) - profiles->reference_m[p];
            const double bin = range_m / profiles->bin_m;
            const double whole = floor(bin);
            const double part = bin - whole;
            const int b = (int)((int64_t)whole & mask);
            const double phase = profiles->carrier_rad_m * range_m;
            const double complex echo = row[b] * (1 - part) + row[(b + 1) & mask] * part;
            const double c = cos(phase), s = sin(phase);
            /* Written out, because C's complex product looks for infinities. */
            out[i] += (creal(echo) * c - cimag(echo) * s) + I * (creal(echo) * s + cimag(echo) * c);
        }
    }
    for (size_t i = 0; i < count; i++) {
        out[i] *= profiles->gain;
    }
}

struct rr_place rr_image_place(const struct rr_image *image, int column, int row)
{
    const double middle = (image->side_px - 1) / 2.0;
    return (struct rr_place){(column - middle) * image->pixel_m, (middle - row) * image->pixel_m,
                             0};
}

int rr_image_make(struct rr_image *image, const struct rr_profiles *profiles, double side_m,
                  double pixel_m)
{
    const int side = (int)lround(side_m / pixel_m);
    const size_t n = (size_t)side;
    *image = (struct rr_image){.side_px = side, .pixel_m = pixel_m};
    image->power = malloc(n * n * sizeof *image->power);
    struct rr_place *points = malloc(n * sizeof *points);
    double complex *echo = malloc(n * sizeof *echo);
    if (!image->power || !points || !echo) {
        rr_image_free(image);
        free(points);
        free(echo);
        return hs_error("picture", "ask for fewer pixels", "out of memory");
    }
    struct hs_progress progress;
    hs_progress_begin(&progress, "back-projection", n);
    for (int row = 0; row < side; row++) {
        for (int column = 0; column < side; column++) {
            points[column] = rr_image_place(image, column, row);
        }
        rr_focus(profiles, points, n, echo);
        for (size_t i = 0; i < n; i++) {
            const double real = creal(echo[i]), imaginary = cimag(echo[i]);
            image->power[(size_t)row * n + i] = real * real + imaginary * imaginary;
        }
        hs_progress_update(&progress, (uint64_t)row + 1);
    }
    hs_progress_end(&progress);
    free(points);
    free(echo);
    return 0;
}

void rr_image_free(struct rr_image *image)
{
    free(image->power);
    *image = (struct rr_image){0};
}

int rr_image_write(const struct rr_image *image, const char *path, double span_db)
{
    const size_t count = (size_t)image->side_px * (size_t)image->side_px;
    uint8_t *grey = malloc(count);
    if (!grey) {
        return hs_error(path, NULL, "out of memory");
    }
    double brightest = 0;
    for (size_t i = 0; i < count; i++) {
        brightest = fmax(brightest, image->power[i]);
    }
    for (size_t i = 0; i < count; i++) {
        const double below_db =
            image->power[i] > 0 ? 10 * log10(brightest / image->power[i]) : span_db;
        grey[i] = (uint8_t)lround(255 * fmax(0, 1 - below_db / span_db));
    }
    const int status =
        hs_png_write_grey(path, grey, image->side_px, image->side_px, (size_t)image->side_px);
    free(grey);
    return status;
}
