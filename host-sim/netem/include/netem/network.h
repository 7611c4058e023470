/* Feed-forward network applied to each ray by itself, which is what a stack of 1x1 convolutions
 * over the multichannel "images" amounts to (Niu, Fig. 9). One row of a matrix is one ray; the
 * layers are matrix products. Double precision, so that gradients can be proved by finite
 * differences. */
#ifndef NETEM_NETWORK_H
#define NETEM_NETWORK_H

#include "hs/rng.h"

#include <stddef.h>

enum nm_unit { NM_LINEAR, NM_SIGMOID, NM_TANH, NM_RELU };
enum { NM_LAYERS_MAX = 6 };

/* Hidden layers are ReLU (Tables III and IV); `last` is the unit of the outputs. */
struct nm_network {
    int inputs;
    int layers;               /* 1..NM_LAYERS_MAX, the output layer included */
    int width[NM_LAYERS_MAX]; /* units of each */
    enum nm_unit last;
};

/* Number of weights: for each layer a matrix of width x previous width, row-major, then one bias a
 * unit. */
size_t nm_network_size(const struct nm_network *net);

/* Number of activities of `rows` rays, all layers together. */
size_t nm_network_activity_size(const struct nm_network *net, int rows);

/* Width of the output layer. */
int nm_network_outputs(const struct nm_network *net);

/* Draws weights of variance 2 / previous width (He et al., ICCV 2015, eq. 10, for ReLU layers);
 * biases are zero. */
void nm_network_draw(const struct nm_network *net, double *weights, struct hs_rng *rng);

/* `inputs` holds rows x net->inputs numbers; `activity`, as many as nm_network_activity_size says,
 * receives the layers one after the other. Returns the outputs, rows x nm_network_outputs, which
 * lie in `activity`. */
const double *nm_network_forward(const struct nm_network *net, const double *weights,
                                 const double *inputs, int rows, double *activity);

/* After the forward pass: adds to `gradient`, laid out as the weights, the derivative of a loss by
 * each weight. `delta` has the size of `activity`; on entry the place of its outputs holds the
 * derivative of the loss by each output, on return all of it is spent. `d_inputs`, rows x
 * net->inputs, receives the derivative by each input; NULL: nobody asks. */
void nm_network_backward(const struct nm_network *net, const double *weights, const double *inputs,
                         int rows, const double *activity, double *delta, double *gradient,
                         double *d_inputs);

/* Index of the first output in an array laid out as the activities. */
size_t nm_network_output_offset(const struct nm_network *net, int rows);

#endif
