#include "commands.h"

#include "hs/atomic_file.h"
#include "hs/error.h"
#include "hs/output_path.h"
#include "hs/png.h"
#include "hs/progress.h"
#include "netem/experiment.h"
#include "netem/report.h"
#include "netem/speckle.h"
#include "netem/surfaces.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

static const struct hs_usage usage = {
    "simulate", "chips of any aspect by what was learned",
    "Trace the model from each azimuth and make its chip with the learned networks and pixels:\n"
    "FOLDER/AZIMUTH.csv holds amplitudes, FOLDER/AZIMUTH.png the chip after tanh, 8-bit; near\n"
    "range is at the bottom. Response and gain are those of the training. Both can be given to "
    "`train` and `score` again. With --looks the\n"
    "chips have speckle.\n"
    "With --raw there are two pictures more, of the cells before the radar's response and without\n"
    "speckle: FOLDER/AZIMUTH-peak.png is white at the brightest cell, FOLDER/AZIMUTH-cut.png at\n"
    "--cut-db below it and above."};

enum { OPTIONS = NM_VIEW_OPTIONS + 9 };

struct order {
    const char *training, *out;
    double azimuth_deg, cut_db;
    long views, looks, seed;
    bool is_raw;
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

/* FOLDER/AZIMUTH and what comes behind it. */
static int path_of(char *path, size_t size, const struct order *o, double azimuth_deg,
                   const char *ending)
{
    char name[32];
    snprintf(name, sizeof name, "%06.2f%s", azimuth_deg, ending);
    return hs_output_path(path, size, o->out, name);
}

/* Cells of step 4 in proportion to their amplitude, white at so much below the brightest: peak
 * quantisation at 0 dB, else truncation quantisation (Niu, Fig. 26). */
static int write_raw(const struct nm_simulator *s, const struct order *o, double azimuth_deg,
                     const char *ending, double below_db)
{
    const int side = s->side_px * NM_CELLS_PER_PIXEL;
    double *level = malloc((size_t)(side * side) * sizeof *level), peak = 0;
    char path[4096];
    if (!level) {
        return hs_error(o->out, NULL, "out of memory");
    }
    for (int i = 0; i < side * side; i++) {
        peak = fmax(peak, s->picture[i]);
    }
    for (int i = 0; i < side * side; i++) {
        level[i] = peak > 0 ? s->picture[i] / peak * pow(10, below_db / 20) : 0;
    }
    const int result =
        path_of(path, sizeof path, o, azimuth_deg, ending) == 0 ? write_png(path, level, side) : -1;
    free(level);
    return result;
}

static int write_chip(const struct nm_simulator *s, const struct order *o, double azimuth_deg)
{
    char csv[4096], png[4096];
    return path_of(csv, sizeof csv, o, azimuth_deg, ".csv") == 0 &&
                   path_of(png, sizeof png, o, azimuth_deg, ".png") == 0 &&
                   write_csv(csv, s->pixels, s->side_px) == 0 &&
                   write_png(png, s->pixels, s->side_px) == 0 &&
                   (!o->is_raw || (write_raw(s, o, azimuth_deg, "-peak.png", 0) == 0 &&
                                   write_raw(s, o, azimuth_deg, "-cut.png", o->cut_db) == 0))
               ? 0
               : -1;
}

static int make_chip(struct nm_experiment *e, const struct order *o, double azimuth_deg,
                     struct hs_rng *rng)
{
    struct nm_simulator *s = &e->training->simulator;
    struct nm_paths paths;
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
    return result == 0 ? write_chip(s, o, azimuth_deg) : -1;
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
    result = result == 0 ? nm_surfaces_allow(&settings->setup, e.training->model.architecture) : -1;
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
    struct order o = {.views = 1, .seed = 1, .cut_db = 20};
    int exit_code;
    struct hs_option options[OPTIONS] = {
        {"training", HS_INPUT, &o.training, 0, 0, "FILE", "that `train` left", true},
        {"out", HS_FOLDER, &o.out, 0, 0, "FOLDER", "for the chips", true},
        {"azimuth", HS_REAL, &o.azimuth_deg, -360, 360, "DEG",
         "of the radar as the target sees it, from its nose to the right", false},
        {"views", HS_INTEGER, &o.views, 1, 3600, "N", "evenly around, from --azimuth on", false},
        {"looks", HS_INTEGER, &o.looks, 0, PIX_LOOKS_MAX, "N", "of the speckle; 0: none", false},
        {"seed", HS_INTEGER, &o.seed, 0, 1e15, "N", "of the speckle", false},
        {"raw", HS_FLAG, &o.is_raw, 0, 0, NULL, "cells before the radar's response as well", false},
        {"cut-db", HS_REAL, &o.cut_db, 0, 80, "DB", "below the brightest cell that are white",
         false},
    };
    options[8] = nm_surfaces_option(&s.setup);
    nm_view_options(&s, options + 9);
    if (!hs_options_read(&usage, options, OPTIONS, argc, argv, &exit_code)) {
        return exit_code;
    }
    return run(&s, &o) == 0 ? HS_EXIT_OK : HS_EXIT_FAILED;
}
