#include "commands.h"

#include "hs/error.h"
#include "netem/experiment.h"

#include <stdio.h>

static const struct hs_usage usage = {
    "train", "learn the reflection of a target from real chips",
    "Trace the model from the aspect of each chip, then train the reflection networks: some\n"
    "epochs on the simulator's own picture, then on the real chips, registered by phase\n"
    "correlation, at last the trainable kernels of the pixels with the networks frozen.\n"
    "FOLDER/training.netem holds the state after each epoch: a killed training goes on with\n"
    "--resume to the same bits. Pictures of what was learned and scores of the validation\n"
    "chips are left in the folder."};

enum { OPTIONS = NM_TARGET_OPTIONS + NM_CHIP_OPTIONS + NM_TRAIN_OPTIONS + 2 };

static int run(const struct nm_settings *settings, const struct nm_chip_list *list, const char *out,
               bool is_resumed)
{
    struct nm_experiment e;
    struct nm_summary summary;
    if (nm_experiment_open(&e, settings, nm_settings_lowest(settings, list)) != 0) {
        return -1;
    }
    int result = nm_experiment_load(&e, list);
    result = result == 0 ? nm_experiment_train(&e, out, is_resumed) : -1;
    if (result == 0) {
        result = nm_experiment_plot(e.training, out, (int)e.view.scene.material_count, NULL);
    }
    const struct nm_samples others = nm_dataset_validation(&e.dataset);
    if (result == 0 && others.count > 0) {
        result = nm_experiment_score(&e, &others, out, &summary);
        if (result == 0) {
            nm_summary_print(&summary, "validation");
        }
    }
    nm_experiment_close(&e);
    return result;
}

int nm_cmd_train(int argc, char **argv)
{
    struct nm_settings s = nm_settings_default();
    struct nm_chip_list list;
    const char *out = NULL;
    bool is_resumed = false;
    int exit_code;
    struct hs_option options[OPTIONS] = {
        {"out", HS_FOLDER, &out, 0, 0, "FOLDER", "for the results", true},
        {"resume", HS_FLAG, &is_resumed, 0, 0, NULL, "go on where FOLDER's training stopped",
         false},
    };
    nm_target_options(&s, options + 2);
    nm_chip_options(&s, options + 2 + NM_TARGET_OPTIONS);
    nm_train_options(&s, options + 2 + NM_TARGET_OPTIONS + NM_CHIP_OPTIONS);
    if (!hs_options_read(&usage, options, OPTIONS, argc, argv, &exit_code)) {
        return exit_code;
    }
    if (nm_chip_list_read(&list, s.chips) != 0) {
        return HS_EXIT_FAILED;
    }
    const int result = run(&s, &list, out, is_resumed);
    nm_chip_list_free(&list);
    return result == 0 ? HS_EXIT_OK : HS_EXIT_FAILED;
}
