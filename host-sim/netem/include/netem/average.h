/* Mean of values over the steps of a descent (Polyak and Juditsky, "Acceleration of stochastic
 * approximation by averaging", SIAM J. Control Optim. 30, 1992). The values of each step follow
 * the speckle of the chips seen last; their mean follows it less. */
#ifndef NETEM_AVERAGE_H
#define NETEM_AVERAGE_H

#include <stddef.h>

struct nm_average {
    size_t size;
    double *mean; /* owned; zero while nothing was added */
    int count;    /* sets of values added since the last nm_average_take */
};

/* Returns 0, or -1 out of memory with the error reported. */
int nm_average_open(struct nm_average *a, size_t size);
void nm_average_close(struct nm_average *a);

/* One more set of values. */
void nm_average_add(struct nm_average *a, const double *values);

/* Put the mean in the place of `values` and begin again; `values` stay if nothing was added. */
void nm_average_take(struct nm_average *a, double *values);

#endif
