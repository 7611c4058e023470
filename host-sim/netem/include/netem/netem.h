/* NetEM: step 3 with networks, that is the reflection coefficients of every reflection of a
 * picture, or the intensities that leave it: enum nm_connection. */
#ifndef NETEM_H
#define NETEM_H

#include "netem/paths.h"

/* Scratch that grows to the largest picture seen; zeroed before its first use. */
struct nm_netem {
    const struct nm_architecture *architecture; /* borrowed */
    double *features[NM_DIRECTIONS], *d_features[NM_DIRECTIONS];
    double *activity[NM_DIRECTIONS], *delta[NM_DIRECTIONS];
    double *out[NM_DIRECTIONS], *d_out[NM_DIRECTIONS]; /* by row: outputs and their derivatives */
    size_t capacity[NM_DIRECTIONS];                    /* rows */
    double hold; /* weight of nm_netem_hold() in nm_netem_backward(); 0: none */
};

/* Coefficients of all rows of `paths` from `weights` (nm_architecture_size numbers). They stay good
 * until the next call. Returns 0, or -1 with the error reported: out of memory, or paths that were
 * not built for networks of this connection. */
int nm_netem_forward(struct nm_netem *em, const double *weights, const struct nm_paths *paths,
                     struct nm_coefficients *coefficients);

/* What holds intensities that are handed on away from both ends of their sigmoid, where it has no
 * slope: the mean of -ln(4 o (1 - o)) over them, 0 at one half. No picture shows what is handed on
 * (docs/netem.md), so that a share of all alike drifts until it stays at an end, the same for every
 * reflection, and nothing brings it back. After nm_netem_forward(); 0 for outputs of other units,
 * or where coefficients are multiplied. */
double nm_netem_hold(const struct nm_netem *em, const struct nm_paths *paths);

/* After nm_netem_forward(): adds to `gradient` what the derivatives of the loss by the picture of
 * step 4 come to, and those of `hold` times nm_netem_hold(). */
void nm_netem_backward(struct nm_netem *em, const double *weights, const struct nm_paths *paths,
                       const struct nm_coefficients *coefficients, const double *d_image,
                       double *gradient);

/* One reflection's coefficient in one direction. Networks of NM_BY_INTENSITY have one for each
 * `intensity` that meets it, (0, 1]: theirs over that. */
double nm_netem_ask(const struct nm_architecture *architecture, const double *weights,
                    const struct nm_reflection *reflection, enum nm_direction direction,
                    double intensity);

/* Harmless on a zeroed struct. */
void nm_netem_free(struct nm_netem *em);

#endif
