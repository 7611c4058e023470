/* Search for the aspect of a chip that does not tell it: the untrained simulator's pictures from
 * all around are laid over the chip, and the best fit gives azimuth and place. */
#ifndef NETEM_SEARCH_H
#define NETEM_SEARCH_H

#include "netem/fft.h"
#include "netem/picture.h"

/* Simulated pictures from `views` azimuths, evenly around, the first at 0. */
struct nm_library {
    int views, side_px;
    double *pictures; /* owned: views x side_px^2 */
};

/* Take memory for so many square pictures, all zero. Returns 0, or -1 with the error reported (no
 * memory). Close is harmless on a zeroed struct. */
int nm_library_open(struct nm_library *library, int views, int side_px);
void nm_library_close(struct nm_library *library);

/* From amplitudes to calibrated pixels: the ground, which most of the pixels show, becomes as
 * bright as `clutter`; then tanh. Returns 0, or -1 with the error reported, also when there is no
 * ground. */
int nm_library_calibrate(struct nm_library *library, double clutter);

/* Scores of one chip against all views. */
struct nm_match {
    double *scores;            /* owned: correlation coefficient at the best place, -1..1 */
    struct nm_origin *origins; /* owned: that place */
};

/* Take memory for the scores of so many views. Returns 0, or -1 with the error reported (no
 * memory). */
int nm_match_open(struct nm_match *match, int views);
void nm_match_close(struct nm_match *match);

struct nm_searcher {
    int width, height; /* of the chips */
    int views, side_px;
    struct nm_fft fft;      /* of the chip, and of its product with a view back to a plane */
    fftw_complex *chip;     /* owned scratch: its spectrum */
    fftw_complex *library;  /* owned: conjugate spectra of the views, mean 0, length 1 */
    double *sums, *squares; /* owned: integrals of the chip and its square */
};

/* For chips of width x height, no smaller than the library's pictures. Returns 0, or -1 with the
 * error reported. */
int nm_searcher_open(struct nm_searcher *s, const struct nm_library *library, int width,
                     int height);
void nm_searcher_close(struct nm_searcher *s);

/* Fill `match` with the best place of each view within `reach` pixels of the middle. Cost: one FFT
 * of the chip for each view. */
void nm_search(struct nm_searcher *s, const struct nm_picture *chip, int reach,
               struct nm_match *match);

/* Choose a view for each of `count` chips. Alone, a chip takes its best. Chips that were taken one
 * after the other on circles about the target take the views of the best total score, when a step
 * that differs from a steady one by more than 4 degrees costs 0.003 a degree more, and a new start
 * anywhere 0.4 (dynamic programming; `step_deg` gets the steady step found, -12 to 12). Returns 0,
 * or -1 out of memory, reported. */
void nm_choose_alone(const struct nm_match *matches, int count, int views, int *chosen);
int nm_choose_in_order(const struct nm_match *matches, int count, int views, int *chosen,
                       double *step_deg);

/* Margin of the chosen view over the best one that is more than 30 degrees away. Small or
 * negative: ambiguous. */
double nm_search_margin(const struct nm_match *match, int views, int chosen);

#endif
