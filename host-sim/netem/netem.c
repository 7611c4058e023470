#include "netem/netem.h"

#include "hs/error.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { ROW_ACTIVITY_MAX = 256 }; /* all units of the largest of nm_architectures */

/* Some rows of a table, all of which one matrix product asks. */
struct span {
    int begin, end;
};

/* ---- room ---- */

static int reserve(double **array, size_t count)
{
    free(*array);
    *array = malloc((count + 1) * sizeof **array);
    return *array ? 0 : hs_error("networks", "trace with fewer rays", "out of memory");
}

static int make_room_for(struct nm_netem *em, int d, size_t rows)
{
    const struct nm_network *net = &em->architecture->network;
    const size_t inputs = rows * (size_t)net->inputs + NM_INPUTS_MAX;
    const size_t units = rows * nm_network_activity_size(net, 1);
    if (rows < em->capacity[d]) {
        return 0;
    }
    em->capacity[d] = 0;
    if (reserve(&em->features[d], inputs) != 0 || reserve(&em->d_features[d], inputs) != 0 ||
        reserve(&em->activity[d], units) != 0 || reserve(&em->delta[d], units) != 0 ||
        reserve(&em->out[d], rows) != 0 || reserve(&em->d_out[d], rows) != 0) {
        return -1;
    }
    em->capacity[d] = rows + 1;
    return 0;
}

/* The table that the specular outputs go by. */
static enum nm_direction sp_by(const struct nm_architecture *a)
{
    return a->wiring == NM_TWO_OUTPUTS ? NM_BK : NM_SP;
}

static int make_room(struct nm_netem *em, const struct nm_paths *paths)
{
    return make_room_for(em, NM_BK, (size_t)paths->rows[NM_BK]) == 0
               ? make_room_for(em, NM_SP, (size_t)paths->rows[sp_by(em->architecture)])
               : -1;
}

/* ---- which rows, which weights ---- */

static bool is_chained(const struct nm_architecture *a)
{
    return a->connection == NM_BY_INTENSITY;
}

/* Outputs that are inputs of the next bounce come before it. */
static int span_count(const struct nm_architecture *a)
{
    return is_chained(a) ? TRACE_BOUNCES_MAX : 1;
}

static struct span span_of(const struct nm_architecture *a, const struct nm_paths *p, int d, int b)
{
    return is_chained(a) ? (struct span){b > 0 ? p->until[d][b - 1] : 0, p->until[d][b]}
                         : (struct span){0, p->rows[d]};
}

/* Networks that are asked: one gives both directions by the echo's rows. */
static int asked(const struct nm_architecture *a)
{
    return a->wiring == NM_TWO_OUTPUTS ? 1 : NM_DIRECTIONS;
}

/* Where the weights of the network for a direction begin. */
static size_t weights_of(const struct nm_architecture *a, int direction)
{
    return a->wiring == NM_TWO_NETWORKS && direction == NM_SP ? nm_network_size(&a->network) : 0;
}

/* ---- forward ---- */

/* What arrives at a row: the specular output of the reflection before. */
static double arriving(const struct nm_netem *em, const struct nm_paths *paths, int d, int row)
{
    if (!is_chained(em->architecture) || paths->from[d][row].row[NM_BK] < 0) {
        return 1;
    }
    return em->out[NM_SP][paths->from[d][row].row[sp_by(em->architecture)]];
}

static void make_features(struct nm_netem *em, const struct nm_paths *paths, int d, struct span s)
{
    const size_t inputs = (size_t)em->architecture->network.inputs;
    for (int r = s.begin; r < s.end; r++) {
        nm_features_of(em->architecture, &paths->table[d][r], arriving(em, paths, d, r),
                       em->features[d] + (size_t)r * inputs);
    }
}

/* The outputs of a span to their rows, both of them where a network has two. */
static void take_outputs(struct nm_netem *em, int d, struct span s, const double *outputs)
{
    const int count = s.end - s.begin;
    if (em->architecture->wiring != NM_TWO_OUTPUTS) {
        memcpy(em->out[d] + s.begin, outputs, (size_t)count * sizeof *outputs);
        return;
    }
    for (int r = 0; r < count; r++) {
        em->out[NM_BK][s.begin + r] = outputs[2 * r];
        em->out[NM_SP][s.begin + r] = outputs[2 * r + 1];
    }
}

static void ask_span(struct nm_netem *em, const double *weights, const struct nm_paths *paths,
                     int d, struct span s)
{
    const struct nm_network *net = &em->architecture->network;
    const size_t begin = (size_t)s.begin;
    make_features(em, paths, d, s);
    const double *outputs =
        nm_network_forward(net, weights + weights_of(em->architecture, d),
                           em->features[d] + begin * (size_t)net->inputs, s.end - s.begin,
                           em->activity[d] + begin * nm_network_activity_size(net, 1));
    take_outputs(em, d, s, outputs);
}

int nm_netem_forward(struct nm_netem *em, const double *weights, const struct nm_paths *paths,
                     struct nm_coefficients *c)
{
    const struct nm_architecture *a = em->architecture;
    if (is_chained(a) && paths->connection != NM_BY_INTENSITY) {
        return hs_error("networks", NULL, "the paths were not built for handing intensities on");
    }
    if (make_room(em, paths) != 0) {
        return -1;
    }
    for (int b = 0; b < span_count(a); b++) {
        for (int d = 0; d < asked(a); d++) {
            ask_span(em, weights, paths, d, span_of(a, paths, d, b));
        }
    }
    *c = (struct nm_coefficients){em->out[NM_BK], em->out[NM_SP], sp_by(a), a->connection};
    return 0;
}

/* ---- what is handed on ---- */

/* Rows whose specular outputs are held; those of the last reflections go nowhere, and do no harm.
 */
static int held_rows(const struct nm_architecture *a, const struct nm_paths *paths)
{
    return is_chained(a) && a->network.last == NM_SIGMOID ? paths->rows[sp_by(a)] : 0;
}

/* A little off the ends, which rounding reaches. */
static double held(double output)
{
    return fmin(fmax(output, 1e-12), 1 - 1e-12);
}

double nm_netem_hold(const struct nm_netem *em, const struct nm_paths *paths)
{
    const int rows = held_rows(em->architecture, paths);
    double sum = 0;
    for (int r = 0; r < rows; r++) {
        const double o = held(em->out[NM_SP][r]);
        sum -= log(4 * o * (1 - o)) / rows;
    }
    return sum;
}

/* Its derivatives, times its weight. */
static void add_hold(struct nm_netem *em, const struct nm_paths *paths)
{
    const int rows = em->hold > 0 ? held_rows(em->architecture, paths) : 0;
    for (int r = 0; r < rows; r++) {
        const double o = held(em->out[NM_SP][r]);
        em->d_out[NM_SP][r] += em->hold * (2 * o - 1) / (o * (1 - o)) / rows;
    }
}

/* ---- backward ---- */

/* The derivatives by the outputs of a span to where the network wants them. */
static void give_outputs(const struct nm_netem *em, int d, struct span s, double *outputs)
{
    const int count = s.end - s.begin;
    if (em->architecture->wiring != NM_TWO_OUTPUTS) {
        memcpy(outputs, em->d_out[d] + s.begin, (size_t)count * sizeof *outputs);
        return;
    }
    for (int r = 0; r < count; r++) {
        outputs[2 * r] = em->d_out[NM_BK][s.begin + r];
        outputs[2 * r + 1] = em->d_out[NM_SP][s.begin + r];
    }
}

/* The derivatives by what arrived, added to those by the specular outputs that it came from. */
static void hand_back(struct nm_netem *em, const struct nm_paths *paths, int d, struct span s)
{
    const size_t inputs = (size_t)em->architecture->network.inputs;
    for (int r = s.begin; r < s.end; r++) {
        const int32_t from = paths->from[d][r].row[sp_by(em->architecture)];
        em->d_out[NM_SP][from] +=
            NM_INTENSITY_SLOPE * em->d_features[d][(size_t)r * inputs + inputs - 1];
    }
}

static void span_backward(struct nm_netem *em, const double *weights, const struct nm_paths *paths,
                          int d, struct span s, bool has_before, double *gradient)
{
    const struct nm_network *net = &em->architecture->network;
    const int rows = s.end - s.begin;
    const size_t begin = (size_t)s.begin, units = nm_network_activity_size(net, 1);
    const size_t offset = weights_of(em->architecture, d), input = begin * (size_t)net->inputs;
    double *delta = em->delta[d] + begin * units;
    give_outputs(em, d, s, delta + nm_network_output_offset(net, rows));
    nm_network_backward(net, weights + offset, em->features[d] + input, rows,
                        em->activity[d] + begin * units, delta, gradient + offset,
                        has_before ? em->d_features[d] + input : NULL);
    if (has_before) {
        hand_back(em, paths, d, s);
    }
}

void nm_netem_backward(struct nm_netem *em, const double *weights, const struct nm_paths *paths,
                       const struct nm_coefficients *c, const double *d_image, double *gradient)
{
    const struct nm_architecture *a = em->architecture;
    memset(em->d_out[NM_BK], 0, (size_t)paths->rows[NM_BK] * sizeof **em->d_out);
    memset(em->d_out[NM_SP], 0, (size_t)paths->rows[sp_by(a)] * sizeof **em->d_out);
    nm_paths_backward(paths, c, d_image, em->d_out[NM_BK], em->d_out[NM_SP]);
    add_hold(em, paths);
    for (int b = span_count(a) - 1; b >= 0; b--) {
        for (int d = 0; d < asked(a); d++) {
            span_backward(em, weights, paths, d, span_of(a, paths, d, b), b > 0, gradient);
        }
    }
}

double nm_netem_ask(const struct nm_architecture *a, const double *weights,
                    const struct nm_reflection *reflection, enum nm_direction direction,
                    double intensity)
{
    double features[NM_INPUTS_MAX], activity[ROW_ACTIVITY_MAX];
    nm_features_of(a, reflection, intensity, features);
    const double *out = nm_network_forward(&a->network, weights + weights_of(a, (int)direction),
                                           features, 1, activity);
    return out[a->wiring == NM_TWO_OUTPUTS ? direction : 0] / (is_chained(a) ? intensity : 1);
}

void nm_netem_free(struct nm_netem *em)
{
    for (int d = 0; d < NM_DIRECTIONS; d++) {
        free(em->features[d]);
        free(em->d_features[d]);
        free(em->activity[d]);
        free(em->delta[d]);
        free(em->out[d]);
        free(em->d_out[d]);
    }
    *em = (struct nm_netem){0};
}
