/* Multilayer perceptron: the feed-forward network of Heaton (section "Database preparation
 * overview", figure 3) with one or more hidden layers, trained by back-propagation of the error
 * (Rumelhart, Hinton and Williams, Nature 323, 1986, p. 533).
 *
 * All matrices are row-major; a batch holds one exemplar a row. Single precision throughout. */
#ifndef CLASSIFY_MLP_H
#define CLASSIFY_MLP_H

#include "classify/units.h"

#include <stddef.h>
#include <stdint.h>

enum db_loss {
    DB_LOSS_SQUARE,       /* sigmoid outputs, mean of half the squared errors: Heaton's */
    DB_LOSS_CROSS_ENTROPY /* softmax outputs, mean of -ln of the right one */
};

enum { DB_LAYERS_MAX = 4 /* hidden ones */ };

struct db_mlp {
    int input_count, output_count;
    int layer_count;           /* hidden layers, 1..DB_LAYERS_MAX */
    int hidden[DB_LAYERS_MAX]; /* units of each, >= 1 */
    enum db_unit unit;         /* of the hidden layers */
    enum db_loss loss;
    float *weights; /* owned; of each layer, the outputs last: its units x those that feed it, then
                     * its biases */
};

/* How many numbers `weights` holds. */
size_t db_mlp_size(const struct db_mlp *net);

/* Units of all hidden layers together. */
int db_mlp_hidden_total(const struct db_mlp *net);

/* One layer of an array laid out as `weights`: `to` units that `from` values feed. */
struct db_mlp_layer {
    float *weights, *bias; /* to x from; to */
    int from, to;
};

/* Layer 0..layer_count; the last is that of the outputs. */
struct db_mlp_layer db_mlp_layer(const struct db_mlp *net, float *weights, int layer);

/* Fill in the counts first. Draws the weights evenly from +-sqrt(6 / (inputs + outputs of the
 * layer)) (Glorot and Bengio, AISTATS 2010, eq. 16); biases are zero. Returns 0, or -1 out of
 * memory. */
int db_mlp_init(struct db_mlp *net, uint64_t seed);

/* Free the weights. Harmless on a zeroed struct. */
void db_mlp_free(struct db_mlp *net);

/* Activities of one batch; the caller owns the arrays. */
struct db_mlp_batch {
    int count;
    const float *inputs;    /* count x inputs */
    const uint8_t *targets; /* index of the right output of each; unused by the forward pass */
    float *hidden;          /* count x units of each hidden layer, layer after layer */
    float *outputs;         /* count x outputs: in 0..1 */
    float *hidden_delta;    /* as `hidden`; scratch of the backward pass */
    float *output_delta;    /* count x outputs; scratch of the backward pass */
};

/* Fill `hidden` and `outputs` from `inputs`. */
void db_mlp_forward(const struct db_mlp *net, const struct db_mlp_batch *batch);

/* After the forward pass: the gradient of the mean loss over the batch, laid out as `weights`. */
void db_mlp_backward(const struct db_mlp *net, const struct db_mlp_batch *batch, float *gradient);

/* The mean loss over the batch after the forward pass. */
double db_mlp_loss(const struct db_mlp *net, const struct db_mlp_batch *batch);

/* Units of the one hidden layer unless told, from three rules:
 * - inputs x outputs (Heaton, "a conservative starting point" for three bands),
 * - more than three times the inputs (Lippmann, after Heaton), which two classes would miss,
 * - at least DB_HIDDEN_LEAST: one band of two classes that alternate needs more than two.
 * Above DB_HIDDEN_MOST units only time was lost (docs/classifier.md, "Hidden units"), so there it
 * ends, and `wanted`, unless NULL, receives what the rules asked for. */
enum { DB_HIDDEN_LEAST = 8, DB_HIDDEN_MOST = 128 };
int db_mlp_default_hidden(int input_count, int output_count, long *wanted);

#endif
