#include "netem/average.h"

#include "hs/error.h"

#include <stdlib.h>
#include <string.h>

int nm_average_open(struct nm_average *a, size_t size)
{
    *a = (struct nm_average){.size = size, .mean = calloc(size, sizeof *a->mean)};
    return a->mean ? 0 : hs_error("training", NULL, "out of memory");
}

void nm_average_close(struct nm_average *a)
{
    free(a->mean);
    a->mean = NULL;
}

void nm_average_add(struct nm_average *a, const double *values)
{
    a->count++;
    for (size_t i = 0; i < a->size; i++) {
        a->mean[i] += (values[i] - a->mean[i]) / a->count;
    }
}

void nm_average_take(struct nm_average *a, double *values)
{
    if (a->count == 0) {
        return;
    }
    memcpy(values, a->mean, a->size * sizeof *values);
    memset(a->mean, 0, a->size * sizeof *a->mean);
    a->count = 0;
}
