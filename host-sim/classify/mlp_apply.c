#include "classify/mlp_apply.h"

#include "hs/error.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Pixels at a time: all rows of hidden units of a usual network then stay in the first cache. */
enum { LANE = 256 };

/* Take the mean away and divide by the scale in the weights instead of in every pixel. */
static void fold_normalisation(const struct db_net *net, const struct db_mlp_layer *first)
{
    for (int j = 0; j < first->to; j++) {
        double bias = (double)first->bias[j];
        for (int i = 0; i < first->from; i++) {
            float *w = &first->weights[(size_t)j * (size_t)first->from + (size_t)i];
            *w /= net->scale[i];
            bias -= (double)*w * (double)net->mean[i];
        }
        first->bias[j] = (float)bias;
    }
}

int db_apply_init(struct db_applied *a, const struct db_net *net)
{
    *a = (struct db_applied){.shape = net->members[0], .member_count = net->member_count};
    a->shape.weights = NULL;
    a->member_size = db_mlp_size(&a->shape);
    a->weights = malloc((size_t)a->member_count * a->member_size * sizeof *a->weights);
    a->planes = malloc((size_t)db_mlp_hidden_total(&a->shape) * LANE * sizeof *a->planes);
    if (!a->weights || !a->planes) {
        db_apply_free(a);
        return hs_error("network", NULL, "out of memory");
    }
    for (int m = 0; m < a->member_count; m++) {
        float *weights = a->weights + (size_t)m * a->member_size;
        memcpy(weights, net->members[m].weights, a->member_size * sizeof *weights);
        const struct db_mlp_layer first = db_mlp_layer(&a->shape, weights, 0);
        fold_normalisation(net, &first);
    }
    return 0;
}

void db_apply_free(struct db_applied *a)
{
    free(a->weights);
    free(a->planes);
    *a = (struct db_applied){0};
}

static void add_scaled(float *restrict sum, const float *restrict values, float weight, int count)
{
    for (int i = 0; i < count; i++) {
        sum[i] += weight * values[i];
    }
}

static void fill(float *values, float value, int count)
{
    for (int i = 0; i < count; i++) {
        values[i] = value;
    }
}

/* Some pixels on their way through the network. */
struct lane {
    const float *planes; /* of the first pixel: what feeds the next layer */
    size_t stride;       /* from plane to plane */
    int count;           /* 1..LANE */
    float outputs[DB_CLASS_MAX][LANE];
};

/* What unit j of a hidden layer says. */
static void find_unit(const struct db_applied *a, const struct db_mlp_layer *l, int j,
                      const struct lane *lane, float *unit)
{
    fill(unit, l->bias[j], lane->count);
    for (int i = 0; i < l->from; i++) {
        add_scaled(unit, lane->planes + (size_t)i * lane->stride,
                   l->weights[(size_t)j * (size_t)l->from + (size_t)i], lane->count);
    }
    db_units_say(a->shape.unit, unit, (size_t)lane->count);
}

/* The hidden layers but the last; `lane` then holds what they say. */
static void climb(const struct db_applied *a, float *weights, struct lane *lane)
{
    float *to = a->planes;
    for (int i = 0; i + 1 < a->shape.layer_count; i++) {
        const struct db_mlp_layer l = db_mlp_layer(&a->shape, weights, i);
        for (int j = 0; j < l.to; j++) {
            find_unit(a, &l, j, lane, to + (size_t)j * LANE);
        }
        lane->planes = to;
        lane->stride = LANE;
        to += (size_t)l.to * LANE;
    }
}

/* Add what one member says; a unit of the last hidden layer is used up as soon as it is known. */
static void add_member(const struct db_applied *a, float *weights, struct lane *lane)
{
    const float *planes = lane->planes;
    const size_t stride = lane->stride;
    const struct db_mlp_layer l = db_mlp_layer(&a->shape, weights, a->shape.layer_count - 1);
    const struct db_mlp_layer output = db_mlp_layer(&a->shape, weights, a->shape.layer_count);
    float unit[LANE];
    climb(a, weights, lane);
    for (int j = 0; j < l.to; j++) {
        find_unit(a, &l, j, lane, unit);
        for (int k = 0; k < output.to; k++) {
            add_scaled(lane->outputs[k], unit,
                       output.weights[(size_t)k * (size_t)output.from + (size_t)j], lane->count);
        }
    }
    for (int k = 0; k < output.to; k++) {
        for (int i = 0; i < lane->count; i++) {
            lane->outputs[k][i] += output.bias[k];
        }
    }
    lane->planes = planes;
    lane->stride = stride;
}

static void choose(const struct db_applied *a, struct lane *lane, uint8_t *winners)
{
    float *best = lane->outputs[0];
    memset(winners, 0, (size_t)lane->count);
    for (int k = 1; k < a->shape.output_count; k++) {
        const float *plane = lane->outputs[k];
        for (int i = 0; i < lane->count; i++) {
            winners[i] = plane[i] > best[i] ? (uint8_t)k : winners[i];
            best[i] = plane[i] > best[i] ? plane[i] : best[i];
        }
    }
}

/* The largest but one is the largest of the others. */
static void find_margins(const struct db_applied *a, const struct lane *lane, float *margins)
{
    for (int i = 0; i < lane->count; i++) {
        float best = -INFINITY, second = -INFINITY;
        for (int k = 0; k < a->shape.output_count; k++) {
            const float v = lane->outputs[k][i];
            second = fmaxf(second, fminf(v, best));
            best = fmaxf(v, best);
        }
        margins[i] = (best - second) / (float)a->member_count;
    }
}

void db_apply(const struct db_applied *a, const float *planes, size_t stride, size_t count,
              uint8_t *winners, float *margins)
{
    struct lane lane = {.stride = stride};
    for (size_t at = 0; at < count; at += LANE) {
        lane.planes = planes + at;
        lane.count = count - at < LANE ? (int)(count - at) : LANE;
        for (int k = 0; k < a->shape.output_count; k++) {
            fill(lane.outputs[k], 0, lane.count);
        }
        for (int m = 0; m < a->member_count; m++) {
            add_member(a, a->weights + (size_t)m * a->member_size, &lane);
        }
        if (margins) {
            find_margins(a, &lane, margins + at);
        }
        choose(a, &lane, winners + at); /* It overwrites the outputs. */
    }
}
