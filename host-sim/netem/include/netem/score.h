/* Scores of likeness between two pictures: squares of `side` pixels with values in 0..1. */
#ifndef NETEM_SCORE_H
#define NETEM_SCORE_H

struct nm_score {
    double mse;
    double ssim;
    double cw_ssim;
};

enum { NM_SCORE_SIDE_MIN = 32 }; /* smaller pictures have no CW-SSIM */

/* Mean of the squared differences. */
double nm_score_mse(const double *a, const double *b, int side);

/* Wang, Bovik, Sheikh and Simoncelli, IEEE Trans. Image Processing 13 (2004), eq. 13: Gaussian
 * window of 11 x 11 and 1.5 pixels, K1 = 0.01, K2 = 0.03, range 1; the mean over all whole windows.
 * 1 for equal pictures. */
double nm_score_ssim(const double *a, const double *b, int side);

/* Sampat, Wang, Gupta, Bovik and Markey, "Complex wavelet structural similarity", IEEE Trans. Image
 * Processing 18 (2009), eq. 9 with K = 0: bands of eight orientations of the complex steerable
 * pyramid (Portilla and Simoncelli, 2000) at the level whose bands have 16 to 31 pixels a side,
 * windows of 7 x 7, weighted toward the middle by a Gaussian of a quarter of the band. 0..1; a
 * shift of a pixel or two hardly changes it. Returns 0, or -1 out of memory with the error
 * reported. */
int nm_score_cw_ssim(const double *a, const double *b, int side, double *score);

/* All three. Returns 0, or -1 out of memory with the error reported. */
int nm_score(const double *a, const double *b, int side, struct nm_score *score);

#endif
