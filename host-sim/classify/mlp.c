#include "classify/mlp.h"

#include "hs/rng.h"

#include <cblas.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

int db_mlp_hidden_total(const struct db_mlp *net)
{
    int total = 0;
    for (int l = 0; l < net->layer_count; l++) {
        total += net->hidden[l];
    }
    return total;
}

struct db_mlp_layer db_mlp_layer(const struct db_mlp *net, float *weights, int layer)
{
    struct db_mlp_layer l = {.weights = weights, .from = net->input_count};
    for (int i = 0; i < layer; i++) {
        l.weights += (size_t)net->hidden[i] * (size_t)(l.from + 1);
        l.from = net->hidden[i];
    }
    l.to = layer < net->layer_count ? net->hidden[layer] : net->output_count;
    l.bias = l.weights + (size_t)l.to * (size_t)l.from;
    return l;
}

size_t db_mlp_size(const struct db_mlp *net)
{
    size_t size = 0;
    int from = net->input_count;
    for (int i = 0; i <= net->layer_count; i++) {
        const int to = i < net->layer_count ? net->hidden[i] : net->output_count;
        size += (size_t)to * (size_t)(from + 1);
        from = to;
    }
    return size;
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
    for (int i = 0; i <= net->layer_count; i++) {
        const struct db_mlp_layer l = db_mlp_layer(net, net->weights, i);
        draw_layer(l.weights, l.from, l.to, &rng);
    }
    return 0;
}

void db_mlp_free(struct db_mlp *net)
{
    free(net->weights);
    net->weights = NULL;
}

/* sums = from * weights' + bias. */
static void weigh(const float *from, const struct db_mlp_layer *l, int count, float *sums)
{
    for (int i = 0; i < count; i++) {
        memcpy(sums + (size_t)i * (size_t)l->to, l->bias, (size_t)l->to * sizeof *sums);
    }
    cblas_sgemm(CblasRowMajor, CblasNoTrans, CblasTrans, count, l->to, l->from, 1, from, l->from,
                l->weights, l->from, 1, sums, l->to);
}

/* Outputs are compared with 0 and 1: what is far off must still tell a slope. */
static void sigmoid(float *values, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        values[i] = 1 / (1 + expf(-values[i]));
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
    const size_t count = (size_t)batch->count;
    const float *from = batch->inputs;
    float *to = batch->hidden;
    for (int i = 0; i < net->layer_count; i++) {
        const struct db_mlp_layer l = db_mlp_layer(net, net->weights, i);
        weigh(from, &l, batch->count, to);
        db_units_say(net->unit, to, count * (size_t)l.to);
        from = to;
        to += count * (size_t)l.to;
    }
    const struct db_mlp_layer last = db_mlp_layer(net, net->weights, net->layer_count);
    weigh(from, &last, batch->count, batch->outputs);
    if (net->loss == DB_LOSS_SQUARE) {
        sigmoid(batch->outputs, count * (size_t)net->output_count);
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

/* The layer's part of the gradient = delta' * from, and the sums of delta's columns for the biases.
 */
static void find_layer_gradient(const float *delta, const float *from, int count,
                                const struct db_mlp_layer *g)
{
    cblas_sgemm(CblasRowMajor, CblasTrans, CblasNoTrans, g->to, g->from, count, 1, delta, g->to,
                from, g->from, 0, g->weights, g->from);
    memset(g->bias, 0, (size_t)g->to * sizeof *g->bias);
    for (int i = 0; i < count; i++) {
        for (int k = 0; k < g->to; k++) {
            g->bias[k] += delta[i * g->to + k];
        }
    }
}

/* The error at the sums that enter the units of the layer below: theirs times their slope. */
static void pass_down(const struct db_mlp *net, const struct db_mlp_layer *l, int count,
                      const float *delta, const float *below, float *delta_below)
{
    cblas_sgemm(CblasRowMajor, CblasNoTrans, CblasNoTrans, count, l->from, l->to, 1, delta, l->to,
                l->weights, l->from, 0, delta_below, l->from);
    for (size_t i = 0; i < (size_t)count * (size_t)l->from; i++) {
        const float h = below[i];
        delta_below[i] *= net->unit == DB_UNIT_TANH ? 1 - h * h : h * (1 - h);
    }
}

void db_mlp_backward(const struct db_mlp *net, const struct db_mlp_batch *batch, float *gradient)
{
    const float *delta = batch->output_delta;
    size_t end = (size_t)batch->count * (size_t)db_mlp_hidden_total(net);
    find_output_delta(net, batch);
    for (int i = net->layer_count; i > 0; i--) {
        const struct db_mlp_layer l = db_mlp_layer(net, net->weights, i);
        const struct db_mlp_layer g = db_mlp_layer(net, gradient, i);
        end -= (size_t)batch->count * (size_t)l.from;
        find_layer_gradient(delta, batch->hidden + end, batch->count, &g);
        pass_down(net, &l, batch->count, delta, batch->hidden + end, batch->hidden_delta + end);
        delta = batch->hidden_delta + end;
    }
    const struct db_mlp_layer g = db_mlp_layer(net, gradient, 0);
    find_layer_gradient(delta, batch->inputs, batch->count, &g);
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

int db_mlp_default_hidden(int input_count, int output_count, long *wanted)
{
    long rule = (long)input_count * output_count;
    rule = rule > 3L * input_count ? rule : 3L * input_count + 1;
    rule = rule > DB_HIDDEN_LEAST ? rule : DB_HIDDEN_LEAST;
    if (wanted) {
        *wanted = rule;
    }
    return rule < DB_HIDDEN_MOST ? (int)rule : DB_HIDDEN_MOST;
}
