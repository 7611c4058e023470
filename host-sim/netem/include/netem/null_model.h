/* Null models: scores that a picture gets which knows nothing of the chip but other chips. A
 * simulator that is no better has learned nothing; and how well a simulator fits other vehicles. */
#ifndef NETEM_NULL_MODEL_H
#define NETEM_NULL_MODEL_H

#include "netem/score.h"
#include "netem/train.h"

#include <stdbool.h>

enum nm_null_kind {
    NM_NULL_FLAT,     /* the mean of all pixels of the training chips, everywhere */
    NM_NULL_MEAN,     /* the mean of the training chips */
    NM_NULL_NEAREST,  /* the training chip of the nearest azimuth that is another one */
    NM_NULL_SMOOTHED, /* the other training chips' mean, weighted by exp(-(off / 8 degrees)^2 / 2):
                         the target itself, with little speckle left */
    NM_NULLS
};
extern const char *const nm_null_names[NM_NULLS];

/* Mean scores over `chips`, each null's picture registered as a simulated one is. `near_deg`, if
 * not NULL, receives how far NM_NULL_NEAREST's azimuths are away, on average. All NaN without
 * training chips. Returns 0, or -1 out of memory, reported. */
int nm_null_scores(struct nm_training *t, const struct nm_samples *training,
                   const struct nm_samples *chips, struct nm_score scores[NM_NULLS],
                   double *near_deg);

/* Likeness of the learned simulator to chips. */
struct nm_fit {
    double mse, cw_ssim, best_cw_ssim; /* the last with all amplitudes times the best gain */
};

/* A picture of the simulator's size beside the chip of `sample`, registered. Returns 0, or -1 out
 * of memory, reported. */
int nm_fit_picture(struct nm_training *t, const double *picture, const struct nm_sample *sample,
                   double best_gain, struct nm_fit *fit);

/* The same with the learned picture of `aspect`, in t->simulator.pixels. */
int nm_fit_chip(struct nm_training *t, const struct nm_sample *aspect,
                const struct nm_sample *sample, double best_gain, struct nm_fit *fit);

/* The sample of the nearest azimuth; with `is_another` of the nearest that is not the same. NULL if
 * there is none. */
const struct nm_sample *nm_nearest(const struct nm_samples *samples, double azimuth_deg,
                                   bool is_another);

/* All amplitudes of `count` pixels after tanh times `gain`. */
void nm_brighten(const double *pixels, int count, double gain, double *brighter);

#endif
