/* Back-projection of a phase history to a picture: range compression by FFT, then every pulse
 * summed at every point (Gorham and Moore, "SAR image formation toolbox for MATLAB", SPIE 7699,
 * 2010). Double precision throughout. */
#ifndef REALRADAR_BACKPROJECT_H
#define REALRADAR_BACKPROJECT_H

#include "realradar/phase_history.h"

#include <stddef.h>

/* Range-compressed pulses, 16 times finer than their resolution or more, on a carrier of the middle
 * frequency. Slant ranges repeat every `bins * bin_m`, so that a scene must be smaller. */
struct rr_profiles {
    int bins, pulses;
    double bin_m;             /* slant range from bin to bin */
    double carrier_rad_m;     /* phase for a metre of slant range, there and back */
    double gain;              /* brings a point of amplitude 1 to 1 in the picture */
    double complex *value;    /* owned; pulses rows of bins */
    struct rr_place *antenna; /* owned */
    double *reference_m;      /* owned */
};

/* Compress. `taylor_db` is 0 for no weighting, or the height of the sidelobes below the main lobe
 * of a Taylor weighting with n-bar 5 in both directions. Returns 0, or -1 with the error reported.
 * Cost: an FFT of 16 times the frequencies for each pulse. */
int rr_compress(struct rr_profiles *profiles, const struct rr_phase_history *ph, double taylor_db);
void rr_profiles_free(struct rr_profiles *profiles);

/* The complex echo of each of `count` points. Range is interpolated linearly between bins; what
 * that adds lies below -60 dB of the brightest point. Cost: about 40 ns for each point and pulse.
 */
void rr_focus(const struct rr_profiles *profiles, const struct rr_place *points, size_t count,
              double complex *out);

/* A picture of level ground at z = 0 about the origin; the top row is the largest y. */
struct rr_image {
    int side_px;
    double pixel_m;
    double *power; /* owned; side_px rows of side_px */
};

/* Focus a square of level ground `side_m` wide, which must be narrower than the profiles' repeating
 * range, in pixels of `pixel_m`. Returns 0, or -1 with the error reported (no memory). Cost:
 * rr_focus of every pixel. */
int rr_image_make(struct rr_image *image, const struct rr_profiles *profiles, double side_m,
                  double pixel_m);
void rr_image_free(struct rr_image *image);
/* The place of the centre of a pixel, metres. */
struct rr_place rr_image_place(const struct rr_image *image, int column, int row);

/* 8-bit grey of the logarithm: white is the brightest pixel, black `span_db` below it. Returns 0,
 * or -1 with the error reported. */
int rr_image_write(const struct rr_image *image, const char *path, double span_db);

#endif
