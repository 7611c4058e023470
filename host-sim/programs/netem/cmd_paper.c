#include "commands.h"

#include "hs/error.h"
#include "hs/output_path.h"
#include "hs/report.h"
#include "netem/experiment.h"
#include "netem/report.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const struct hs_usage usage = {
    "paper", "the whole experiment of the paper on the full MSTAR set",
    "Niu et al., \"A SAR target image simulation method with DNN embedded to calculate\n"
    "electromagnetic reflection\", section IV, from folders of raw MSTAR chips: SLICY with the\n"
    "division of Table II (20 % of 15 degrees and 80 % of 30 degrees train, the others\n"
    "validate), with --all for each of EP1 to EP8 (Figures 16, 18 and 19), curves and kernels\n"
    "(Figures 20 to 23), the table of chips (Table V); then the T-72 with CW-SSIM beside the\n"
    "simulator's own law (Figure 25) where its folders are given. Results are left in folders\n"
    "slicy-EP8 and t72-EP8 below FOLDER; what is there already is gone on with."};

enum { OPTIONS = NM_TRAIN_OPTIONS + 10 };

struct folders {
    const char *slicy_15, *slicy_30, *t72_15, *t72_17, *out;
    bool is_all, is_counted_left;
    double slicy_turn_deg, t72_turn_deg;
};

/* The chips of both folders, the shares of Table II of them for training. */
static int join_folders(const char *low, const char *high, uint64_t seed, struct nm_chip_list *list)
{
    const char *const folders[2] = {low, high};
    const double shares[2] = {0.2, 0.8};
    struct hs_rng rng;
    *list = (struct nm_chip_list){0};
    hs_rng_seed(&rng, seed);
    for (int f = 0; f < 2; f++) {
        struct nm_chip_list part;
        if (nm_chip_list_read(&part, folders[f]) != 0) {
            nm_chip_list_free(list);
            return -1;
        }
        int wanted = (int)(shares[f] * part.count + 0.5);
        for (int i = 0; i < part.count; i++) {
            const int left = part.count - i;
            const bool is_training = (int)hs_rng_below(&rng, (uint32_t)left) < wanted;
            part.entries[i].set = is_training ? NM_SET_TRAINING : NM_SET_VALIDATION;
            wanted -= is_training;
        }
        if (nm_chip_list_append(list, &part) != 0) {
            nm_chip_list_free(list);
            return -1;
        }
    }
    return 0;
}

static bool has_training(const char *folder)
{
    char path[4096];
    return hs_output_path(path, sizeof path, folder, "training.netem") == 0 &&
           access(path, F_OK) == 0;
}

/* One training with all its results in FOLDER/target-EPn. */
static int train_one(struct nm_experiment *e, const char *folder, const char *target,
                     const char *architecture)
{
    char name[64], path[4096];
    struct nm_summary summary;
    snprintf(name, sizeof name, "%s-%s", target, architecture);
    if (hs_output_path(path, sizeof path, folder, name) != 0) {
        return -1;
    }
    if (e->training) {
        nm_training_close(e->training);
        free(e->training);
        e->training = NULL;
    }
    e->settings.architecture = architecture;
    printf("== %s\n", name);
    hs_report_object(NULL);
    hs_report_put("name", name);
    const struct nm_samples others = nm_dataset_validation(&e->dataset);
    if (nm_experiment_train(e, path, has_training(path)) != 0 ||
        nm_experiment_plot(e->training, path, (int)e->view.scene.material_count, NULL) != 0 ||
        nm_experiment_score(e, &others, path, &summary) != 0) {
        return -1;
    }
    nm_summary_print(&summary, name);
    hs_report_close();
    return 0;
}

static int run_target(const struct nm_settings *settings, const struct folders *f,
                      const char *target, const char *low, const char *high)
{
    struct nm_chip_list list;
    struct nm_experiment e;
    if (join_folders(low, high, (uint64_t)settings->seed, &list) != 0) {
        return -1;
    }
    int result = nm_experiment_open(&e, settings, 15);
    result = result == 0 ? nm_experiment_load(&e, &list) : -1;
    nm_chip_list_free(&list);
    for (int i = 0; i < NM_ARCHITECTURES && result == 0; i++) {
        const char *name = nm_architectures[NM_BY_COEFFICIENT][i].name;
        if (f->is_all ? i < NM_PAPERS : strcmp(name, settings->architecture) == 0) {
            result = train_one(&e, f->out, target, name);
        }
    }
    nm_experiment_close(&e);
    return result;
}

static int run(struct nm_settings *s, const struct folders *f)
{
    const struct nm_architecture *architecture;
    struct nm_plan plan;
    char unused[4096];
    if (nm_settings_plan(s, &plan, &architecture) != 0 ||
        hs_output_path(unused, sizeof unused, f->out, "") != 0) {
        return -1;
    }
    hs_report_array("trainings");
    s->gain = 1; /* MSTAR magnitudes are calibrated */
    s->calibration.is_counted_left = f->is_counted_left;
    s->calibration.turn_deg = f->slicy_turn_deg;
    s->setup.model = "slicy";
    if (run_target(s, f, "slicy", f->slicy_15, f->slicy_30) != 0) {
        return -1;
    }
    if (!f->t72_15) {
        return 0;
    }
    s->setup.model = "tank";
    s->setup.cells = 160;
    s->calibration.turn_deg = f->t72_turn_deg;
    struct folders only = *f;
    only.is_all = false;
    return run_target(s, &only, "t72", f->t72_15, f->t72_17);
}

int nm_cmd_paper(int argc, char **argv)
{
    struct nm_settings s = nm_settings_default();
    struct folders f = {0};
    int exit_code;
    struct hs_option options[OPTIONS] = {
        {"slicy-15", HS_TEXT, &f.slicy_15, 0, 0, "FOLDER", "raw chips of SLICY at 15 degrees",
         true},
        {"slicy-30", HS_TEXT, &f.slicy_30, 0, 0, "FOLDER", "and at 30 degrees", true},
        {"t72-15", HS_TEXT, &f.t72_15, 0, 0, "FOLDER", "raw chips of the T-72 at 15 degrees",
         false},
        {"t72-17", HS_TEXT, &f.t72_17, 0, 0, "FOLDER", "and at 17 degrees", false},
        {"out", HS_FOLDER, &f.out, 0, 0, "FOLDER", "for the results", true},
        {"all", HS_FLAG, &f.is_all, 0, 0, NULL, "train EP1 to EP8, not one architecture", false},
        {"azimuth-left", HS_FLAG, &f.is_counted_left, 0, 0, NULL,
         "MSTAR's TargetAz counts to the left; here the radar goes round to the right", false},
        {"slicy-turn", HS_REAL, &f.slicy_turn_deg, -360, 360, "DEG",
         "between SLICY's TargetAz 0 and the model's nose", false},
        {"t72-turn", HS_REAL, &f.t72_turn_deg, -360, 360, "DEG", "the same of the T-72", false},
        {"rays", HS_INTEGER, &s.setup.rays_per_cell, 1, 16, "N",
         "N x N of them meet a cell of level ground", false},
    };
    nm_train_options(&s, options + 10);
    if (!hs_options_read(&usage, options, OPTIONS, argc, argv, &exit_code)) {
        return exit_code;
    }
    if (!f.t72_15 != !f.t72_17) {
        hs_error("--t72-15", "give both or neither", "goes with --t72-17");
        return HS_EXIT_USAGE;
    }
    return run(&s, &f) == 0 ? HS_EXIT_OK : HS_EXIT_FAILED;
}
