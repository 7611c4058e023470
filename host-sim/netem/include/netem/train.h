/* Training as Niu describes it (III-C.4): a few epochs on the simulator's own picture of step 4, so
 * that the networks make pictures that can be registered; then real chips, registered by phase
 * correlation, with the fixed kernel; at last the trainable kernels, with the reflection networks
 * frozen. Each phase but the first may end on the mean of its last values (average.h), which the
 * paper does not do. */
#ifndef NETEM_TRAIN_H
#define NETEM_TRAIN_H

#include "netem/average.h"
#include "netem/loss.h"
#include "netem/optimizer.h"
#include "netem/registration.h"
#include "netem/simulator.h"

#include <stdint.h>

enum { NM_EPOCHS_MAX = 10000, NM_SAMPLE_NAME_SIZE = 128 };

enum nm_phase { NM_PRETRAINING, NM_REAL_CHIPS, NM_PIXELS, NM_PHASES };
extern const char *const nm_phase_names[NM_PHASES];

/* One chip: where its rays went, and what the radar saw. */
struct nm_sample {
    char name[NM_SAMPLE_NAME_SIZE];
    double azimuth_deg;
    struct nm_paths paths;   /* owned */
    struct nm_picture real;  /* owned; 0..1, after (12) */
    struct nm_origin origin; /* where the simulated chip is expected on the real one */
    double *own;             /* owned: step 4 by the simulator's own law, cells^2 */
    double *own_amplitudes;  /* owned: its finished chip before tanh, side_px^2; may be NULL */
};

/* Harmless on a zeroed struct. */
void nm_sample_free(struct nm_sample *sample);

struct nm_plan {
    enum nm_loss_kind loss;
    enum nm_method method;
    double rate;     /* of the reflection networks */
    double pix_rate; /* of the pixels' kernels */
    double momentum; /* of SGD */
    int batch;       /* chips between two changes of values */
    int epochs[NM_PHASES];
    double average; /* share of a phase's epochs, its last, over whose steps values are averaged */
    int reach_px;   /* registration looks so far from a sample's origin; 0 takes it as it is */
    uint64_t seed;
};

struct nm_epoch {
    enum nm_phase phase;
    double training; /* mean loss over the training chips as they were visited */
    double
        validation; /* mean loss over the others afterwards, real chips in every phase; NaN: none */
};

struct nm_training {
    struct nm_plan plan;
    struct nm_materials materials; /* that the networks know; none until the caller says */
    struct nm_model model;
    struct nm_optimizer optimizer;
    struct nm_average average; /* of the phase that goes on */
    struct hs_rng rng;
    struct nm_epoch epochs[NM_EPOCHS_MAX];
    int epoch_count; /* done so far */

    /* Not part of the state: scratch. */
    struct nm_simulator simulator;
    struct nm_registrar registrar;
    double *gradient; /* owned */
};

struct nm_samples {
    struct nm_sample *items; /* borrowed */
    int count;
};

/* Everything at its beginning, for pictures of cells x cells. `t` is large: give it from the heap.
 * Returns 0, or -1 with the error reported. */
int nm_training_open(struct nm_training *t, const struct nm_plan *plan,
                     const struct nm_architecture *architecture, const double *kernel, int cells);
void nm_training_close(struct nm_training *t);

/* The phase that the next epoch belongs to; NM_PHASES when all are done. */
enum nm_phase nm_training_phase(const struct nm_training *t);

/* One more epoch, entered in t->epochs. The same state and samples give the same bits. `items` are
 * visited in an order drawn anew, their content is not changed. Returns 0, or -1 with the error
 * reported, also when the loss is no number any more. */
int nm_training_epoch(struct nm_training *t, const struct nm_samples *training,
                      const struct nm_samples *validation);

/* The chip as the model sees it in t->simulator.pixels, and where it fits the real one. Returns 0
 * or -1 out of memory, reported. */
int nm_training_show(struct nm_training *t, const struct nm_sample *sample,
                     struct nm_origin *origin);

/* Mean loss of the samples as they are; NaN without any or out of memory. */
double nm_training_validate(struct nm_training *t, const struct nm_samples *samples);

#endif
