#include "commands.h"

#include "hs/error.h"
#include "hs/report.h"
#include "netem/experiment.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const struct hs_usage usage = {
    "score", "simulated chips beside real ones: MSE, SSIM, CW-SSIM and a picture",
    "Simulate each chip's aspect with what was learned and with the simulator's own law, whose\n"
    "gain is fitted on the training chips, and compare both with the real chip; CW-SSIM also\n"
    "with both at the gains that suit it best on the training chips. Leaves\n"
    "scores.tsv, cw-ssim.png and table.png in the folder, and up to three sheets of simulated\n"
    "chips, with speckle and without, beside real ones from all around. Chips, calibration, "
    "--share and\n"
    "--seed must be those of the training, or the chips that validate are not the same.\n"
    "Beside them stand null models, which simulate nothing: a flat picture, the mean of the\n"
    "training chips, and the training chip of the nearest other azimuth. --others takes lists of\n"
    "other vehicles' chips, as `register` leaves them for this model: they should fit worse."};

enum { OWN_OPTIONS = NM_VIEW_OPTIONS + NM_LAW_OPTIONS };
enum { OPTIONS = OWN_OPTIONS + NM_CHIP_OPTIONS + 5 };

static int beside(struct nm_experiment *e, const struct nm_samples *samples, const char *path,
                  const struct nm_summary *summary, struct nm_first *firsts)
{
    struct nm_chip_list list;
    struct nm_vehicle v = {.name = path};
    if (nm_chip_list_read(&list, path) != 0) {
        return -1;
    }
    const int result = nm_experiment_beside(e, samples, &list, summary, &v, firsts);
    nm_chip_list_free(&list);
    if (result == 0) {
        printf("  other vehicle, %s, %d chips: mse %.6f   cw-ssim %.4f, at the best gain %.4f\n",
               v.name, v.count, v.fit.mse, v.fit.cw_ssim, v.fit.best_cw_ssim);
        hs_report_object(NULL);
        hs_report_text("file", v.name);
        hs_report_integer("chips", v.count);
        hs_report_real("mse", v.fit.mse);
        hs_report_real("cw_ssim", v.fit.cw_ssim);
        hs_report_real("best_cw_ssim", v.fit.best_cw_ssim);
        hs_report_close();
    }
    return result;
}

/* How many chips came first, in all four ways, printed and reported. */
static void print_firsts(const struct nm_first *firsts, int count)
{
    int by_cw_ssim = 0, by_mse = 0, null_by_cw_ssim = 0, null_by_mse = 0;
    for (int i = 0; i < count; i++) {
        by_cw_ssim += firsts[i].by_cw_ssim;
        by_mse += firsts[i].by_mse;
        null_by_cw_ssim += firsts[i].null_by_cw_ssim;
        null_by_mse += firsts[i].null_by_mse;
    }
    printf(
        "  fitted better than the others' chips of the nearest azimuths: %d of %d by "
        "cw-ssim at the best gain, %d by mse\n",
        by_cw_ssim, count, by_mse);
    printf("  null model, nearest chip in the simulator's place: %d by cw-ssim, %d by mse\n",
           null_by_cw_ssim, null_by_mse);
    hs_report_integer("first_by_cw_ssim", by_cw_ssim);
    hs_report_integer("first_by_mse", by_mse);
    hs_report_integer("null_first_by_cw_ssim", null_by_cw_ssim);
    hs_report_integer("null_first_by_mse", null_by_mse);
}

static int beside_all(struct nm_experiment *e, const struct nm_samples *samples,
                      const struct hs_list *others, const struct nm_summary *summary)
{
    int result = 0;
    struct nm_first *firsts = malloc(((size_t)samples->count + 1) * sizeof *firsts);
    if (!firsts) {
        return hs_error("scores", NULL, "out of memory");
    }
    for (int i = 0; i < samples->count; i++) {
        firsts[i] = (struct nm_first){true, true, true, true};
    }
    hs_report_array("others");
    for (int i = 0; i < others->count && result == 0; i++) {
        result = beside(e, samples, others->items[i], summary, firsts);
    }
    hs_report_close();
    if (result == 0) {
        print_firsts(firsts, samples->count);
    }
    free(firsts);
    return result;
}

static int run(const struct nm_settings *settings, const struct nm_chip_list *list,
               const char *training, const char *set, const struct hs_list *others, const char *out)
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
        if (result == 0) {
            nm_summary_print(&summary, set);
            result = others->count > 0 ? beside_all(&e, &samples, others, &summary) : 0;
        }
    }
    nm_experiment_close(&e);
    return result;
}

static int score(const struct nm_settings *s, const char *training, const char *set,
                 const struct hs_list *others, const char *out)
{
    struct nm_chip_list list;
    if (nm_chip_list_read(&list, s->chips) != 0) {
        return HS_EXIT_FAILED;
    }
    const int result = run(s, &list, training, set, others, out);
    nm_chip_list_free(&list);
    return result == 0 ? HS_EXIT_OK : HS_EXIT_FAILED;
}

int nm_cmd_score(int argc, char **argv)
{
    struct nm_settings s = nm_settings_default();
    const char *out = NULL, *training = NULL, *set = "validation";
    struct hs_list others = {.count = 0};
    int exit_code;
    struct hs_option options[OPTIONS] = {
        {"training", HS_INPUT, &training, 0, 0, "FILE", "that `train` left", true},
        {"out", HS_FOLDER, &out, 0, 0, "FOLDER", "for the results", true},
        {"set", HS_WORD, &set, 0, 0, "validation|training", "which chips", false},
        {"seed", HS_INTEGER, &s.seed, 0, 1e15, "N", "of the division into both", false},
        {"others", HS_INPUTS, &others, 0, 0, "LIST,...", "of chips of other vehicles", false},
    };
    nm_view_options(&s, options + 5);
    nm_law_options(&s, options + 5 + NM_VIEW_OPTIONS);
    nm_chip_options(&s, options + 5 + OWN_OPTIONS);
    if (!hs_options_read(&usage, options, OPTIONS, argc, argv, &exit_code)) {
        hs_list_free(&others);
        return exit_code;
    }
    exit_code = score(&s, training, set, &others, out);
    hs_list_free(&others);
    return exit_code;
}
