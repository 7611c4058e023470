/* NetEM: step 3 with networks, that is the reflection coefficients of every reflection of a
 * picture. */
#ifndef NETEM_H
#define NETEM_H

#include "netem/paths.h"

/* Scratch that grows to the largest picture seen; zeroed before its first use. */
struct nm_netem {
    const struct nm_architecture *architecture; /* borrowed */
    double *features[NM_DIRECTIONS], *activity[NM_DIRECTIONS], *delta[NM_DIRECTIONS];
    double
        *split[2 * NM_DIRECTIONS]; /* outputs of one network taken apart, and their derivatives */
    size_t feature_capacity[NM_DIRECTIONS], capacity[NM_DIRECTIONS], split_capacity;
};

/* Coefficients of all rows of `paths` from `weights` (nm_architecture_size numbers). They stay good
 * until the next call. Returns 0, or -1 out of memory with the error reported. */
int nm_netem_forward(struct nm_netem *em, const double *weights, const struct nm_paths *paths,
                     struct nm_coefficients *coefficients);

/* After it: adds to `gradient` what the derivatives of the loss by the picture of step 4 come to.
 */
void nm_netem_backward(struct nm_netem *em, const double *weights, const struct nm_paths *paths,
                       const struct nm_coefficients *coefficients, const double *d_image,
                       double *gradient);

/* One reflection's coefficient in one direction. */
double nm_netem_ask(const struct nm_architecture *architecture, const double *weights,
                    const struct nm_reflection *reflection, enum nm_direction direction);

/* Harmless on a zeroed struct. */
void nm_netem_free(struct nm_netem *em);

#endif
