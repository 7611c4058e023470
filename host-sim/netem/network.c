#include "netem/network.h"

#include <cblas.h>
#include <math.h>
#include <string.h>

static int from_count(const struct nm_network *net, int layer)
{
    return layer == 0 ? net->inputs : net->width[layer - 1];
}

static size_t layer_size(const struct nm_network *net, int layer)
{
    return (size_t)net->width[layer] * (size_t)(from_count(net, layer) + 1);
}

size_t nm_network_size(const struct nm_network *net)
{
    size_t size = 0;
    for (int l = 0; l < net->layers; l++) {
        size += layer_size(net, l);
    }
    return size;
}

static size_t activity_offset(const struct nm_network *net, int rows, int layer)
{
    size_t offset = 0;
    for (int l = 0; l < layer; l++) {
        offset += (size_t)rows * (size_t)net->width[l];
    }
    return offset;
}

size_t nm_network_activity_size(const struct nm_network *net, int rows)
{
    return activity_offset(net, rows, net->layers);
}

size_t nm_network_output_offset(const struct nm_network *net, int rows)
{
    return activity_offset(net, rows, net->layers - 1);
}

int nm_network_outputs(const struct nm_network *net)
{
    return net->width[net->layers - 1];
}

void nm_network_draw(const struct nm_network *net, double *weights, struct hs_rng *rng)
{
    for (int l = 0; l < net->layers; l++) {
        const int from = from_count(net, l);
        const double deviation = sqrt(2.0 / from);
        const size_t count = (size_t)net->width[l] * (size_t)from;
        for (size_t i = 0; i < count; i++) {
            weights[i] = deviation * hs_rng_normal(rng);
        }
        memset(weights + count, 0, (size_t)net->width[l] * sizeof *weights);
        weights += layer_size(net, l);
    }
}

static void squash(double *values, size_t count, enum nm_unit unit)
{
    for (size_t i = 0; i < count; i++) {
        switch (unit) {
        case NM_SIGMOID:
            values[i] = 1 / (1 + exp(-values[i]));
            break;
        case NM_TANH:
            values[i] = tanh(values[i]);
            break;
        case NM_RELU:
            values[i] = fmax(values[i], 0);
            break;
        case NM_LINEAR:
            break;
        }
    }
}

/* Multiply `delta` by the slope of the unit, told from its output. */
static void slope(double *delta, const double *output, size_t count, enum nm_unit unit)
{
    for (size_t i = 0; i < count; i++) {
        const double o = output[i];
        switch (unit) {
        case NM_SIGMOID:
            delta[i] *= o * (1 - o);
            break;
        case NM_TANH:
            delta[i] *= 1 - o * o;
            break;
        case NM_RELU:
            delta[i] = o > 0 ? delta[i] : 0;
            break;
        case NM_LINEAR:
            break;
        }
    }
}

static enum nm_unit unit_of(const struct nm_network *net, int layer)
{
    return layer == net->layers - 1 ? net->last : NM_RELU;
}

const double *nm_network_forward(const struct nm_network *net, const double *weights,
                                 const double *inputs, int rows, double *activity)
{
    for (int l = 0; l < net->layers; l++) {
        const int from = from_count(net, l), to = net->width[l];
        const double *bias = weights + (size_t)to * (size_t)from;
        for (int r = 0; r < rows; r++) {
            memcpy(activity + (size_t)r * (size_t)to, bias, (size_t)to * sizeof *activity);
        }
        cblas_dgemm(CblasRowMajor, CblasNoTrans, CblasTrans, rows, to, from, 1, inputs, from,
                    weights, from, 1, activity, to);
        squash(activity, (size_t)rows * (size_t)to, unit_of(net, l));
        inputs = activity;
        activity += (size_t)rows * (size_t)to;
        weights += layer_size(net, l);
    }
    return inputs;
}

/* gradient += delta' * from, and the sums of delta's columns for the biases. */
static void add_layer_gradient(const double *delta, const double *from, int rows, int from_count,
                               int to, double *gradient)
{
    cblas_dgemm(CblasRowMajor, CblasTrans, CblasNoTrans, to, from_count, rows, 1, delta, to, from,
                from_count, 1, gradient, from_count);
    double *bias = gradient + (size_t)to * (size_t)from_count;
    for (int r = 0; r < rows; r++) {
        for (int k = 0; k < to; k++) {
            bias[k] += delta[(size_t)r * (size_t)to + (size_t)k];
        }
    }
}

void nm_network_backward(const struct nm_network *net, const double *weights, const double *inputs,
                         int rows, const double *activity, double *delta, double *gradient,
                         double *d_inputs)
{
    weights += nm_network_size(net);
    gradient += nm_network_size(net);
    for (int l = net->layers - 1; l >= 0; l--) {
        const int from = from_count(net, l), to = net->width[l];
        const size_t here = activity_offset(net, rows, l);
        const size_t below = l > 0 ? activity_offset(net, rows, l - 1) : 0;
        weights -= layer_size(net, l);
        gradient -= layer_size(net, l);
        slope(delta + here, activity + here, (size_t)rows * (size_t)to, unit_of(net, l));
        add_layer_gradient(delta + here, l > 0 ? activity + below : inputs, rows, from, to,
                           gradient);
        if (l > 0 || d_inputs) {
            double *to_below = l > 0 ? delta + below : d_inputs;
            cblas_dgemm(CblasRowMajor, CblasNoTrans, CblasNoTrans, rows, from, to, 1, delta + here,
                        to, weights, from, 0, to_below, from);
        }
    }
}
