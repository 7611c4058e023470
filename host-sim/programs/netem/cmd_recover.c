#include "commands.h"

#include "hs/error.h"
#include "hs/progress.h"
#include "hs/report.h"
#include "netem/experiment.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static const struct hs_usage usage = {
    "recover", "hide a law in made chips, learn it, and tell how well it was found",
    "Make \"real\" chips of the model by a hidden law of reflection, seen from aspects drawn by\n"
    "lot, with speckle and a hidden translation; train on a part of them without telling the\n"
    "law; report the loss on aspects never shown and the error of what was learned, over the\n"
    "reflections that occur there, weighted by the power that meets them. Leaves the same\n"
    "files as `train`; the true law is drawn as dots beside the learned curves. The paper's\n"
    "loss on real chips of SLICY is 0.003253."};

enum { OPTIONS = NM_TARGET_OPTIONS + NM_TRAIN_OPTIONS + 9 };

struct hidden {
    const char *law, *materials, *out;
    long chips, looks, shift_px;
    double share, highest_deg;
    double noise; /* mean square of what speckle adds: no simulator comes below it */
    struct reflect_law truth;
};

static double clean_at(const struct nm_simulator *s, int x, int y)
{
    const int last = s->side_px - 1;
    x = x < 0 ? 0 : x > last ? last : x;
    y = y < 0 ? 0 : y > last ? last : y;
    return fmin(s->pixels[y * s->side_px + x], 1 - 1e-12);
}

static double speckled(double pixel, long looks, struct hs_rng *rng)
{
    double power = looks > 0 ? 0 : 1;
    for (long l = 0; l < looks; l++) {
        power -= log1p(-hs_rng_uniform(rng)) / (double)looks;
    }
    return tanh(sqrt(power) * atanh(pixel));
}

/* The chip by the hidden law, somewhere within the shift; its margins go on as its edges are. */
static int make_chip(struct hidden *h, struct nm_simulator *s, const struct nm_model *model,
                     struct nm_sample *sample, struct hs_rng *rng)
{
    const int side = s->side_px + 2 * (int)h->shift_px;
    if (nm_draw_by_law(&sample->paths, &h->truth, s->picture) != 0 ||
        nm_picture_open(&sample->real, side, side) != 0) {
        return -1;
    }
    nm_netpix_fixed(&s->pix, model->kernel, s->picture, s->pixels);
    const uint32_t places = (uint32_t)(2 * h->shift_px + 1);
    const int x0 = (int)hs_rng_below(rng, places), y0 = (int)hs_rng_below(rng, places);
    const double share = 1.0 / ((double)side * side * (double)h->chips);
    for (int i = 0; i < side * side; i++) {
        const double clean = clean_at(s, i % side - x0, i / side - y0);
        const double pixel = speckled(clean, h->looks, rng);
        h->noise += share * (pixel - clean) * (pixel - clean);
        sample->real.pixels[i] = pixel;
    }
    sample->origin = nm_picture_middle(&sample->real, s->side_px);
    return 0;
}

/* Trace one aspect: paths, the simulator's own picture, and the truth's table of materials. */
static int trace_aspect(struct nm_experiment *e, struct hidden *h, struct nm_sample *sample,
                        double depression_deg)
{
    struct nm_target_view view = e->view;
    struct nm_paths again;
    view.setup.law = h->law;
    view.setup.materials = h->materials;
    if (nm_target_view_paths(&e->view, sample->azimuth_deg, depression_deg, &sample->paths,
                             &e->dataset.law) != 0) {
        return -1;
    }
    if (h->truth.wavelength_m == 0) {
        if (nm_target_view_paths(&view, sample->azimuth_deg, depression_deg, &again, &h->truth)) {
            return -1;
        }
        nm_paths_free(&again);
    }
    return nm_sample_draw(sample, &e->settings.setup, &e->dataset.law);
}

static int make_chips(struct nm_experiment *e, struct hidden *h)
{
    struct hs_rng rng;
    struct nm_model model;
    struct nm_simulator simulator;
    double kernel[NM_LARGE * NM_LARGE];
    struct nm_dataset *d = &e->dataset;
    struct hs_progress progress;
    const double lowest_deg = e->settings.setup.depression_deg;
    const double span_deg = fmax(h->highest_deg - lowest_deg, 0);
    hs_rng_seed(&rng, (uint64_t)e->settings.seed + 1);
    nm_settings_kernel(&e->settings, kernel);
    d->samples = calloc((size_t)h->chips, sizeof *d->samples);
    if (!d->samples || nm_model_open(&model, nm_architectures[0], kernel, &rng) != 0) {
        return hs_error("chips", NULL, "out of memory");
    }
    int result = nm_simulator_open(&simulator, nm_architectures[0], (int)e->settings.setup.cells);
    hs_progress_begin(&progress, "chips", (uint64_t)h->chips);
    while (result == 0 && d->count < h->chips) {
        struct nm_sample *sample = &d->samples[d->count++];
        sample->azimuth_deg = 360 * hs_rng_uniform(&rng);
        const double depression_deg = lowest_deg + span_deg * hs_rng_uniform(&rng);
        snprintf(sample->name, sizeof sample->name, "made-%03d", d->count);
        result = trace_aspect(e, h, sample, depression_deg) == 0
                     ? make_chip(h, &simulator, &model, sample, &rng)
                     : -1;
        hs_progress_update(&progress, (uint64_t)d->count);
    }
    hs_progress_end(&progress);
    d->training = (int)lround(h->share * d->count);
    nm_simulator_close(&simulator);
    nm_model_close(&model);
    return result;
}

/* How far the learned coefficients of one material and direction are from the truth. */
struct law_error {
    double sum, weight; /* weighted by the power that arrives, by the true law */
    long count;
};

static void add_step(struct law_error errors[NM_DIRECTIONS][TRACE_MATERIALS_MAX],
                     const struct nm_model *model, const struct reflect_law *truth,
                     const struct nm_paths *p, const struct nm_step *step, double power)
{
    static const double power_min = 1e-9; /* which weighs nothing, and nothing can be divided by */
    for (int d = 0; d < NM_DIRECTIONS; d++) {
        const int32_t row = step->row[d];
        if (row < 0 || (d == NM_BK && step->cell < 0) || power < power_min) {
            continue;
        }
        const struct nm_reflection *r = &p->table[d][row];
        struct law_error *e = &errors[d][r->material];
        const enum nm_direction direction = (enum nm_direction)d;
        const double learned =
            nm_netem_ask(model->architecture, model->values, r, direction, power);
        e->sum += power * fabs(learned - nm_law_ask(truth, r, direction));
        e->weight += power;
        e->count++;
    }
}

static void add_sample(struct law_error errors[NM_DIRECTIONS][TRACE_MATERIALS_MAX],
                       const struct nm_model *model, const struct reflect_law *truth,
                       const struct nm_paths *p)
{
    for (int i = 0; i < p->ray_count; i++) {
        double power = 1;
        for (int32_t s = p->first[i]; s < p->first[i + 1]; s++) {
            const struct nm_step *step = &p->steps[s];
            add_step(errors, model, truth, p, step, power);
            if (step->row[NM_SP] >= 0) {
                power *= nm_law_ask(truth, &p->table[NM_SP][step->row[NM_SP]], NM_SP);
            }
        }
    }
}

static void print_errors(const struct nm_experiment *e, const struct hidden *h)
{
    struct law_error errors[NM_DIRECTIONS][TRACE_MATERIALS_MAX] = {{{0}}};
    const struct nm_samples others = nm_dataset_validation(&e->dataset);
    const struct nm_training *t = e->training;
    for (int i = 0; i < others.count; i++) {
        add_sample(errors, &t->model, &h->truth, &others.items[i].paths);
    }
    printf("validation loss %.6f (paper, real SLICY: 0.003253); of that, speckle %.6f\n",
           t->epochs[t->epoch_count - 1].validation, h->noise);
    hs_report_put("validation_loss", t->epochs[t->epoch_count - 1].validation);
    hs_report_put("speckle_loss", h->noise);
    hs_report_array("law_errors");
    for (int d = 0; d < NM_DIRECTIONS; d++) {
        for (uint32_t m = 0; m < e->view.scene.material_count; m++) {
            hs_report_object(NULL);
            hs_report_put("direction", d == NM_BK ? "back" : "specular");
            hs_report_put("material", e->view.scene.materials[m]);
            hs_report_put("mean_error", errors[d][m].sum / errors[d][m].weight);
            hs_report_put("reflections", errors[d][m].count);
            hs_report_close();
            printf("mean error of the law, %s, %s: %.4f over %ld reflections never shown\n",
                   d == NM_BK ? "back" : "specular", e->view.scene.materials[m],
                   errors[d][m].sum / errors[d][m].weight, errors[d][m].count);
        }
    }
    hs_report_close();
}

static int run(const struct nm_settings *settings, struct hidden *h, bool is_resumed)
{
    struct nm_experiment e;
    struct nm_summary summary;
    if (nm_experiment_open(&e, settings, settings->setup.depression_deg) != 0) {
        return -1;
    }
    int result = make_chips(&e, h);
    result = result == 0 ? nm_experiment_train(&e, h->out, is_resumed) : -1;
    if (result == 0) {
        const struct nm_samples others = nm_dataset_validation(&e.dataset);
        const int materials = (int)e.view.scene.material_count;
        result = nm_experiment_plot(e.training, h->out, materials, &h->truth) == 0
                     ? nm_experiment_score(&e, &others, h->out, &summary)
                     : -1;
    }
    if (result == 0) {
        print_errors(&e, h);
        nm_summary_print(&summary, "validation");
    }
    nm_experiment_close(&e);
    return result;
}

int nm_cmd_recover(int argc, char **argv)
{
    struct nm_settings s = nm_settings_default();
    struct hidden h = {.law = "fresnel-vv", .chips = 60, .looks = 4, .shift_px = 3, .share = 0.6};
    bool is_resumed = false;
    int exit_code;
    struct hs_option options[OPTIONS] = {
        {"hidden-law", HS_WORD, &h.law, 0, 0, REFLECT_KIND_WORDS, "that is to be found", false},
        {"hidden-materials", HS_INPUT, &h.materials, 0, 0, "FILE",
         "its surfaces, in the form that `landmass-target materials` prints", false},
        {"number", HS_INTEGER, &h.chips, 2, 10000, "N", "chips to make", false},
        {"share", HS_REAL, &h.share, 0, 1, "P", "of them for training", false},
        {"depression-to", HS_REAL, &h.highest_deg, 0, 89, "DEG",
         "draw depressions by lot, from --depression to this; 0: all are the same", false},
        {"looks", HS_INTEGER, &h.looks, 0, 64, "N", "of their speckle; 0: none", false},
        {"shift", HS_INTEGER, &h.shift_px, 0, 20, "PX", "of the hidden translation, at most",
         false},
        {"out", HS_FOLDER, &h.out, 0, 0, "FOLDER", "for the results", true},
        {"resume", HS_FLAG, &is_resumed, 0, 0, NULL, "go on where FOLDER's training stopped",
         false},
    };
    nm_target_options(&s, options + 9);
    nm_train_options(&s, options + 9 + NM_TARGET_OPTIONS);
    if (!hs_options_read(&usage, options, OPTIONS, argc, argv, &exit_code)) {
        return exit_code;
    }
    return run(&s, &h, is_resumed) == 0 ? HS_EXIT_OK : HS_EXIT_FAILED;
}
