#include "classify/mlp_apply.h"

#include "hs/error.h"

#include <stdlib.h>
#include <string.h>

/* Pixels at a time: all rows of hidden units of a usual network then stay in the first cache. */
enum { LANE = 256 };

/* Where the fraction passes 1 (found by bisection in double precision). */
#define TANH_END 4.97f

static inline float fast_tanh(float x)
{
    x = x > TANH_END ? TANH_END : x;
    x = x < -TANH_END ? -TANH_END : x;
    const float s = x * x;
    const float above = x * (135135.0f + s * (17325.0f + s * (378.0f + s)));
    const float below = 135135.0f + s * (62370.0f + s * (3150.0f + s * 28.0f));
    return above / below;
}

float db_fast_tanh(float x)
{
    return fast_tanh(x);
}

int db_apply_init(struct db_applied *a, const struct db_net *net)
{
    const struct db_mlp *first = &net->members[0];
    *a = (struct db_applied){.input_count = net->input_count,
                             .hidden_count = first->hidden_count,
                             .output_count = net->output_count,
                             .member_count = net->member_count,
                             .unit = first->unit,
                             .member_size = db_mlp_size(first)};
    a->weights = malloc((size_t)a->member_count * a->member_size * sizeof *a->weights);
    if (!a->weights) {
        return hs_error("network", NULL, "out of memory");
    }
    for (int m = 0; m < a->member_count; m++) {
        float *weights = a->weights + (size_t)m * a->member_size;
        memcpy(weights, net->members[m].weights, a->member_size * sizeof *weights);
        const struct db_mlp_parts p = db_mlp_split(first, weights);
        for (int j = 0; j < a->hidden_count; j++) {
            double bias = (double)p.hidden_bias[j];
            for (int i = 0; i < a->input_count; i++) {
                float *w = &p.hidden[(size_t)j * (size_t)a->input_count + (size_t)i];
                *w /= net->scale[i];
                bias -= (double)*w * (double)net->mean[i];
            }
            p.hidden_bias[j] = (float)bias;
        }
    }
    return 0;
}

void db_apply_free(struct db_applied *a)
{
    free(a->weights);
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

/* sigmoid(x) = (1 + tanh(x / 2)) / 2. */
static void squash(float *values, enum db_unit unit, int count)
{
    if (unit == DB_UNIT_TANH) {
        for (int i = 0; i < count; i++) {
            values[i] = fast_tanh(values[i]);
        }
        return;
    }
    for (int i = 0; i < count; i++) {
        values[i] = 0.5f + 0.5f * fast_tanh(0.5f * values[i]);
    }
}

/* Some pixels on their way through the network. */
struct lane {
    const float *planes; /* of the first pixel */
    size_t stride;       /* from plane to plane */
    int count;           /* 1..LANE */
    float outputs[DB_CLASS_MAX][LANE];
};

/* Add what one member says; a hidden unit is used up as soon as it is known. */
static void add_member(const struct db_applied *a, const float *weights, struct lane *lane)
{
    const size_t inputs = (size_t)a->input_count, hidden = (size_t)a->hidden_count;
    const float *hidden_bias = weights + hidden * inputs;
    const float *output = hidden_bias + hidden;
    const float *output_bias = output + (size_t)a->output_count * hidden;
    float unit[LANE];
    for (size_t j = 0; j < hidden; j++) {
        fill(unit, hidden_bias[j], lane->count);
        for (size_t i = 0; i < inputs; i++) {
            add_scaled(unit, lane->planes + i * lane->stride, weights[j * inputs + i], lane->count);
        }
        squash(unit, a->unit, lane->count);
        for (int k = 0; k < a->output_count; k++) {
            add_scaled(lane->outputs[k], unit, output[(size_t)k * hidden + j], lane->count);
        }
    }
    for (int k = 0; k < a->output_count; k++) {
        for (int i = 0; i < lane->count; i++) {
            lane->outputs[k][i] += output_bias[k];
        }
    }
}

static void choose(const struct db_applied *a, struct lane *lane, uint8_t *winners)
{
    float *best = lane->outputs[0];
    memset(winners, 0, (size_t)lane->count);
    for (int k = 1; k < a->output_count; k++) {
        const float *plane = lane->outputs[k];
        for (int i = 0; i < lane->count; i++) {
            winners[i] = plane[i] > best[i] ? (uint8_t)k : winners[i];
            best[i] = plane[i] > best[i] ? plane[i] : best[i];
        }
    }
}

void db_apply(const struct db_applied *a, const float *planes, size_t stride, size_t count,
              uint8_t *winners)
{
    struct lane lane = {.stride = stride};
    for (size_t at = 0; at < count; at += LANE) {
        lane.planes = planes + at;
        lane.count = count - at < LANE ? (int)(count - at) : LANE;
        for (int k = 0; k < a->output_count; k++) {
            fill(lane.outputs[k], 0, lane.count);
        }
        for (int m = 0; m < a->member_count; m++) {
            add_member(a, a->weights + (size_t)m * a->member_size, &lane);
        }
        choose(a, &lane, winners + at);
    }
}
