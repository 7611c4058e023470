/* NetPix: step 5, from the picture of step 4 to pixels as a real chip has them. Two forms:
 *
 * Fixed: one kernel of 107 x 107 cells, the impulse response under its Taylor window (Fig. 14).
 *
 * Trainable (Fig. 15): a first layer of that kernel, now adjustable, and four of 7 x 7, each with a
 * bias and ReLU; a second layer of one kernel of 6 x 5 x 5 with a bias over the five results and
 * the picture itself, the sixth channel that the paper's "6 x 5 x 5" asks for and its figure leaves
 * open.
 *
 * Both are sampled every second cell (0.1 m to 0.2 m; a response of 0.3 m has nothing to alias) and
 * pass tanh, as the real chips do (12). */
#ifndef NETEM_NETPIX_H
#define NETEM_NETPIX_H

#include "hs/rng.h"
#include "netem/convolve.h"

#include <stdbool.h>

enum {
    NM_LARGE = 107,
    NM_SMALL = 7,
    NM_SMALL_KERNELS = 4,
    NM_FIRST_KERNELS = 1 + NM_SMALL_KERNELS,
    NM_SECOND = 5,
    NM_CHANNELS = NM_FIRST_KERNELS + 1,
    NM_CELLS_PER_PIXEL = 2,
};

/* The trainable values, in this order, as one array of doubles. */
struct nm_pix_values {
    double large[NM_LARGE * NM_LARGE];
    double small[NM_SMALL_KERNELS][NM_SMALL * NM_SMALL];
    double first_bias[NM_FIRST_KERNELS];
    double second[NM_CHANNELS][NM_SECOND * NM_SECOND];
    double second_bias;
};
enum { NM_PIX_SIZE = sizeof(struct nm_pix_values) / sizeof(double) };

/* Intermediate results of a picture, kept for its derivative. */
struct nm_netpix {
    struct nm_convolver convolver;
    int side;                                     /* cells of the picture, either way; even */
    fftw_complex *picture, *kernel, *sum, *d_out; /* owned spectra */
    fftw_complex *fixed;                          /* owned: the spectrum of fixed_kernel */
    double *fixed_kernel; /* owned: the fixed kernel last used; NaN before */
    fftw_complex *channel[NM_FIRST_KERNELS];
    double *plane[NM_FIRST_KERNELS]; /* owned: the first layer's results, after ReLU */
    double *cells;   /* owned, side x side: amplitudes of the last forward call, not yet sampled */
    double *d_cells; /* owned scratch */
};

/* Returns 0, or -1 with the error reported. */
int nm_netpix_open(struct nm_netpix *pix, int side);
void nm_netpix_close(struct nm_netpix *pix);

/* The trainable form as the fixed one with `kernel`: second layer the identity on the large
 * kernel's channel, small kernels drawn. */
void nm_pix_draw(struct nm_pix_values *v, const double *kernel, struct hs_rng *rng);

/* `pixels` has (side / 2)^2. `kernel` is NM_LARGE wide. */
void nm_netpix_fixed(struct nm_netpix *pix, const double *kernel, const double *picture,
                     double *pixels);
void nm_netpix_trainable(struct nm_netpix *pix, const struct nm_pix_values *v,
                         const double *picture, double *pixels);

/* The derivatives after the forward call of the same form. `d_pixels` is by the pixels, which are
 * given again; `d_picture` is overwritten, and skipped if NULL; `gradient` is added to. */
void nm_netpix_fixed_backward(struct nm_netpix *pix, const double *kernel, const double *pixels,
                              const double *d_pixels, double *d_picture);
void nm_netpix_trainable_backward(struct nm_netpix *pix, const struct nm_pix_values *v,
                                  const double *pixels, const double *d_pixels, double *d_picture,
                                  struct nm_pix_values *gradient);

#endif
