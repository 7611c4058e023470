#include "commands.h"

#include "hs/atomic_file.h"
#include "hs/error.h"
#include "hs/output_path.h"
#include "hs/png.h"
#include "hs/progress.h"
#include "netem/experiment.h"
#include "netem/report.h"
#include "netem/speckle.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static const struct hs_usage usage = {
    "simulate", "chips of any aspect by what was learned",
    "Trace the model from each azimuth and make its chip with the learned networks and pixels:\n"
    "FOLDER/AZIMUTH.csv holds amplitudes, FOLDER/AZIMUTH.png the chip after tanh, 8-bit; near\n"
    "range is at the bottom. Response and gain are those of the training. Both can be given to "
    "`train` and `score` again. With --looks the\n"
    "chips have speckle."};

enum { OPTIONS = NM_VIEW_OPTIONS + 6 };

struct order {
    const char *training, *out;
    double azimuth_deg;
    long views, looks, seed;
};

/* As chips lie in files: the far row first. */
static double pixel_at(const double *pixels, int side, int i)
{
    return pixels[(side - 1 - i / side) * side + i % side];
}

static int write_png(const char *path, const double *pixels, int side)
{
    uint8_t *grey = malloc((size_t)(side * side));
    if (!grey) {
        return hs_error(path, NULL, "out of memory");
    }
    for (int i = 0; i < side * side; i++) {
        grey[i] = (uint8_t)lround(255 * fmin(fmax(pixel_at(pixels, side, i), 0), 1));
    }
    const int result = hs_png_write_grey(path, grey, side, side, (size_t)side);
    free(grey);
    return result;
}

static int write_csv(const char *path, const double *pixels, int side)
{
    struct hs_atomic_file file;
    if (hs_atomic_open(&file, path) != 0) {
        return -1;
    }
    for (int i = 0; i < side * side; i++) {
        const double pixel = fmin(fmax(pixel_at(pixels, side, i), 0), 1 - 1e-12);
        fprintf(file.stream, "%.6g%c", atanh(pixel), i % side == side - 1 ? '\n' : ',');
    }
    return hs_atomic_commit(&file);
}

static int make_chip(struct nm_experiment *e, const struct order *o, double azimuth_deg,
                     struct hs_rng *rng)
{
    struct nm_simulator *s = &e->training->simulator;
    struct nm_paths paths;
    char name[32], csv[4096], png[4096];
    if (nm_target_view_paths(&e->view, azimuth_deg, e->settings.setup.depression_deg, &paths,
                             NULL) != 0) {
        return -1;
    }
    int result = nm_simulate(s, &e->training->model, &paths);
    nm_paths_free(&paths);
    if (result == 0 && o->looks > 0) {
        const struct setup *setup = &e->settings.setup;
        result = nm_speckle(s->pixels, s->side_px,
                            pix_aperture(setup->resolution_m, NM_CELLS_PER_PIXEL * setup->cell_m),
                            (int)o->looks, rng);
    }
    snprintf(name, sizeof name, "%06.2f.csv", azimuth_deg);
    result = result == 0 ? hs_output_path(csv, sizeof csv, o->out, name) : -1;
    snprintf(name, sizeof name, "%06.2f.png", azimuth_deg);
    result = result == 0 ? hs_output_path(png, sizeof png, o->out, name) : -1;
    return result == 0 && write_csv(csv, s->pixels, s->side_px) == 0 &&
                   write_png(png, s->pixels, s->side_px) == 0
               ? 0
               : -1;
}

static int run(const struct nm_settings *settings, const struct order *o)
{
    struct nm_experiment e;
    struct hs_rng rng;
    struct hs_progress progress;
    if (nm_experiment_open(&e, settings, settings->setup.depression_deg) != 0) {
        return -1;
    }
    int result = nm_experiment_take(&e, o->training);
    hs_rng_seed(&rng, (uint64_t)o->seed);
    hs_progress_begin(&progress, "chips", (uint64_t)o->views);
    for (long v = 0; v < o->views && result == 0; v++) {
        const double turn = o->azimuth_deg + 360.0 * (double)v / (double)o->views;
        result = make_chip(&e, o, turn - 360 * floor(turn / 360), &rng);
        hs_progress_update(&progress, (uint64_t)v + 1);
    }
    hs_progress_end(&progress);
    nm_experiment_close(&e);
    return result;
}

int nm_cmd_simulate(int argc, char **argv)
{
    struct nm_settings s = nm_settings_default();
    struct order o = {.views = 1, .seed = 1};
    int exit_code;
    struct hs_option options[OPTIONS] = {
        {"training", HS_INPUT, &o.training, 0, 0, "FILE", "that `train` left", true},
        {"out", HS_FOLDER, &o.out, 0, 0, "FOLDER", "for the chips", true},
        {"azimuth", HS_REAL, &o.azimuth_deg, -360, 360, "DEG",
         "of the radar as the target sees it, from its nose to the right", false},
        {"views", HS_INTEGER, &o.views, 1, 3600, "N", "evenly around, from --azimuth on", false},
        {"looks", HS_INTEGER, &o.looks, 0, PIX_LOOKS_MAX, "N", "of the speckle; 0: none", false},
        {"seed", HS_INTEGER, &o.seed, 0, 1e15, "N", "of the speckle", false},
    };
    nm_view_options(&s, options + 6);
    if (!hs_options_read(&usage, options, OPTIONS, argc, argv, &exit_code)) {
        return exit_code;
    }
    return run(&s, &o) == 0 ? HS_EXIT_OK : HS_EXIT_FAILED;
}
