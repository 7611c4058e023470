/* netem_peer FILE EPOCHS: the training of two EP8 networks on chips of SLICY, timed, and all that
 * another program needs to do the very same (netem_peer.py): FILE receives the rays' ways, inputs
 * of the networks, chips, kernel and the weights at the beginning. Prints loss-before LOSS ours
 * SECONDS-OF-PROCESSOR-AN-EPOCH LOSS-AFTER */
#include "hs/error.h"
#include "netem/target_view.h"
#include "netem/train.h"

#include <stdio.h>
#include <stdlib.h>
#include <time.h>

enum { CHIPS = 16, BATCH = 4 };

static double now_s(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void put_int(FILE *out, int32_t number)
{
    fwrite(&number, sizeof number, 1, out);
}

/* Rows of inputs for both directions, then three numbers a step: row of the echo, row of the way on
 * (-1: none), cell (-1: none); rays by where their steps begin. */
static void put_paths(FILE *out, const struct nm_architecture *a, const struct nm_paths *p)
{
    double features[NM_INPUTS_MAX];
    const int32_t steps = p->first[p->ray_count];
    put_int(out, p->rows[NM_BK]);
    put_int(out, p->rows[NM_SP]);
    put_int(out, p->ray_count);
    put_int(out, steps);
    fwrite(&p->ray_weight, sizeof p->ray_weight, 1, out);
    for (int d = 0; d < NM_DIRECTIONS; d++) {
        for (int r = 0; r < p->rows[d]; r++) {
            nm_features_of(a, &p->table[d][r], 1, features);
            fwrite(features, sizeof *features, NM_INPUTS, out);
        }
    }
    fwrite(p->first, sizeof *p->first, (size_t)p->ray_count + 1, out);
    for (int32_t i = 0; i < steps; i++) {
        put_int(out, p->steps[i].row[NM_BK]);
        put_int(out, p->steps[i].row[NM_SP]);
        put_int(out, p->steps[i].cell);
    }
}

/* A chip by the simulator's own law. */
static int make_sample(const struct nm_target_view *view, struct nm_training *t, int i,
                       struct nm_sample *s)
{
    struct reflect_law law;
    const int side = t->simulator.side_px;
    s->azimuth_deg = i * 360.0 / CHIPS + 3;
    s->real.pixels = malloc((size_t)(side * side) * sizeof *s->real.pixels);
    if (!s->real.pixels ||
        nm_target_view_paths(view, s->azimuth_deg, view->setup.depression_deg, &s->paths, &law)) {
        return -1;
    }
    s->real.width = s->real.height = side;
    if (nm_draw_by_law(&s->paths, &law, t->simulator.picture) != 0) {
        return -1;
    }
    nm_netpix_fixed(&t->simulator.pix, t->model.kernel, t->simulator.picture, s->real.pixels);
    return 0;
}

static int write_all(const char *path, const struct nm_training *t, const struct nm_samples *s)
{
    FILE *out = fopen(path, "wb");
    if (!out) {
        return hs_error(path, NULL, "cannot be written");
    }
    const size_t side = (size_t)t->simulator.side_px;
    put_int(out, CHIPS);
    put_int(out, t->simulator.pix.side);
    put_int(out, BATCH);
    fwrite(&t->plan.rate, sizeof t->plan.rate, 1, out);
    fwrite(t->model.kernel, sizeof(double), NM_LARGE * NM_LARGE, out);
    const size_t weights = nm_architecture_size(t->model.architecture);
    put_int(out, (int32_t)weights);
    fwrite(t->model.values, sizeof(double), weights, out);
    for (int i = 0; i < s->count; i++) {
        fwrite(s->items[i].real.pixels, sizeof(double), side * side, out);
        put_paths(out, t->model.architecture, &s->items[i].paths);
    }
    return fclose(out) == 0 ? 0 : hs_error(path, "make room", "cannot be written");
}

static int run(const char *path, int epochs, const struct nm_target_view *view,
               struct nm_training *t)
{
    static struct nm_sample items[CHIPS];
    const struct nm_samples samples = {items, CHIPS}, none = {items, 0};
    for (int i = 0; i < CHIPS; i++) {
        if (make_sample(view, t, i, &items[i]) != 0) {
            return -1;
        }
    }
    printf("loss-before %.9f\n", nm_training_validate(t, &samples));
    int result = write_all(path, t, &samples);
    const double before = now_s();
    for (int e = 0; e < epochs && result == 0; e++) {
        result = nm_training_epoch(t, &samples, &none);
    }
    printf("ours %.4f %.9f\n", (now_s() - before) / epochs, nm_training_validate(t, &samples));
    for (int i = 0; i < CHIPS; i++) {
        nm_sample_free(&items[i]);
    }
    return result;
}

int main(int argc, char **argv)
{
    if (argc != 3 || atoi(argv[2]) < 1) {
        fputs("usage: netem_peer FILE EPOCHS\n", stderr);
        return 2;
    }
    static struct nm_training t;
    static double kernel[NM_LARGE * NM_LARGE];
    struct nm_target_view view;
    struct setup setup = setup_default();
    const int epochs = atoi(argv[2]);
    const struct nm_plan plan = {
        .loss = NM_MSE,
        .method = NM_ADAM,
        .rate = 1e-3,
        .pix_rate = 1e-4,
        .momentum = 0.9,
        .batch = BATCH,
        .epochs = {0, epochs, 0},
        .seed = 1,
    };
    setup.model = "slicy";
    nm_kernel_make(setup.resolution_m, setup.cell_m, 0.2, kernel);
    if (nm_target_view_open(&view, &setup, setup.depression_deg) != 0 ||
        nm_training_open(&t, &plan, nm_architecture_find("EP8", NM_BY_COEFFICIENT), kernel,
                         (int)setup.cells) != 0) {
        return 1;
    }
    const int result = run(argv[1], epochs, &view, &t);
    nm_training_close(&t);
    nm_target_view_close(&view);
    return result == 0 ? 0 : 1;
}
