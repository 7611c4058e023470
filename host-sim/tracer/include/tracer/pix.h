/* Pixels of a radar chip from echoes in cells: [Niu], step 5, with fixed parts only: the
 * system's impulse response, coarser pixels, speckle. */
#ifndef TRACER_PIX_H
#define TRACER_PIX_H

#include "hs/rng.h"

#include <stdint.h>

enum {
    PIX_KERNEL_SIDE = 107, /* samples of the kernel either way: [Niu], Fig. 14 and 15 */
    PIX_LOOKS_MAX = 64,
};

/* The magnitude of a Taylor-weighted impulse response along one axis, 1 in the middle: the Fourier
 * transform, over PIX_KERNEL_SIDE samples, of `aperture` (1..PIX_KERNEL_SIDE) samples of a Taylor
 * window of -35 dB and nbar 4. Its first nulls beyond the main lobe are PIX_KERNEL_SIDE / aperture
 * samples apart. The two-dimensional response is the product of two. */
void pix_taylor(int aperture, double response[PIX_KERNEL_SIDE]);

/* Whether cells of `spacing_m` can have that resolution: the aperture is within 1..PIX_KERNEL_SIDE.
 * Returns 0, or -1 with the error and what they can have reported. */
int pix_resolution_check(double resolution_m, double spacing_m);

/* The aperture whose response is `resolution_m` wide between the -3 dB points in samples of
 * `spacing_m`, to the nearest whole number. The wide window makes it 1.184 times the null distance.
 */
int pix_aperture(double resolution_m, double spacing_m);

/* Spread the power of each cell by the squared response of the system. Far from the edges the sum
 * of all is kept; at the edges level ground stays level, as if the picture went on. `power` has
 * height * width numbers. Returns 0, or -1 without memory, reported. Cost: 2 * 107 multiplications
 * a cell. */
int pix_spread(float *power, int width, int height, int aperture);

/* Means of ratio * ratio cells; width and height are multiples of `ratio`. May work in place. */
void pix_coarsen(const float *power, int width, int height, int ratio, float *coarse);

/* Multiply each power by Gamma(looks) / looks: of one look the exponential law of speckle. */
void pix_speckle(float *power, int count, int looks, struct hs_rng *rng);

#endif
