/* Training of one network on exemplars as Heaton, section "Neural network application", describes
 * it. The order is drawn again for each epoch, exemplars are corrupted by noise, and training ends
 * at a recognition goal; local minima are detected and left. */
#ifndef CLASSIFY_MLP_TRAIN_H
#define CLASSIFY_MLP_TRAIN_H

#include "classify/mlp.h"

enum { DB_EPOCHS_MAX = 10000, DB_EVENTS_MAX = 64 };

struct db_train_options {
    double rate;     /* of learning, > 0 */
    double momentum; /* 0..1, exclusive of 1 */
    double decay;    /* of the weights: part of a weight taken from its gradient, >= 0 */
    double noise;    /* standard deviation of the noise, in deviations of each input */
    double goal;     /* mean over the classes of the part recognised, 0..1: stop there */
    int batch;       /* exemplars between two changes of weights */
    int epochs;      /* at most; 1..DB_EPOCHS_MAX */
    int patience;    /* epochs without a better result or a falling error that make a plateau */
    uint64_t seed;
};

/* Inputs are normalised; targets are output indices. */
struct db_train_data {
    const float *inputs; /* borrowed; count x inputs, row-major */
    const uint8_t *targets;
    size_t count;
};

enum db_train_stop { DB_STOP_GOAL, DB_STOP_EPOCHS, DB_STOP_PLATEAU };

struct db_epoch {
    double rms;         /* error over all outputs of the clean training exemplars */
    double recognition; /* mean over the classes, 0..1, of the clean training exemplars */
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
};

/* Train `net` from its present weights; on return it holds the best met: by validation recognition
 * when `validation` has exemplars, else by training recognition, the error deciding between equals.
 *
 * Each epoch presents as many exemplars as there are, each class equally often: those of rare
 * classes repeatedly, those of frequent ones in turn. A plateau is `patience` epochs in which
 * neither the result nor the error improved. When exemplars of high and of low error alternate on
 * it, a local minimum is recorded and acted on: the rate is halved, then rate and momentum, then
 * the noise is doubled, then the weights are drawn anew. Otherwise, or after the last of these,
 * training ends.
 *
 * The same data, options and seed give the same weights on the same machine. Returns 0, or -1 out
 * of memory with the error reported. `report` is to be freed either way. */
int db_mlp_train(struct db_mlp *net, const struct db_train_options *options,
                 const struct db_train_data *training, const struct db_train_data *validation,
                 struct db_train_report *report);

/* Harmless on a zeroed struct. */
void db_train_report_free(struct db_train_report *report);

/* Mean over the classes of the part of `data` that the network recognises, and the RMS error over
 * all outputs if `rms` is not NULL. Returns NaN without exemplars or out of memory. */
double db_mlp_recognition(const struct db_mlp *net, const struct db_train_data *data, double *rms);

#endif
