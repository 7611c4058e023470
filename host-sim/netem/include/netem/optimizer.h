/* Optimizer: weights changed along a gradient by Adam (Kingma and Ba, ICLR 2015, algorithm 1) or
 * by stochastic gradient descent with momentum. */
#ifndef NETEM_OPTIMIZER_H
#define NETEM_OPTIMIZER_H

#include <stddef.h>

enum nm_method { NM_ADAM, NM_SGD };

struct nm_optimizer {
    enum nm_method method;
    double rate;     /* > 0 */
    double momentum; /* of SGD, 0..1; Adam has beta1 0.9, beta2 0.999 */
    size_t size;
    double *mean, *square; /* owned: running averages of the gradient and its square */
    long steps;            /* since the last restart */
};

/* Set method, rate and momentum first. Returns 0, or -1 out of memory with the error reported. */
int nm_optimizer_open(struct nm_optimizer *o, size_t size);
void nm_optimizer_close(struct nm_optimizer *o);

/* Forget what was averaged, as when other values are released for training. */
void nm_optimizer_restart(struct nm_optimizer *o);

/* Change values[first .. first + count) along the gradient. */
void nm_optimizer_step(struct nm_optimizer *o, double *values, const double *gradient, size_t first,
                       size_t count);

#endif
