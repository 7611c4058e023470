#include "netem/train.h"

#include "hs/error.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

/* A fifth of it leaves one of four trainings of Fig. 10 at an end of the sigmoids; twice as much is
 * seen in the loss. */
static const double hold_weight = 5e-3;

const char *const nm_phase_names[NM_PHASES] = {"pre-training", "real chips", "pixels"};

void nm_sample_free(struct nm_sample *sample)
{
    nm_paths_free(&sample->paths);
    nm_picture_close(&sample->real);
    free(sample->own);
    free(sample->own_amplitudes);
    *sample = (struct nm_sample){0};
}

int nm_training_open(struct nm_training *t, const struct nm_plan *plan,
                     const struct nm_architecture *architecture, const double *kernel, int cells)
{
    *t = (struct nm_training){.plan = *plan};
    hs_rng_seed(&t->rng, plan->seed);
    t->optimizer.method = plan->method;
    t->optimizer.rate = plan->rate;
    t->optimizer.momentum = plan->momentum;
    if (nm_model_open(&t->model, architecture, kernel, &t->rng) != 0 ||
        nm_optimizer_open(&t->optimizer, t->model.size) != 0 ||
        nm_average_open(&t->average, t->model.size) != 0 ||
        nm_simulator_open(&t->simulator, architecture, cells) != 0 ||
        nm_registrar_open(&t->registrar, cells / NM_CELLS_PER_PIXEL) != 0) {
        nm_training_close(t);
        return -1;
    }
    t->simulator.em.hold = hold_weight;
    t->gradient = malloc(t->model.size * sizeof *t->gradient);
    if (!t->gradient) {
        nm_training_close(t);
        return hs_error("training", NULL, "out of memory");
    }
    return 0;
}

void nm_training_close(struct nm_training *t)
{
    nm_model_close(&t->model);
    nm_optimizer_close(&t->optimizer);
    nm_average_close(&t->average);
    nm_simulator_close(&t->simulator);
    nm_registrar_close(&t->registrar);
    free(t->gradient);
    t->gradient = NULL;
}

/* Epochs done when the phase is. */
static int end_of(const struct nm_plan *plan, enum nm_phase phase)
{
    int end = 0;
    for (int p = 0; p <= (int)phase; p++) {
        end += plan->epochs[p];
    }
    return end;
}

enum nm_phase nm_training_phase(const struct nm_training *t)
{
    int p = 0;
    while (p < NM_PHASES && t->epoch_count >= end_of(&t->plan, (enum nm_phase)p)) {
        p++;
    }
    return (enum nm_phase)p;
}

/* The epoch that goes on is one of those that are averaged. */
static bool is_averaged(const struct nm_training *t, enum nm_phase phase)
{
    const long last = lround(t->plan.average * t->plan.epochs[phase]);
    return phase != NM_PRETRAINING && t->epoch_count >= end_of(&t->plan, phase) - last;
}

static void enter_phase(struct nm_training *t, enum nm_phase phase)
{
    if (t->epoch_count > 0 && t->epochs[t->epoch_count - 1].phase == phase) {
        return;
    }
    nm_optimizer_restart(&t->optimizer);
    t->optimizer.rate = phase == NM_PIXELS ? t->plan.pix_rate : t->plan.rate;
    t->model.is_pix_trainable = phase == NM_PIXELS;
}

static struct nm_origin fit(struct nm_training *t, const struct nm_sample *s)
{
    return t->plan.reach_px > 0 ? nm_register(&t->registrar, t->simulator.pixels, &s->real,
                                              s->origin, t->plan.reach_px, NULL)
                                : s->origin;
}

int nm_training_show(struct nm_training *t, const struct nm_sample *sample,
                     struct nm_origin *origin)
{
    if (nm_simulate(&t->simulator, &t->model, &sample->paths) != 0) {
        return -1;
    }
    *origin = fit(t, sample);
    return 0;
}

/* The loss against the simulator's own picture of step 4, its gradient added. */
static int visit_own(struct nm_training *t, const struct nm_sample *sample, double *loss)
{
    struct nm_simulator *s = &t->simulator;
    const int cells = s->pix.side;
    const struct nm_picture aim = {cells, cells, sample->own};
    if (nm_simulate_picture(s, &t->model, &sample->paths) != 0) {
        return -1;
    }
    *loss = nm_loss(t->plan.loss, s->picture, cells, &aim, (struct nm_origin){0, 0}, s->d_picture);
    nm_simulator_backward_picture(s, &t->model, &sample->paths, t->gradient);
    return 0;
}

static int visit_real(struct nm_training *t, const struct nm_sample *sample, enum nm_phase phase,
                      double *loss)
{
    struct nm_simulator *s = &t->simulator;
    struct nm_origin origin;
    if (nm_training_show(t, sample, &origin) != 0) {
        return -1;
    }
    *loss = nm_loss(t->plan.loss, s->pixels, s->side_px, &sample->real, origin, s->d_pixels);
    nm_simulator_backward(s, &t->model, &sample->paths, phase == NM_PIXELS, t->gradient);
    return 0;
}

/* The large kernel's values change in proportion to what the radar's response is there. Adam moves
 * all alike, and most of the kernel's are far out and nearly nothing: they would learn what stands
 * about each bright point of all the chips, which is the target. */
static void hold_back_far_values(struct nm_model *m, const double *before)
{
    double *large = nm_model_pix(m, m->values)->large;
    const double peak = fabs(m->kernel[NM_LARGE * NM_LARGE / 2]);
    for (int i = 0; i < NM_LARGE * NM_LARGE; i++) {
        const double pace = peak > 0 ? fmin(fabs(m->kernel[i]) / peak, 1) : 1;
        large[i] = before[i] + pace * (large[i] - before[i]);
    }
}

static void change_pixels(struct nm_training *t)
{
    double before[NM_LARGE * NM_LARGE];
    memcpy(before, nm_model_pix(&t->model, t->model.values)->large, sizeof before);
    nm_optimizer_step(&t->optimizer, t->model.values, t->gradient,
                      nm_architecture_size(t->model.architecture), NM_PIX_SIZE);
    hold_back_far_values(&t->model, before);
}

static void change_values(struct nm_training *t, enum nm_phase phase, int visited)
{
    const size_t weights = nm_architecture_size(t->model.architecture);
    for (size_t i = 0; i < t->model.size; i++) {
        t->gradient[i] /= visited;
    }
    if (phase == NM_PIXELS) {
        change_pixels(t);
    } else {
        nm_optimizer_step(&t->optimizer, t->model.values, t->gradient, 0, weights);
    }
    if (is_averaged(t, phase)) {
        nm_average_add(&t->average, t->model.values);
    }
    memset(t->gradient, 0, t->model.size * sizeof *t->gradient);
}

static void shuffle(struct hs_rng *rng, int *order, int count)
{
    for (int i = 0; i < count; i++) {
        order[i] = i;
    }
    for (int i = count - 1; i > 0; i--) {
        const int j = (int)hs_rng_below(rng, (uint32_t)i + 1);
        const int kept = order[i];
        order[i] = order[j];
        order[j] = kept;
    }
}

static int visit_all(struct nm_training *t, const struct nm_samples *training, const int *order,
                     enum nm_phase phase, double *mean)
{
    double sum = 0;
    int waiting = 0;
    memset(t->gradient, 0, t->model.size * sizeof *t->gradient);
    for (int i = 0; i < training->count; i++) {
        double loss;
        const struct nm_sample *sample = &training->items[order[i]];
        if ((phase == NM_PRETRAINING ? visit_own(t, sample, &loss)
                                     : visit_real(t, sample, phase, &loss)) != 0) {
            return -1;
        }
        sum += loss;
        if (++waiting == t->plan.batch || i == training->count - 1) {
            change_values(t, phase, waiting);
            waiting = 0;
        }
    }
    *mean = sum / training->count;
    return isfinite(*mean)
               ? 0
               : hs_error("training", "give a smaller --rate", "the loss is no number any more");
}

double nm_training_validate(struct nm_training *t, const struct nm_samples *samples)
{
    double sum = 0;
    for (int i = 0; i < samples->count; i++) {
        struct nm_origin origin;
        if (nm_training_show(t, &samples->items[i], &origin) != 0) {
            return NAN;
        }
        sum += nm_loss(t->plan.loss, t->simulator.pixels, t->simulator.side_px,
                       &samples->items[i].real, origin, NULL);
    }
    return samples->count > 0 ? sum / samples->count : NAN;
}

int nm_training_epoch(struct nm_training *t, const struct nm_samples *training,
                      const struct nm_samples *validation)
{
    const enum nm_phase phase = nm_training_phase(t);
    int *order = malloc(((size_t)training->count + 1) * sizeof *order);
    if (!order || phase == NM_PHASES || t->epoch_count == NM_EPOCHS_MAX || training->count == 0) {
        free(order);
        return hs_error("training", NULL, "has nothing to do, or no memory to do it");
    }
    enter_phase(t, phase);
    shuffle(&t->rng, order, training->count);
    struct nm_epoch epoch = {.phase = phase};
    const int result = visit_all(t, training, order, phase, &epoch.training);
    free(order);
    if (result != 0) {
        return -1;
    }
    if (t->epoch_count + 1 == end_of(&t->plan, phase)) {
        nm_average_take(&t->average, t->model.values);
    }
    epoch.validation = nm_training_validate(t, validation);
    t->epochs[t->epoch_count++] = epoch;
    return 0;
}
