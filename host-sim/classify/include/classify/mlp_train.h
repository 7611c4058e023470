/* Training of one network on exemplars as Heaton, section "Neural network application", describes
 * it. The order is drawn again for each epoch, exemplars are corrupted by noise, and training ends
 * at a recognition goal; local minima are detected and left. */
#ifndef CLASSIFY_MLP_TRAIN_H
#define CLASSIFY_MLP_TRAIN_H

#include "classify/mlp.h"

#include <stdbool.h>

enum { DB_EPOCHS_MAX = 10000, DB_EVENTS_MAX = 64 };

struct db_train_options {
    double rate;     /* of learning, > 0 */
    double momentum; /* 0..1, exclusive of 1 */
    double decay;    /* of the weights: part of a weight taken from its gradient, >= 0; NaN:
                      * db_default_decay */
    double noise;    /* standard deviation of the noise, in deviations of each input */
    double goal;     /* recognition (struct db_epoch) that a plateau must have to be no minimum */
    int batch;       /* exemplars between two changes of weights */
    int epochs;      /* at most; 1..DB_EPOCHS_MAX */
    int patience;    /* epochs without progress that make a plateau */
    int redraws;     /* how often the weights may be drawn anew, >= 0 */
    uint64_t seed;
    bool is_quiet; /* shows no progress: other networks are trained at the same time */
};

/* Decay for a network of so many weights and so many exemplars, >= 1. Up to 0.3 weights for each
 * exemplar it needs none; from 0.6 on, where it could learn its exemplars by heart, it gets
 * DB_DECAY_MOST (docs/classifier.md, "Measured"). UNSOURCED. */
#define DB_DECAY_MOST 5e-5
double db_default_decay(size_t weights, size_t exemplars);

/* Inputs are normalised; targets are output indices. */
struct db_train_data {
    const float *inputs; /* borrowed; count x inputs, row-major */
    const uint8_t *targets;
    size_t count;
    const double *priors; /* borrowed: how often each output is the right one; NULL: equally */
};

enum db_train_stop { DB_STOP_GOAL, DB_STOP_EPOCHS, DB_STOP_PLATEAU };

struct db_epoch {
    double rms;         /* error over all outputs of the clean training exemplars */
    double recognition; /* part of the clean training exemplars recognised, 0..1: the mean over the
                         * classes that occur, weighted by their priors */
    double validation;  /* the same of the validation exemplars; NaN without any */
    double alternation; /* how often an exemplar of low error followed one of high error or the
                         * other way round, as a part of those presented */
};

struct db_train_event {
    int epoch;
    char text[120];
};

struct db_train_report {
    struct db_epoch *epochs; /* owned; item i is the state after epoch i + 1 */
    int epoch_count;
    int best_epoch; /* from 1: whose weights were kept */
    enum db_train_stop stop;
    struct db_train_event events[DB_EVENTS_MAX]; /* local minima met, and what was done */
    int event_count;
    double decay; /* of the weights, also where it was left to db_default_decay */
};

/* Train `net` from its present weights; on return it holds the best met: by validation recognition
 * when `validation` has exemplars, else by training recognition, the error deciding between equals.
 *
 * Each epoch presents as many exemplars as there are, at least 512, each class as often as
 * `training->priors` say: exemplars of a class in turn, in a new order each time round.
 *
 * Progress is a recognition that rose by 0.2 points, or an error that fell by 1 %, since progress
 * was last made; with validation exemplars only the former. A plateau is `patience` epochs without.
 * Each is recorded and acted on: the rate is halved, then rate and momentum are lowered, then the
 * noise is doubled, then the weights are drawn anew and all begins again. If the goal is reached
 * training ends after the second, which let the weights settle; it ends at once if validation
 * stands while the error still falls, and on the plateau that finds no redraw left.
 *
 * What is judged and kept is the mean of the weights over an epoch.
 *
 * The same data, options and seed give the same weights on the same machine, also where several
 * networks are trained at the same time. Returns 0, or -1 out of memory. `report` is to be freed
 * either way. */
int db_mlp_train(struct db_mlp *net, const struct db_train_options *options,
                 const struct db_train_data *training, const struct db_train_data *validation,
                 struct db_train_report *report);

/* Harmless on a zeroed struct. */
void db_train_report_free(struct db_train_report *report);

/* The recognition of `data` as in struct db_epoch, and the RMS error over all outputs if `rms` is
 * not NULL. Returns NaN without exemplars or out of memory. */
double db_mlp_recognition(const struct db_mlp *net, const struct db_train_data *data, double *rms);

#endif
