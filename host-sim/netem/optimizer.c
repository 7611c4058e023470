#include "netem/optimizer.h"

#include "hs/error.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

int nm_optimizer_open(struct nm_optimizer *o, size_t size)
{
    o->size = size;
    o->steps = 0;
    o->mean = calloc(size, sizeof *o->mean);
    o->square = calloc(size, sizeof *o->square);
    if (!o->mean || !o->square) {
        nm_optimizer_close(o);
        return hs_error("training", NULL, "out of memory");
    }
    return 0;
}

void nm_optimizer_close(struct nm_optimizer *o)
{
    free(o->mean);
    free(o->square);
    o->mean = o->square = NULL;
}

void nm_optimizer_restart(struct nm_optimizer *o)
{
    memset(o->mean, 0, o->size * sizeof *o->mean);
    memset(o->square, 0, o->size * sizeof *o->square);
    o->steps = 0;
}

static void adam(struct nm_optimizer *o, double *values, const double *gradient, size_t first,
                 size_t end)
{
    const double beta1 = 0.9, beta2 = 0.999, epsilon = 1e-8;
    const double unbias1 = 1 - pow(beta1, (double)o->steps);
    const double unbias2 = 1 - pow(beta2, (double)o->steps);
    for (size_t i = first; i < end; i++) {
        const double g = gradient[i];
        o->mean[i] = beta1 * o->mean[i] + (1 - beta1) * g;
        o->square[i] = beta2 * o->square[i] + (1 - beta2) * g * g;
        values[i] -= o->rate * (o->mean[i] / unbias1) / (sqrt(o->square[i] / unbias2) + epsilon);
    }
}

void nm_optimizer_step(struct nm_optimizer *o, double *values, const double *gradient, size_t first,
                       size_t count)
{
    o->steps++;
    if (o->method == NM_ADAM) {
        adam(o, values, gradient, first, first + count);
        return;
    }
    for (size_t i = first; i < first + count; i++) {
        o->mean[i] = o->momentum * o->mean[i] + gradient[i];
        values[i] -= o->rate * o->mean[i];
    }
}
