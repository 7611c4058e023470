#include "netem/convolve.h"

#include <string.h>

/* The next length that FFTW transforms fast. */
static int smooth_length(int n)
{
    for (;; n++) {
        int rest = n;
        for (int prime = 2; prime <= 5; prime += prime == 2 ? 1 : 2) {
            while (rest % prime == 0) {
                rest /= prime;
            }
        }
        if (rest == 1 && n % 2 == 0) {
            return n;
        }
    }
}

int nm_convolver_open(struct nm_convolver *c, int side, int kernel_max)
{
    const int period = smooth_length(side + kernel_max - 1);
    *c = (struct nm_convolver){.side = side, .period = period};
    return nm_fft_open(&c->fft, period, period, "convolution");
}

void nm_convolver_close(struct nm_convolver *c)
{
    nm_fft_close(&c->fft);
    *c = (struct nm_convolver){0};
}

fftw_complex *nm_spectrum_new(const struct nm_convolver *c)
{
    return nm_fft_spectrum_new(&c->fft);
}

/* Position of `offset` on a circle of the period. */
static size_t wrapped(const struct nm_convolver *c, int offset)
{
    return (size_t)(offset < 0 ? offset + c->period : offset);
}

/* Transform a square of `size`, whose element (0, 0) belongs at (-before, -before). */
static void to_spectrum(struct nm_convolver *c, const double *square, int size, int before,
                        fftw_complex *spectrum)
{
    memset(c->fft.plane, 0, (size_t)c->period * (size_t)c->period * sizeof *c->fft.plane);
    for (int y = 0; y < size; y++) {
        double *row = c->fft.plane + wrapped(c, y - before) * (size_t)c->period;
        for (int x = 0; x < size; x++) {
            row[wrapped(c, x - before)] = square[y * size + x];
        }
    }
    nm_fft_to(&c->fft, spectrum);
}

static void from_spectrum(struct nm_convolver *c, const fftw_complex *spectrum, int size,
                          int before, double *square)
{
    memcpy(c->fft.spectrum, spectrum, c->fft.spectrum_size * sizeof *spectrum);
    nm_fft_back(&c->fft);
    const double scale = 1.0 / ((double)c->period * c->period);
    for (int y = 0; y < size; y++) {
        const double *row = c->fft.plane + wrapped(c, y - before) * (size_t)c->period;
        for (int x = 0; x < size; x++) {
            square[y * size + x] = scale * row[wrapped(c, x - before)];
        }
    }
}

void nm_spectrum_of_picture(struct nm_convolver *c, const double *picture, fftw_complex *spectrum)
{
    to_spectrum(c, picture, c->side, 0, spectrum);
}

void nm_spectrum_of_kernel(struct nm_convolver *c, const double *kernel, int size,
                           fftw_complex *spectrum)
{
    to_spectrum(c, kernel, size, size / 2, spectrum);
}

void nm_picture_of_spectrum(struct nm_convolver *c, const fftw_complex *spectrum, double *picture)
{
    from_spectrum(c, spectrum, c->side, 0, picture);
}

void nm_kernel_of_spectrum(struct nm_convolver *c, const fftw_complex *spectrum, int size,
                           double *kernel)
{
    from_spectrum(c, spectrum, size, size / 2, kernel);
}

void nm_spectrum_clear(const struct nm_convolver *c, fftw_complex *spectrum)
{
    memset(spectrum, 0, c->fft.spectrum_size * sizeof *spectrum);
}

void nm_spectrum_add_product(const struct nm_convolver *c, const fftw_complex *a,
                             const fftw_complex *b, fftw_complex *sum)
{
    for (size_t i = 0; i < c->fft.spectrum_size; i++) {
        sum[i][0] += a[i][0] * b[i][0] - a[i][1] * b[i][1];
        sum[i][1] += a[i][0] * b[i][1] + a[i][1] * b[i][0];
    }
}

void nm_spectrum_add_correlation(const struct nm_convolver *c, const fftw_complex *a,
                                 const fftw_complex *b, fftw_complex *sum)
{
    for (size_t i = 0; i < c->fft.spectrum_size; i++) {
        fftw_complex product;
        nm_fft_correlate(a[i], b[i], product);
        sum[i][0] += product[0];
        sum[i][1] += product[1];
    }
}
