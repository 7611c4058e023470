#include "netem/simulator.h"

#include "hs/error.h"

#include <cblas.h>
#include <stdlib.h>
#include <string.h>

int nm_model_open(struct nm_model *m, const struct nm_architecture *architecture,
                  const double *kernel, struct hs_rng *rng)
{
    const size_t weights = nm_architecture_size(architecture);
    *m = (struct nm_model){.architecture = architecture, .size = weights + NM_PIX_SIZE};
    m->values = malloc(m->size * sizeof *m->values);
    if (!m->values) {
        return hs_error("model", NULL, "out of memory");
    }
    memcpy(m->kernel, kernel, sizeof m->kernel);
    const size_t one = nm_network_size(&architecture->network);
    for (size_t at = 0; at < weights; at += one) {
        nm_network_draw(&architecture->network, m->values + at, rng);
    }
    nm_pix_draw(nm_model_pix(m, m->values), kernel, rng);
    return 0;
}

void nm_model_close(struct nm_model *m)
{
    free(m->values);
    *m = (struct nm_model){0};
}

struct nm_pix_values *nm_model_pix(const struct nm_model *m, double *values)
{
    return (struct nm_pix_values *)(void *)(values + nm_architecture_size(m->architecture));
}

int nm_simulator_open(struct nm_simulator *s, const struct nm_architecture *architecture, int cells)
{
    const int side = cells / NM_CELLS_PER_PIXEL;
    const size_t in = (size_t)cells * (size_t)cells * sizeof(double);
    const size_t out = (size_t)side * (size_t)side * sizeof(double);
    /* The order of sums, and so the last bit, depends on the threads. The matrices are so small
     * that two of them take twice as long. */
    openblas_set_num_threads(1);
    *s = (struct nm_simulator){
        .em = {.architecture = architecture},
        .side_px = side,
        .picture = malloc(in),
        .d_picture = malloc(in),
        .pixels = malloc(out),
        .d_pixels = malloc(out),
    };
    if (!s->picture || !s->d_picture || !s->pixels || !s->d_pixels ||
        nm_netpix_open(&s->pix, cells) != 0) {
        nm_simulator_close(s);
        return hs_error("simulator", "use a smaller picture", "out of memory");
    }
    return 0;
}

void nm_simulator_close(struct nm_simulator *s)
{
    nm_netem_free(&s->em);
    nm_netpix_close(&s->pix);
    free(s->picture);
    free(s->d_picture);
    free(s->pixels);
    free(s->d_pixels);
    *s = (struct nm_simulator){0};
}

static void finish(struct nm_simulator *s, const struct nm_model *m)
{
    if (m->is_pix_trainable) {
        nm_netpix_trainable(&s->pix, nm_model_pix(m, m->values), s->picture, s->pixels);
    } else {
        nm_netpix_fixed(&s->pix, m->kernel, s->picture, s->pixels);
    }
}

int nm_simulate_picture(struct nm_simulator *s, const struct nm_model *m,
                        const struct nm_paths *paths)
{
    if (nm_netem_forward(&s->em, m->values, paths, &s->coefficients) != 0) {
        return -1;
    }
    nm_paths_render(paths, &s->coefficients, s->picture);
    return 0;
}

int nm_simulate(struct nm_simulator *s, const struct nm_model *m, const struct nm_paths *paths)
{
    if (nm_simulate_picture(s, m, paths) != 0) {
        return -1;
    }
    finish(s, m);
    return 0;
}

void nm_simulate_with(struct nm_simulator *s, const struct nm_model *m,
                      const struct nm_paths *paths, const struct nm_coefficients *c)
{
    nm_paths_render(paths, c, s->picture);
    finish(s, m);
}

void nm_simulator_backward_picture(struct nm_simulator *s, const struct nm_model *m,
                                   const struct nm_paths *paths, double *gradient)
{
    nm_netem_backward(&s->em, m->values, paths, &s->coefficients, s->d_picture, gradient);
}

void nm_simulator_backward(struct nm_simulator *s, const struct nm_model *m,
                           const struct nm_paths *paths, bool is_pix_only, double *gradient)
{
    if (m->is_pix_trainable) {
        nm_netpix_trainable_backward(&s->pix, nm_model_pix(m, m->values), s->pixels, s->d_pixels,
                                     is_pix_only ? NULL : s->d_picture, nm_model_pix(m, gradient));
    } else {
        nm_netpix_fixed_backward(&s->pix, m->kernel, s->pixels, s->d_pixels, s->d_picture);
    }
    if (!is_pix_only) {
        nm_simulator_backward_picture(s, m, paths, gradient);
    }
}
