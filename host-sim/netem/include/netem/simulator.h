/* Simulator: steps 3 to 5 in one, from traced paths to the pixels of a chip, and the derivative of
 * it all (Niu, Fig. 7). */
#ifndef NETEM_SIMULATOR_H
#define NETEM_SIMULATOR_H

#include "netem/netem.h"
#include "netem/netpix.h"

/* Simulator: what is learned, and what it needs besides. */
struct nm_model {
    const struct nm_architecture *architecture; /* borrowed */
    bool is_pix_trainable;                      /* Fig. 15 instead of the fixed kernel */
    double kernel[NM_LARGE * NM_LARGE];         /* the fixed one, gain included */
    double *values; /* owned: nm_architecture_size weights, then a struct nm_pix_values */
    size_t size;    /* of `values` */
};

/* Draws the weights; `kernel` is NM_LARGE wide. Returns 0, or -1 out of memory, reported. */
int nm_model_open(struct nm_model *m, const struct nm_architecture *architecture,
                  const double *kernel, struct hs_rng *rng);
void nm_model_close(struct nm_model *m);
struct nm_pix_values *nm_model_pix(const struct nm_model *m, double *values);

struct nm_simulator {
    struct nm_netem em;
    struct nm_netpix pix;
    struct nm_coefficients coefficients; /* of the last picture */
    int side_px;
    double *picture, *d_picture; /* owned: step 4, cells */
    double *pixels, *d_pixels;   /* owned: the chip; side_px^2 */
};

/* For pictures of cells x cells; even. From here on the matrix library has one thread. Returns 0,
 * or -1 with the error reported. */
int nm_simulator_open(struct nm_simulator *s, const struct nm_architecture *architecture,
                      int cells);
void nm_simulator_close(struct nm_simulator *s);

/* Step 3 and 4: s->picture. Step 5 as well: s->pixels. Return 0, or -1 out of memory, reported. */
int nm_simulate_picture(struct nm_simulator *s, const struct nm_model *m,
                        const struct nm_paths *paths);
int nm_simulate(struct nm_simulator *s, const struct nm_model *m, const struct nm_paths *paths);

/* Step 4 by given coefficients instead, step 5 by the model. */
void nm_simulate_with(struct nm_simulator *s, const struct nm_model *m,
                      const struct nm_paths *paths, const struct nm_coefficients *c);

/* After nm_simulate_picture: from s->d_picture, adds to the gradient of the reflection weights. */
void nm_simulator_backward_picture(struct nm_simulator *s, const struct nm_model *m,
                                   const struct nm_paths *paths, double *gradient);

/* After nm_simulate: from s->d_pixels to all of the gradient (m->size), or only to the weights of
 * `is_pix_only` when the reflection networks are frozen. */
void nm_simulator_backward(struct nm_simulator *s, const struct nm_model *m,
                           const struct nm_paths *paths, bool is_pix_only, double *gradient);

#endif
