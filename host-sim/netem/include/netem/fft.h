/* FFT of a plane of real numbers (FFTW, double precision). Plans are estimated, not measured, so
 * that repeated runs give the same bits. */
#ifndef NETEM_FFT_H
#define NETEM_FFT_H

#include <fftw3.h>
#include <stddef.h>

struct nm_fft {
    int rows, columns;
    size_t spectrum_size;   /* complex numbers: rows * (columns / 2 + 1) */
    double *plane;          /* owned; rows x columns */
    fftw_complex *spectrum; /* owned; spoilt by nm_fft_back */
    fftw_plan forward, backward;
};

/* Returns 0, or -1 with the error reported with `place` and *f empty. */
int nm_fft_open(struct nm_fft *f, int rows, int columns, const char *place);

/* Harmless on a zeroed struct. */
void nm_fft_close(struct nm_fft *f);

/* An array for one more spectrum; NULL out of memory. Free with fftw_free. */
fftw_complex *nm_fft_spectrum_new(const struct nm_fft *f);

/* From the plane, which keeps its contents, to `spectrum`: f->spectrum or one of the above. */
void nm_fft_to(struct nm_fft *f, fftw_complex *spectrum);

/* From f->spectrum to the plane, rows * columns times as large. */
void nm_fft_back(struct nm_fft *f);

/* A term of the spectrum of a correlation: a times the conjugate of b. */
static inline void nm_fft_correlate(const double a[2], const double b[2], double product[2])
{
    product[0] = a[0] * b[0] + a[1] * b[1];
    product[1] = a[1] * b[0] - a[0] * b[1];
}

#endif
