#include "netem/experiment.h"

#include "hs/error.h"
#include "hs/input_file.h"
#include "hs/output_path.h"
#include "hs/report.h"
#include "netem/model_file.h"
#include "netem/report.h"
#include "netem/surfaces.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

static int take_materials(struct nm_experiment *e, bool has_surfaces)
{
    const struct scene *s = &e->view.scene;
    e->materials = (struct nm_materials){.count = s->material_count};
    memcpy(e->materials.names, s->materials, sizeof e->materials.names);
    return has_surfaces
               ? nm_surfaces_of(&e->settings.setup, s->materials, s->material_count, &e->materials)
               : 0;
}

/* Networks that go by names have an input for each. */
static int check_names(const struct nm_experiment *e, const struct nm_architecture *a)
{
    const uint32_t count = e->materials.count;
    return !a || count <= nm_architecture_names(a)
               ? 0
               : hs_error(e->settings.setup.model, "train EP11, or give fewer --zones",
                          "has %u materials, and %s knows %u", count, a->name,
                          nm_architecture_names(a));
}

int nm_experiment_open(struct nm_experiment *e, const struct nm_settings *settings,
                       double lowest_depression_deg)
{
    *e = (struct nm_experiment){.settings = *settings};
    if (nm_target_view_open(&e->view, &settings->setup, lowest_depression_deg) != 0) {
        return -1;
    }
    e->view.connection = nm_settings_connection(settings);
    e->view.known = &e->materials;
    const struct nm_architecture *a =
        nm_architecture_find(settings->architecture, e->view.connection);
    int result = take_materials(e, a && a->material == NM_AS_SURFACE);
    result = result == 0 ? check_names(e, a) : result;
    if (result != 0) {
        nm_target_view_close(&e->view);
    }
    return result;
}

void nm_experiment_close(struct nm_experiment *e)
{
    if (e->training) {
        nm_training_close(e->training);
    }
    free(e->training);
    nm_dataset_free(&e->dataset);
    nm_target_view_close(&e->view);
    *e = (struct nm_experiment){0};
}

int nm_experiment_load(struct nm_experiment *e, const struct nm_chip_list *list)
{
    const struct nm_calibration calibration = nm_settings_calibration(&e->settings);
    return nm_dataset_load(&e->dataset, list, &e->view, &calibration, e->settings.share,
                           (uint64_t)e->settings.seed);
}

static int make_training(struct nm_experiment *e)
{
    e->training = calloc(1, sizeof *e->training);
    return e->training ? 0 : hs_error("training", NULL, "out of memory");
}

static int begin(struct nm_experiment *e, const char *path)
{
    double kernel[NM_LARGE * NM_LARGE];
    const struct nm_architecture *architecture;
    struct nm_plan plan;
    if (access(path, F_OK) == 0) {
        return hs_error(path, "go on with --resume, or name another folder",
                        "is here from another training");
    }
    nm_settings_kernel(&e->settings, kernel);
    if (nm_settings_plan(&e->settings, &plan, &architecture) != 0 || make_training(e) != 0 ||
        nm_training_open(e->training, &plan, architecture, kernel, (int)e->settings.setup.cells) !=
            0) {
        return -1;
    }
    e->training->materials = e->materials;
    return 0;
}

static int read_training(struct nm_experiment *e, const char *path)
{
    return make_training(e) == 0 ? nm_model_read(e->training, path, (int)e->settings.setup.cells)
                                 : -1;
}

/* Materials that a training does not know by name, it may know by what they are made of. */
static int meet_materials(struct nm_experiment *e)
{
    const struct scene *s = &e->view.scene;
    return nm_surfaces_introduce(&e->training->materials, &e->settings.setup, s->materials,
                                 s->material_count);
}

int nm_experiment_take(struct nm_experiment *e, const char *path)
{
    if (read_training(e, path) != 0) {
        return -1;
    }
    if (e->training->model.architecture->material == NM_AS_SURFACE && meet_materials(e) != 0) {
        return -1;
    }
    e->view.known = &e->training->materials;
    e->view.connection = e->training->model.architecture->connection;
    return 0;
}

static bool is_same_plan(const struct nm_plan *a, const struct nm_plan *b)
{
    return a->loss == b->loss && a->method == b->method && a->rate == b->rate &&
           a->pix_rate == b->pix_rate && a->momentum == b->momentum && a->batch == b->batch &&
           a->average == b->average && a->reach_px == b->reach_px && a->seed == b->seed &&
           memcmp(a->epochs, b->epochs, sizeof a->epochs) == 0;
}

static bool is_same_surface(const struct nm_surface *a, const struct nm_surface *b)
{
    return a->permittivity == b->permittivity && a->loss == b->loss &&
           a->rms_height_m == b->rms_height_m && a->correlation_m == b->correlation_m;
}

/* The chips were traced before: with the model's numbers of materials, and their surfaces. */
static bool has_materials(const struct nm_training *t, const struct nm_materials *m)
{
    const bool is_told = t->model.architecture->material == NM_AS_SURFACE;
    bool is_same = t->materials.count == m->count;
    for (uint32_t i = 0; is_same && i < m->count; i++) {
        is_same = strcmp(t->materials.names[i], m->names[i]) == 0 &&
                  (!is_told || is_same_surface(&t->materials.surfaces[i], &m->surfaces[i]));
    }
    return is_same;
}

static int go_on(struct nm_experiment *e, const char *path)
{
    const struct nm_architecture *architecture;
    struct nm_plan plan;
    if (nm_settings_plan(&e->settings, &plan, &architecture) != 0 || read_training(e, path) != 0) {
        return -1;
    }
    if (!has_materials(e->training, &e->materials)) {
        return hs_error(path, "give the model of its beginning",
                        "was begun with a model of other materials");
    }
    return architecture == e->training->model.architecture &&
                   is_same_plan(&plan, &e->training->plan)
               ? 0
               : hs_error(path, "give the options of its beginning",
                          "was begun with other training options");
}

static void print_epoch(const struct nm_training *t, double seconds)
{
    const struct nm_epoch *e = &t->epochs[t->epoch_count - 1];
    printf("epoch %d\t%s\ttraining %.6f\tvalidation %.6f\t%.1f s\n", t->epoch_count,
           nm_phase_names[e->phase], e->training, e->validation, seconds);
    fflush(stdout);
    hs_report_object(NULL);
    hs_report_put("epoch", t->epoch_count);
    hs_report_put("phase", nm_phase_names[e->phase]);
    hs_report_put("training_loss", e->training);
    hs_report_put("validation_loss", e->validation);
    hs_report_put("duration_s", seconds);
    hs_report_close();
}

static double seconds_now(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

int nm_experiment_train(struct nm_experiment *e, const char *folder, bool is_resumed)
{
    char path[4096];
    if (hs_output_path(path, sizeof path, folder, "training.netem") != 0 ||
        (is_resumed ? go_on(e, path) : begin(e, path)) != 0) {
        return -1;
    }
    hs_input_forget(path); /* It is continued in its place. */
    const struct nm_samples training = nm_dataset_training(&e->dataset);
    const struct nm_samples validation = nm_dataset_validation(&e->dataset);
    hs_report_array("epochs");
    while (nm_training_phase(e->training) != NM_PHASES) {
        const double before = seconds_now();
        if (nm_training_epoch(e->training, &training, &validation) != 0 ||
            nm_model_write(e->training, path) != 0) {
            return -1;
        }
        print_epoch(e->training, seconds_now() - before);
    }
    hs_report_close();
    return 0;
}

int nm_experiment_plot(const struct nm_training *t, const char *folder, int material_count,
                       const struct reflect_law *truth)
{
    char loss[4096], specular[4096], back[4096], kernels[4096];
    const struct nm_loss_curve curve = {t->model.architecture->name, t->epochs, t->epoch_count};
    if (hs_output_path(loss, sizeof loss, folder, "loss.png") != 0 ||
        hs_output_path(specular, sizeof specular, folder, "specular.png") != 0 ||
        hs_output_path(back, sizeof back, folder, "back.png") != 0 ||
        hs_output_path(kernels, sizeof kernels, folder, "kernels.png") != 0) {
        return -1;
    }
    const bool is_drawn =
        nm_report_losses(loss, "loss by epoch", &curve, 1) == 0 &&
        nm_report_specular(specular, &t->model, &t->materials, material_count, truth) == 0 &&
        nm_report_back(back, &t->model, &t->materials, material_count, truth) == 0 &&
        nm_report_kernels(kernels, &t->model) == 0;
    return is_drawn ? 0 : -1;
}
