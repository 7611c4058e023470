#include "netem/netem.h"

#include "hs/error.h"

#include <stdlib.h>
#include <string.h>

enum { ROW_ACTIVITY_MAX = 256 }; /* all units of the largest of nm_architectures */

static int reserve(double **array, size_t count)
{
    free(*array);
    *array = malloc((count + 1) * sizeof **array);
    return *array ? 0 : hs_error("networks", "trace with fewer rays", "out of memory");
}

static int make_room(struct nm_netem *em, const struct nm_paths *paths)
{
    for (int d = 0; d < NM_DIRECTIONS; d++) {
        const size_t inputs =
            (size_t)paths->rows[d] * (size_t)em->architecture->network.inputs + NM_INPUTS_MAX;
        if (inputs >= em->feature_capacity[d]) {
            em->feature_capacity[d] = 0;
            if (reserve(&em->features[d], inputs) != 0) {
                return -1;
            }
            em->feature_capacity[d] = inputs + 1;
        }
        const size_t need = nm_network_activity_size(&em->architecture->network, paths->rows[d]);
        if (need >= em->capacity[d]) {
            em->capacity[d] = 0;
            if (reserve(&em->activity[d], need) != 0 || reserve(&em->delta[d], need) != 0) {
                return -1;
            }
            em->capacity[d] = need + 1;
        }
    }
    const size_t rows = (size_t)paths->rows[NM_BK];
    if (em->architecture->wiring == NM_TWO_OUTPUTS && rows >= em->split_capacity) {
        em->split_capacity = 0;
        for (int i = 0; i < 2 * NM_DIRECTIONS; i++) {
            if (reserve(&em->split[i], rows) != 0) {
                return -1;
            }
        }
        em->split_capacity = rows + 1;
    }
    return 0;
}

static void make_features(struct nm_netem *em, const struct nm_paths *paths, int d)
{
    const size_t inputs = (size_t)em->architecture->network.inputs;
    for (int r = 0; r < paths->rows[d]; r++) {
        nm_features_of(em->architecture, &paths->table[d][r], em->features[d] + (size_t)r * inputs);
    }
}

/* Where the weights of the network for a direction begin. */
static size_t weights_of(const struct nm_architecture *a, enum nm_direction direction)
{
    return a->wiring == NM_TWO_NETWORKS && direction == NM_SP ? nm_network_size(&a->network) : 0;
}

static void split_outputs(const double *outputs, int rows, double *bk, double *sp)
{
    for (int r = 0; r < rows; r++) {
        bk[r] = outputs[2 * r];
        sp[r] = outputs[2 * r + 1];
    }
}

int nm_netem_forward(struct nm_netem *em, const double *weights, const struct nm_paths *paths,
                     struct nm_coefficients *c)
{
    const struct nm_architecture *a = em->architecture;
    if (make_room(em, paths) != 0) {
        return -1;
    }
    const double *out[NM_DIRECTIONS] = {NULL};
    const int networks = a->wiring == NM_TWO_OUTPUTS ? 1 : NM_DIRECTIONS;
    for (int d = 0; d < networks; d++) {
        make_features(em, paths, d);
        out[d] = nm_network_forward(&a->network, weights + weights_of(a, (enum nm_direction)d),
                                    em->features[d], paths->rows[d], em->activity[d]);
    }
    *c = (struct nm_coefficients){out[NM_BK], out[NM_SP], NM_SP};
    if (a->wiring == NM_TWO_OUTPUTS) {
        split_outputs(out[NM_BK], paths->rows[NM_BK], em->split[NM_BK], em->split[NM_SP]);
        *c = (struct nm_coefficients){em->split[NM_BK], em->split[NM_SP], NM_BK};
    }
    return 0;
}

/* The derivative by two outputs, put together again. */
static void join_outputs(const double *bk, const double *sp, int rows, double *outputs)
{
    for (int r = 0; r < rows; r++) {
        outputs[2 * r] = bk[r];
        outputs[2 * r + 1] = sp[r];
    }
}

static void two_outputs_backward(struct nm_netem *em, const double *weights,
                                 const struct nm_paths *paths, const struct nm_coefficients *c,
                                 const double *d_image, double *gradient)
{
    const struct nm_network *net = &em->architecture->network;
    const int rows = paths->rows[NM_BK];
    double *bk = em->split[NM_DIRECTIONS + NM_BK], *sp = em->split[NM_DIRECTIONS + NM_SP];
    memset(bk, 0, (size_t)rows * sizeof *bk);
    memset(sp, 0, (size_t)rows * sizeof *sp);
    nm_paths_backward(paths, c, d_image, bk, sp);
    join_outputs(bk, sp, rows, em->delta[NM_BK] + nm_network_output_offset(net, rows));
    nm_network_backward(net, weights, em->features[NM_BK], rows, em->activity[NM_BK],
                        em->delta[NM_BK], gradient);
}

void nm_netem_backward(struct nm_netem *em, const double *weights, const struct nm_paths *paths,
                       const struct nm_coefficients *c, const double *d_image, double *gradient)
{
    const struct nm_architecture *a = em->architecture;
    if (a->wiring == NM_TWO_OUTPUTS) {
        two_outputs_backward(em, weights, paths, c, d_image, gradient);
        return;
    }
    double *at[NM_DIRECTIONS];
    for (int d = 0; d < NM_DIRECTIONS; d++) {
        at[d] = em->delta[d] + nm_network_output_offset(&a->network, paths->rows[d]);
        memset(at[d], 0, (size_t)paths->rows[d] * sizeof *at[d]);
    }
    nm_paths_backward(paths, c, d_image, at[NM_BK], at[NM_SP]);
    for (int d = 0; d < NM_DIRECTIONS; d++) {
        const size_t offset = weights_of(a, (enum nm_direction)d);
        nm_network_backward(&a->network, weights + offset, em->features[d], paths->rows[d],
                            em->activity[d], em->delta[d], gradient + offset);
    }
}

double nm_netem_ask(const struct nm_architecture *a, const double *weights,
                    const struct nm_reflection *reflection, enum nm_direction direction)
{
    double features[NM_INPUTS_MAX], activity[ROW_ACTIVITY_MAX];
    nm_features_of(a, reflection, features);
    const double *out =
        nm_network_forward(&a->network, weights + weights_of(a, direction), features, 1, activity);
    return out[a->wiring == NM_TWO_OUTPUTS ? direction : 0];
}

void nm_netem_free(struct nm_netem *em)
{
    for (int d = 0; d < NM_DIRECTIONS; d++) {
        free(em->features[d]);
        free(em->activity[d]);
        free(em->delta[d]);
        free(em->split[d]);
        free(em->split[NM_DIRECTIONS + d]);
    }
    *em = (struct nm_netem){0};
}
