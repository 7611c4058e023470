/* Speckle with the grain of the radar: fields of many scatterers, each spread by the radar's
 * response, so that neighbours closer than its resolution have nearly the same. */
#ifndef NETEM_SPECKLE_H
#define NETEM_SPECKLE_H

#include "hs/rng.h"

/* Multiply the amplitudes behind `pixels`, side x side after tanh, by speckle of `looks` looks
 * (>= 1). `aperture` is the response's in samples of the pixels (tracer/pix.h, pix_aperture); with
 * PIX_KERNEL_SIDE each pixel has its own. Returns 0, or -1 out of memory, reported.
 *
 * Cost: 430 multiplications a pixel and look. */
int nm_speckle(double *pixels, int side, int aperture, int looks, struct hs_rng *rng);

#endif
