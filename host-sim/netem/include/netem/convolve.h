/* Convolution of square pictures by FFT. */
#ifndef NETEM_CONVOLVE_H
#define NETEM_CONVOLVE_H

#include "netem/fft.h"

struct nm_convolver {
    int side;          /* of the pictures */
    int period;        /* of the transforms: no smaller than side + largest kernel - 1 */
    struct nm_fft fft; /* period x period */
};

/* For kernels of an odd width up to `kernel_max`. Returns 0, or -1 with the error reported. */
int nm_convolver_open(struct nm_convolver *c, int side, int kernel_max);
void nm_convolver_close(struct nm_convolver *c);

/* An array for one spectrum; NULL out of memory. Free with fftw_free. */
fftw_complex *nm_spectrum_new(const struct nm_convolver *c);

/* The spectrum of a picture, or of a kernel of width `size` about its middle. */
void nm_spectrum_of_picture(struct nm_convolver *c, const double *picture, fftw_complex *spectrum);
void nm_spectrum_of_kernel(struct nm_convolver *c, const double *kernel, int size,
                           fftw_complex *spectrum);

/* sum += a * b, or a * conj(b): convolution and correlation of what they are spectra of. */
void nm_spectrum_add_product(const struct nm_convolver *c, const fftw_complex *a,
                             const fftw_complex *b, fftw_complex *sum);
void nm_spectrum_add_correlation(const struct nm_convolver *c, const fftw_complex *a,
                                 const fftw_complex *b, fftw_complex *sum);
void nm_spectrum_clear(const struct nm_convolver *c, fftw_complex *spectrum);

/* Back: the picture, or the kernel of width `size`; both are overwritten. */
void nm_picture_of_spectrum(struct nm_convolver *c, const fftw_complex *spectrum, double *picture);
void nm_kernel_of_spectrum(struct nm_convolver *c, const fftw_complex *spectrum, int size,
                           double *kernel);

#endif
