#include "commands.h"

#include "hs/error.h"
#include "netem/experiment.h"

#include <stdio.h>
#include <string.h>

static const struct hs_usage usage = {
    "score", "simulated chips beside real ones: MSE, SSIM, CW-SSIM and a picture",
    "Simulate each chip's aspect with what was learned and with the simulator's own law, whose\n"
    "gain is fitted on the training chips, and compare both with the real chip; CW-SSIM also\n"
    "with both at the gains that suit it best on the training chips. Leaves\n"
    "scores.tsv, cw-ssim.png and table.png in the folder. Chips, calibration, --share and\n"
    "--seed must be those of the training, or the chips that validate are not the same."};

enum { OPTIONS = NM_TARGET_OPTIONS + NM_CHIP_OPTIONS + 4 };

static int run(const struct nm_settings *settings, const struct nm_chip_list *list,
               const char *training, const char *set, const char *out)
{
    struct nm_experiment e;
    struct nm_summary summary;
    if (nm_experiment_open(&e, settings, nm_settings_lowest(settings, list)) != 0) {
        return -1;
    }
    int result = nm_experiment_take(&e, training);
    result = result == 0 ? nm_experiment_load(&e, list) : -1;
    if (result == 0) {
        const struct nm_samples samples = strcmp(set, "training") == 0
                                              ? nm_dataset_training(&e.dataset)
                                              : nm_dataset_validation(&e.dataset);
        result = nm_experiment_score(&e, &samples, out, &summary);
    }
    if (result == 0) {
        nm_summary_print(&summary, set);
    }
    nm_experiment_close(&e);
    return result;
}

int nm_cmd_score(int argc, char **argv)
{
    struct nm_settings s = nm_settings_default();
    struct nm_chip_list list;
    const char *out = NULL, *training = NULL, *set = "validation";
    int exit_code;
    struct hs_option options[OPTIONS] = {
        {"training", HS_INPUT, &training, 0, 0, "FILE", "that `train` left", true},
        {"out", HS_FOLDER, &out, 0, 0, "FOLDER", "for the results", true},
        {"set", HS_TEXT, &set, 0, 0, "validation|training", "which chips; default validation",
         false},
        {"seed", HS_INTEGER, &s.seed, 0, 1e15, "N", "of the division into both", false},
    };
    nm_target_options(&s, options + 4);
    nm_chip_options(&s, options + 4 + NM_TARGET_OPTIONS);
    if (!hs_options_read(&usage, options, OPTIONS, argc, argv, &exit_code)) {
        return exit_code;
    }
    if (strcmp(set, "validation") != 0 && strcmp(set, "training") != 0) {
        hs_error("--set", NULL, "must be validation or training, not %s", set);
        return HS_EXIT_USAGE;
    }
    if (nm_chip_list_read(&list, s.chips) != 0) {
        return HS_EXIT_FAILED;
    }
    const int result = run(&s, &list, training, set, out);
    nm_chip_list_free(&list);
    return result == 0 ? HS_EXIT_OK : HS_EXIT_FAILED;
}
