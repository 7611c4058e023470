/* The derivative that training follows is that of the loss: every group of values of every network,
 * through multiplication along the bounces or from network to network, the sum in the cells,
 * convolution, ReLU and tanh, beside finite differences. */
#include "check.h"
#include "facets.h"
#include "netem/loss.h"
#include "netem/simulator.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { CELLS = 24, SIDE = 12, PER_GROUP = 8 };

struct bench {
    struct trace_records records;
    struct nm_paths paths;
    struct nm_model model;
    struct nm_simulator simulator;
    struct nm_picture real;
    enum nm_loss_kind kind;
    double *gradient;
};

static const struct nm_architecture *coefficient(const char *name)
{
    return nm_architecture_find(name, NM_BY_COEFFICIENT);
}

/* Those of facets_make. */
static const struct nm_materials materials = {
    3,
    {"metal", "ground", "rubber"},
    {{1, 1e7, 2e-4, 0.02}, {6, 1, 1.5e-3, 0.02}, {3, 0.1, 1e-3, 0.05}},
};

static void open_bench(struct bench *b, const struct nm_architecture *architecture)
{
    struct hs_rng rng;
    hs_rng_seed(&rng, 3);
    double *kernel = calloc(NM_LARGE * NM_LARGE, sizeof *kernel);
    for (int i = 0; i < NM_LARGE * NM_LARGE; i++) {
        const double y = i / NM_LARGE - NM_LARGE / 2, x = i % NM_LARGE - NM_LARGE / 2;
        kernel[i] = 0.3 * exp(-(x * x + 2 * y * y + x) / 6);
    }
    facets_make(&b->records, 5, SIDE, CELLS);
    assert_int_equal(nm_paths_build(&b->paths, &b->records, &materials, architecture->connection),
                     0);
    assert_int_equal(nm_model_open(&b->model, architecture, kernel, &rng), 0);
    assert_int_equal(nm_simulator_open(&b->simulator, architecture, CELLS), 0);
    assert_int_equal(nm_picture_open(&b->real, SIDE + 3, SIDE + 1), 0);
    for (int i = 0; i < b->real.width * b->real.height; i++) {
        b->real.pixels[i] = hs_rng_uniform(&rng);
    }
    struct nm_pix_values *pix = nm_model_pix(&b->model, b->model.values);
    for (int k = 0; k < NM_CHANNELS; k++) {
        for (int i = 0; i < NM_SECOND * NM_SECOND; i++) {
            pix->second[k][i] += 0.02 * hs_rng_normal(&rng);
        }
    }
    b->gradient = calloc(b->model.size, sizeof *b->gradient);
    free(kernel);
}

static void close_bench(struct bench *b)
{
    trace_records_free(&b->records);
    nm_paths_free(&b->paths);
    nm_model_close(&b->model);
    nm_simulator_close(&b->simulator);
    nm_picture_close(&b->real);
    free(b->gradient);
}

static double loss_of(struct bench *b)
{
    assert_int_equal(nm_simulate(&b->simulator, &b->model, &b->paths), 0);
    const struct nm_origin origin = {-1, 2};
    return nm_loss(b->kind, b->simulator.pixels, SIDE, &b->real, origin, b->simulator.d_pixels);
}

static double difference(struct bench *b, size_t i, double step)
{
    const double kept = b->model.values[i];
    b->model.values[i] = kept + step;
    const double above = loss_of(b);
    b->model.values[i] = kept - step;
    const double below = loss_of(b);
    b->model.values[i] = kept;
    return (above - below) / (2 * step);
}

/* A kink of ReLU between the two ends spoils a difference; a smaller step misses it. */
static int agrees(struct bench *b, size_t i, double scale)
{
    for (double step = 1e-5; step > 1e-8; step /= 10) {
        if (fabs(difference(b, i, step) - b->gradient[i]) <= 1e-5 * scale + 1e-9) {
            return 1;
        }
    }
    return 0;
}

/* `count` values from `first`: some of them by differences; at least one must matter. */
static void check_group(struct bench *b, size_t first, size_t count, const char *name)
{
    double scale = 0;
    for (size_t i = first; i < first + count; i++) {
        scale = fmax(scale, fabs(b->gradient[i]));
    }
    if (scale < 1e-12) {
        fail_msg("%s by %s: %s has no gradient", b->model.architecture->name,
                 nm_connection_names[b->model.architecture->connection], name);
    }
    const size_t stride = count > PER_GROUP ? count / PER_GROUP : 1;
    for (size_t i = first; i < first + count; i += stride) {
        if (!agrees(b, i, scale)) {
            fail_msg("%s by %s: %s, value %zu: %g, by differences %g", b->model.architecture->name,
                     nm_connection_names[b->model.architecture->connection], name, i - first,
                     b->gradient[i], difference(b, i, 1e-6));
        }
    }
}

static void check_networks(struct bench *b)
{
    const struct nm_network *net = &b->model.architecture->network;
    const size_t all = nm_architecture_size(b->model.architecture);
    for (size_t at = 0; at < all;) {
        for (int l = 0; l < net->layers; l++) {
            char name[32];
            const int from = l == 0 ? net->inputs : net->width[l - 1];
            const size_t weights = (size_t)from * (size_t)net->width[l];
            snprintf(name, sizeof name, "weights of layer %d", l + 1);
            check_group(b, at, weights, name);
            snprintf(name, sizeof name, "biases of layer %d", l + 1);
            check_group(b, at + weights, (size_t)net->width[l], name);
            at += weights + (size_t)net->width[l];
        }
    }
}

static void check_pix(struct bench *b)
{
    const size_t at = nm_architecture_size(b->model.architecture);
#define GROUP(field)                                                                               \
    check_group(b, at + offsetof(struct nm_pix_values, field) / sizeof(double),                    \
                sizeof(((struct nm_pix_values *)0)->field) / sizeof(double), #field)
    GROUP(large);
    GROUP(small);
    GROUP(first_bias);
    GROUP(second);
    GROUP(second_bias);
#undef GROUP
}

static void check_architecture(const struct nm_architecture *a, int is_pix_trainable,
                               enum nm_loss_kind kind)
{
    struct bench b = {.kind = kind};
    open_bench(&b, a);
    b.model.is_pix_trainable = is_pix_trainable;
    loss_of(&b);
    nm_simulator_backward(&b.simulator, &b.model, &b.paths, false, b.gradient);
    check_networks(&b);
    if (is_pix_trainable) {
        check_pix(&b);
    }
    close_bench(&b);
}

TEST(every_group_of_every_network_has_the_right_gradient)
{
    for (int i = 0; i < NM_CONNECTIONS * NM_ARCHITECTURES; i++) {
        check_architecture(&nm_architectures[i / NM_ARCHITECTURES][i % NM_ARCHITECTURES], 0,
                           NM_MSE);
    }
}

/* The hold alone: the loss has no part in it. */
static double hold_of(struct bench *b)
{
    assert_int_equal(nm_simulate_picture(&b->simulator, &b->model, &b->paths), 0);
    return nm_netem_hold(&b->simulator.em, &b->paths);
}

TEST(what_holds_intensities_has_the_right_gradient)
{
    static const char *const names[] = {"EP2", "EP5", "EP8"};
    for (size_t n = 0; n < sizeof names / sizeof names[0]; n++) {
        struct bench b = {.kind = NM_MSE};
        open_bench(&b, nm_architecture_find(names[n], NM_BY_INTENSITY));
        assert_true(hold_of(&b) > 0);
        memset(b.simulator.d_picture, 0, CELLS * CELLS * sizeof *b.simulator.d_picture);
        b.simulator.em.hold = 2;
        nm_simulator_backward_picture(&b.simulator, &b.model, &b.paths, b.gradient);
        const size_t count = nm_architecture_size(b.model.architecture);
        double most = 0;
        for (size_t i = 0; i < count; i++) {
            most = fmax(most, fabs(b.gradient[i]));
        }
        for (size_t i = 0; i < count; i += count / 50) {
            const double kept = b.model.values[i], step = 1e-6;
            b.model.values[i] = kept + step;
            const double above = hold_of(&b);
            b.model.values[i] = kept - step;
            const double slope = (above - hold_of(&b)) / (2 * step);
            b.model.values[i] = kept;
            assert_true(fabs(2 * slope - b.gradient[i]) < 1e-4 * most);
        }
        close_bench(&b);
    }
}

TEST(coefficients_are_not_held)
{
    struct bench b = {.kind = NM_MSE};
    open_bench(&b, coefficient("EP8"));
    assert_true(hold_of(&b) == 0);
    close_bench(&b);
}

/* One ray after the other, each network asked by itself with what the one before gave. */
static void draw_ray_by_ray(struct bench *b, double *image)
{
    const struct nm_model *m = &b->model;
    const struct nm_paths *p = &b->paths;
    const int is_joint = m->architecture->wiring == NM_TWO_OUTPUTS;
    for (int i = 0; i < p->ray_count; i++) {
        double arriving = 1;
        for (int32_t s = p->first[i]; s < p->first[i + 1]; s++) {
            const struct nm_step *step = &p->steps[s];
            const struct nm_reflection *bk = &p->table[NM_BK][step->row[NM_BK]];
            if (step->cell >= 0) {
                image[step->cell] += p->ray_weight * arriving *
                                     nm_netem_ask(m->architecture, m->values, bk, NM_BK, arriving);
            }
            if (step->row[NM_SP] >= 0) {
                const struct nm_reflection *sp = is_joint ? bk : &p->table[NM_SP][step->row[NM_SP]];
                arriving *= nm_netem_ask(m->architecture, m->values, sp, NM_SP, arriving);
            }
        }
    }
}

TEST(what_a_network_gives_is_what_the_next_one_gets)
{
    static const char *const names[] = {"EP2", "EP5", "EP8", "EP9", "EP10"};
    for (size_t n = 0; n < sizeof names / sizeof names[0]; n++) {
        struct bench b = {.kind = NM_MSE};
        double image[CELLS * CELLS] = {0}, most = 0;
        open_bench(&b, nm_architecture_find(names[n], NM_BY_INTENSITY));
        draw_ray_by_ray(&b, image);
        assert_int_equal(nm_simulate_picture(&b.simulator, &b.model, &b.paths), 0);
        for (int i = 0; i < CELLS * CELLS; i++) {
            most = fmax(most, image[i]);
            assert_true(fabs(b.simulator.picture[i] - image[i]) <= 1e-12);
        }
        assert_true(most > 0.1);
        close_bench(&b);
    }
}

/* The records of facets_make are seen from 10 degrees. */
TEST(only_networks_of_ep12_are_told_from_which_side)
{
    const double side_rad = 10 * acos(-1) / 180;
    for (int i = 0; i < NM_CONNECTIONS * NM_ARCHITECTURES; i++) {
        const struct nm_architecture *a =
            &nm_architectures[i / NM_ARCHITECTURES][i % NM_ARCHITECTURES];
        double here[NM_INPUTS_MAX] = {0}, there[NM_INPUTS_MAX] = {0}, apart = 0;
        struct bench b = {.kind = NM_MSE};
        open_bench(&b, a);
        for (int d = 0; d < NM_DIRECTIONS; d++) {
            assert_true(fabs(b.paths.table[d][0].side_rad - side_rad) < 1e-12);
        }
        struct nm_reflection r = b.paths.table[NM_BK][0];
        nm_features_of(a, &r, 1, here);
        r.side_rad += acos(-1);
        nm_features_of(a, &r, 1, there);
        for (int k = 0; k < a->network.inputs; k++) {
            apart += pow(here[k] - there[k], 2);
        }
        /* Sine and cosine, times 2, turned round. */
        const double expected = strcmp(a->name, "EP12") == 0 ? 16 : 0;
        assert_true(fabs(apart - expected) < 1e-9);
        close_bench(&b);
    }
}

TEST(paths_for_coefficients_are_not_taken_for_intensities)
{
    struct bench b = {.kind = NM_MSE};
    open_bench(&b, nm_architecture_find("EP8", NM_BY_INTENSITY));
    nm_paths_free(&b.paths);
    assert_int_equal(nm_paths_build(&b.paths, &b.records, NULL, NM_BY_COEFFICIENT), 0);
    assert_int_equal(nm_simulate_picture(&b.simulator, &b.model, &b.paths), -1);
    close_bench(&b);
}

TEST(the_gradient_reaches_the_networks_through_the_trainable_pixels)
{
    check_architecture(coefficient("EP8"), 1, NM_MSE);
    check_architecture(coefficient("EP2"), 1, NM_MSE);
}

TEST(the_absolute_error_has_its_own_gradient)
{
    check_architecture(coefficient("EP8"), 0, NM_MAE);
    check_architecture(coefficient("EP7"), 1, NM_MAE);
}

TEST(frozen_networks_get_no_gradient_and_the_pixels_get_all_of_it)
{
    struct bench b = {.kind = NM_MSE};
    open_bench(&b, coefficient("EP8"));
    b.model.is_pix_trainable = true;
    loss_of(&b);
    nm_simulator_backward(&b.simulator, &b.model, &b.paths, true, b.gradient);
    const size_t weights = nm_architecture_size(b.model.architecture);
    for (size_t i = 0; i < weights; i++) {
        assert_true(b.gradient[i] == 0);
    }
    check_pix(&b);
    close_bench(&b);
}

/* Pre-training compares step 4 with the simulator's own picture. */
TEST(the_picture_of_step_4_has_the_right_gradient_too)
{
    struct bench b = {.kind = NM_MSE};
    open_bench(&b, coefficient("EP8"));
    struct nm_simulator *s = &b.simulator;
    struct nm_picture aim;
    assert_int_equal(nm_picture_open(&aim, CELLS, CELLS), 0);
    const struct nm_origin origin = {0, 0};
    const size_t i = 40;
    const double step = 1e-6, kept = b.model.values[i];
    double loss[3];
    for (int side = 0; side < 3; side++) {
        b.model.values[i] = kept + (side - 1) * step;
        assert_int_equal(nm_simulate_picture(s, &b.model, &b.paths), 0);
        loss[side] = nm_loss(NM_MSE, s->picture, CELLS, &aim, origin, s->d_picture);
        if (side == 1) {
            nm_simulator_backward_picture(s, &b.model, &b.paths, b.gradient);
        }
    }
    const double expected = (loss[2] - loss[0]) / (2 * step);
    assert_true(fabs(expected) > 1e-6);
    assert_true(fabs(b.gradient[i] - expected) < 1e-5 * fabs(expected));
    nm_picture_close(&aim);
    close_bench(&b);
}
