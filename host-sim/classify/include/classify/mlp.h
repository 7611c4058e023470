/* Multilayer perceptron: the feed-forward network of Heaton (section "Database preparation
 * overview", figure 3) with one hidden layer, trained by back-propagation of the error (Rumelhart,
 * Hinton and Williams, Nature 323, 1986, p. 533).
 *
 * All matrices are row-major; a batch holds one exemplar a row. Single precision throughout. */
#ifndef CLASSIFY_MLP_H
#define CLASSIFY_MLP_H

#include <stddef.h>
#include <stdint.h>

enum db_unit { DB_UNIT_TANH, DB_UNIT_SIGMOID };
enum db_loss {
    DB_LOSS_SQUARE,       /* sigmoid outputs, mean of half the squared errors: Heaton's */
    DB_LOSS_CROSS_ENTROPY /* softmax outputs, mean of -ln of the right one */
};

struct db_mlp {
    int input_count, hidden_count, output_count;
    enum db_unit unit; /* of the hidden layer */
    enum db_loss loss;
    float *weights; /* owned: hidden x input, hidden biases, output x hidden, output biases */
};

/* How many numbers `weights` holds. */
size_t db_mlp_size(const struct db_mlp *net);

/* The four parts of an array laid out as `weights`. */
struct db_mlp_parts {
    float *hidden, *hidden_bias, *output, *output_bias;
};
struct db_mlp_parts db_mlp_split(const struct db_mlp *net, float *weights);

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
    float *hidden;          /* count x hidden */
    float *outputs;         /* count x outputs: in 0..1 */
    float *hidden_delta;    /* count x hidden; scratch of the backward pass */
    float *output_delta;    /* count x outputs; scratch of the backward pass */
};

/* Fill `hidden` and `outputs` from `inputs`. */
void db_mlp_forward(const struct db_mlp *net, const struct db_mlp_batch *batch);

/* After the forward pass: the gradient of the mean loss over the batch, laid out as `weights`. */
void db_mlp_backward(const struct db_mlp *net, const struct db_mlp_batch *batch, float *gradient);

/* The mean loss over the batch after the forward pass. */
double db_mlp_loss(const struct db_mlp *net, const struct db_mlp_batch *batch);

/* Hidden units unless told: inputs x outputs (Heaton, "a conservative starting point" for three
 * bands), at most 128, beyond which many-banded images gain nothing that was measurable and lose
 * speed. */
int db_mlp_default_hidden(int input_count, int output_count);

#endif
