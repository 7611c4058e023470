#include "commands.h"

#include "hs/error.h"
#include "hs/output_path.h"
#include "netem/experiment.h"
#include "netem/model_file.h"
#include "netem/report.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const struct hs_usage usage = {
    "plot", "draw what was learned: loss, reflection curves, kernels",
    "Figures 20 to 23 of the paper, of the first training given: specular.png, back.png,\n"
    "kernels.png and loss.png. With several trainings loss.png shows them together, as Figures\n"
    "16, 18 and 19 do."};

enum { TRAININGS_MAX = 16, CELLS = 64 };

/* The names under the curves are the files' names without the last part. */
static const char *short_name(const char *path, char *name, size_t size)
{
    snprintf(name, size, "%s", path);
    char *slash = strrchr(name, '/');
    if (slash) {
        *slash = '\0';
        slash = strrchr(name, '/');
    }
    return slash ? slash + 1 : name;
}

static int plot(struct nm_training **trainings, const struct hs_list *files, const char *out,
                int materials)
{
    struct nm_loss_curve curves[TRAININGS_MAX];
    char names[TRAININGS_MAX][256], path[4096];
    for (int i = 0; i < files->count; i++) {
        curves[i] = (struct nm_loss_curve){short_name(files->items[i], names[i], sizeof names[i]),
                                           trainings[i]->epochs, trainings[i]->epoch_count};
    }
    return nm_experiment_plot(trainings[0], out, materials, NULL) == 0 &&
                   hs_output_path(path, sizeof path, out, "loss.png") == 0 &&
                   nm_report_losses(path, "loss by epoch", curves, files->count) == 0
               ? 0
               : -1;
}

static int run(const struct hs_list *files, const char *out, int materials)
{
    struct nm_training *trainings[TRAININGS_MAX] = {NULL};
    int count = 0, result = 0;
    for (; count < files->count && result == 0; count++) {
        trainings[count] = malloc(sizeof **trainings);
        result = trainings[count] ? nm_model_read(trainings[count], files->items[count], CELLS)
                                  : hs_error("plot", NULL, "out of memory");
        if (result != 0) {
            free(trainings[count--]);
        }
    }
    if (result == 0) {
        result = plot(trainings, files, out, materials);
    }
    while (count-- > 0) {
        nm_training_close(trainings[count]);
        free(trainings[count]);
    }
    return result;
}

int nm_cmd_plot(int argc, char **argv)
{
    struct hs_list files = {.count = 0};
    const char *out = NULL;
    long materials = 2;
    int exit_code;
    const struct hs_option options[] = {
        {"training", HS_LIST, &files, 0, 0, "FILE,...", "that `train` left; up to 16 of them",
         true},
        {"out", HS_FOLDER, &out, 0, 0, "FOLDER", "for the pictures", true},
        {"materials", HS_INTEGER, &materials, 1, 8, "N", "whose curves are drawn", false},
    };
    const size_t count = sizeof options / sizeof options[0];
    if (!hs_options_read(&usage, options, count, argc, argv, &exit_code)) {
        hs_list_free(&files);
        return exit_code;
    }
    const int result = files.count <= TRAININGS_MAX
                           ? run(&files, out, (int)materials)
                           : hs_error("--training", NULL, "names more than %d", TRAININGS_MAX);
    hs_list_free(&files);
    return result == 0 ? HS_EXIT_OK : HS_EXIT_FAILED;
}
