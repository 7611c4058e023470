#include "classify/mlp.h"

#include "hs/rng.h"

#include <cblas.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

size_t db_mlp_size(const struct db_mlp *net)
{
    const size_t hidden = (size_t)net->hidden_count;
    return hidden * (size_t)(net->input_count + 1) + (size_t)net->output_count * (hidden + 1);
}

struct db_mlp_parts db_mlp_split(const struct db_mlp *net, float *weights)
{
    struct db_mlp_parts p;
    p.hidden = weights;
    p.hidden_bias = p.hidden + (size_t)net->hidden_count * (size_t)net->input_count;
    p.output = p.hidden_bias + net->hidden_count;
    p.output_bias = p.output + (size_t)net->output_count * (size_t)net->hidden_count;
    return p;
}

static void draw_layer(float *weights, int from, int to, struct hs_rng *rng)
{
    const double limit = sqrt(6.0 / (from + to));
    for (size_t i = 0; i < (size_t)from * (size_t)to; i++) {
        weights[i] = (float)(limit * (2 * hs_rng_uniform(rng) - 1));
    }
}

int db_mlp_init(struct db_mlp *net, uint64_t seed)
{
    net->weights = calloc(db_mlp_size(net), sizeof *net->weights);
    if (!net->weights) {
        return -1;
    }
    struct hs_rng rng;
    hs_rng_seed(&rng, seed);
    const struct db_mlp_parts p = db_mlp_split(net, net->weights);
    draw_layer(p.hidden, net->input_count, net->hidden_count, &rng);
    draw_layer(p.output, net->hidden_count, net->output_count, &rng);
    return 0;
}

void db_mlp_free(struct db_mlp *net)
{
    free(net->weights);
    net->weights = NULL;
}

/* sums = from * weights' + bias, for a layer of `to_count` units. */
static void weigh(const float *from, const float *weights, const float *bias, int count,
                  int from_count, int to_count, float *sums)
{
    for (int i = 0; i < count; i++) {
        memcpy(sums + (size_t)i * (size_t)to_count, bias, (size_t)to_count * sizeof *sums);
    }
    cblas_sgemm(CblasRowMajor, CblasNoTrans, CblasTrans, count, to_count, from_count, 1, from,
                from_count, weights, from_count, 1, sums, to_count);
}

static void squash(float *values, size_t count, enum db_unit unit)
{
    for (size_t i = 0; i < count; i++) {
        values[i] = unit == DB_UNIT_TANH ? tanhf(values[i]) : 1 / (1 + expf(-values[i]));
    }
}

static void softmax(float *values, int count)
{
    float largest = values[0], sum = 0;
    for (int i = 1; i < count; i++) {
        largest = fmaxf(largest, values[i]);
    }
    for (int i = 0; i < count; i++) {
        values[i] = expf(values[i] - largest);
        sum += values[i];
    }
    for (int i = 0; i < count; i++) {
        values[i] /= sum;
    }
}

void db_mlp_forward(const struct db_mlp *net, const struct db_mlp_batch *batch)
{
    const struct db_mlp_parts p = db_mlp_split(net, net->weights);
    const size_t count = (size_t)batch->count;
    weigh(batch->inputs, p.hidden, p.hidden_bias, batch->count, net->input_count, net->hidden_count,
          batch->hidden);
    squash(batch->hidden, count * (size_t)net->hidden_count, net->unit);
    weigh(batch->hidden, p.output, p.output_bias, batch->count, net->hidden_count,
          net->output_count, batch->outputs);
    if (net->loss == DB_LOSS_SQUARE) {
        squash(batch->outputs, count * (size_t)net->output_count, DB_UNIT_SIGMOID);
        return;
    }
    for (size_t i = 0; i < count; i++) {
        softmax(batch->outputs + i * (size_t)net->output_count, net->output_count);
    }
}

/* The error at the sums that enter the output units, already divided by the batch's size. */
static void find_output_delta(const struct db_mlp *net, const struct db_mlp_batch *batch)
{
    const int outputs = net->output_count;
    const float share = 1.0f / (float)batch->count;
    for (int i = 0; i < batch->count; i++) {
        for (int k = 0; k < outputs; k++) {
            const float o = batch->outputs[i * outputs + k];
            const float error = o - (k == batch->targets[i] ? 1.0f : 0.0f);
            const float slope = net->loss == DB_LOSS_SQUARE ? o * (1 - o) : 1.0f;
            batch->output_delta[i * outputs + k] = share * error * slope;
        }
    }
}

/* gradient = delta' * from, and the sums of delta's columns for the biases. */
static void find_layer_gradient(const float *delta, const float *from, int count, int from_count,
                                int to_count, float *weights, float *bias)
{
    cblas_sgemm(CblasRowMajor, CblasTrans, CblasNoTrans, to_count, from_count, count, 1, delta,
                to_count, from, from_count, 0, weights, from_count);
    memset(bias, 0, (size_t)to_count * sizeof *bias);
    for (int i = 0; i < count; i++) {
        for (int k = 0; k < to_count; k++) {
            bias[k] += delta[i * to_count + k];
        }
    }
}

void db_mlp_backward(const struct db_mlp *net, const struct db_mlp_batch *batch, float *gradient)
{
    const struct db_mlp_parts p = db_mlp_split(net, net->weights);
    const struct db_mlp_parts g = db_mlp_split(net, gradient);
    const int hidden = net->hidden_count;
    find_output_delta(net, batch);
    find_layer_gradient(batch->output_delta, batch->hidden, batch->count, hidden, net->output_count,
                        g.output, g.output_bias);
    cblas_sgemm(CblasRowMajor, CblasNoTrans, CblasNoTrans, batch->count, hidden, net->output_count,
                1, batch->output_delta, net->output_count, p.output, hidden, 0, batch->hidden_delta,
                hidden);
    for (size_t i = 0; i < (size_t)batch->count * (size_t)hidden; i++) {
        const float h = batch->hidden[i];
        batch->hidden_delta[i] *= net->unit == DB_UNIT_TANH ? 1 - h * h : h * (1 - h);
    }
    find_layer_gradient(batch->hidden_delta, batch->inputs, batch->count, net->input_count, hidden,
                        g.hidden, g.hidden_bias);
}

double db_mlp_loss(const struct db_mlp *net, const struct db_mlp_batch *batch)
{
    double sum = 0;
    for (int i = 0; i < batch->count; i++) {
        const float *o = batch->outputs + (size_t)i * (size_t)net->output_count;
        if (net->loss == DB_LOSS_CROSS_ENTROPY) {
            sum -= log(fmax((double)o[batch->targets[i]], 1e-30));
            continue;
        }
        for (int k = 0; k < net->output_count; k++) {
            const double error = (double)o[k] - (k == batch->targets[i]);
            sum += 0.5 * error * error;
        }
    }
    return sum / batch->count;
}

int db_mlp_default_hidden(int input_count, int output_count)
{
    enum { MOST = 128 };
    const long product = (long)input_count * output_count;
    return product < MOST ? (int)product : MOST;
}
