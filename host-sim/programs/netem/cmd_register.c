#include "commands.h"

#include "hs/atomic_file.h"
#include "hs/error.h"
#include "hs/progress.h"
#include "hs/report.h"
#include "netem/model_file.h"
#include "netem/search.h"
#include "netem/settings.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const struct hs_usage usage = {
    "register", "find from where chips were taken that do not say so",
    "Lay the untrained simulator's pictures, from all around, over each chip; the azimuth and\n"
    "place that correlate best are written into a list that `train` and `score` take, with the\n"
    "gain that calibrates the chip by its clutter. With --in-order the chips are taken as a\n"
    "collection in the order of the list: circles about the target in even steps, so that a\n"
    "chip whose front looks like its back is told by its neighbours. Prints how ambiguous the\n"
    "choice is. Where fronts look like backs on all of them, the whole chain may be the wrong way\n"
    "round: --turned gives the other one; train on both and keep what fits chips held out better.\n"
    "With --training the pictures are those of a learned simulator, which lie better."};

enum { OPTIONS = NM_TARGET_OPTIONS + NM_CHIP_OPTIONS + 7 };
static const double ambiguous = 0.02; /* of the correlation coefficient */

/* All that one run holds. */
struct run {
    struct nm_settings settings;
    const char *out, *scores, *learned;
    struct nm_training *training; /* of the file `learned`; NULL without one */
    long views, reach_px;
    bool is_in_order, is_turned;
    struct nm_chip_list list;
    struct nm_library library;
    struct nm_searcher searcher;
    struct nm_match *matches; /* by chip */
    int *chosen;
    double step_deg;
};

/* The amplitudes of a view: far below where tanh bends. */
static int draw_view(const struct run *r, const struct nm_target_view *view, struct nm_netpix *pix,
                     const double *kernel, int v, double *own)
{
    struct nm_paths paths;
    struct reflect_law law;
    const int side = r->library.side_px;
    if (nm_target_view_paths(view, v * 360.0 / r->library.views, view->setup.depression_deg, &paths,
                             &law) != 0) {
        return -1;
    }
    const int result = nm_draw_by_law(&paths, &law, own);
    nm_netpix_fixed(pix, kernel, own, r->library.pictures + (size_t)v * (size_t)(side * side));
    nm_paths_free(&paths);
    return result;
}

static int show_view(struct run *r, const struct nm_target_view *view, int v)
{
    struct nm_paths paths;
    struct nm_training *t = r->training;
    const size_t pixels = (size_t)r->library.side_px * (size_t)r->library.side_px;
    if (nm_target_view_paths(view, v * 360.0 / r->library.views, view->setup.depression_deg, &paths,
                             NULL) != 0) {
        return -1;
    }
    const int result = nm_simulate(&t->simulator, &t->model, &paths);
    memcpy(r->library.pictures + (size_t)v * pixels, t->simulator.pixels,
           pixels * sizeof *t->simulator.pixels);
    nm_paths_free(&paths);
    return result;
}

/* The learned views: they have the chips' level already. */
static int show_views(struct run *r, struct nm_target_view *view)
{
    struct hs_progress progress;
    int result = 0;
    view->known = &r->training->materials;
    view->connection = r->training->model.architecture->connection;
    hs_progress_begin(&progress, "views", (uint64_t)r->library.views);
    for (int v = 0; v < r->library.views && result == 0; v++) {
        result = show_view(r, view, v);
        hs_progress_update(&progress, (uint64_t)v + 1);
    }
    hs_progress_end(&progress);
    return result;
}

static int take_training(struct run *r)
{
    r->training = calloc(1, sizeof *r->training);
    if (!r->training) {
        return hs_error("training", NULL, "out of memory");
    }
    if (nm_model_read(r->training, r->learned, (int)r->settings.setup.cells) != 0) {
        free(r->training);
        r->training = NULL;
        return -1;
    }
    return 0;
}

/* The untrained views, brought to the chips' level. */
static int draw_views(struct run *r, const struct nm_target_view *view)
{
    struct nm_netpix pix;
    const struct setup *s = &r->settings.setup;
    double kernel[NM_LARGE * NM_LARGE];
    double *own = malloc((size_t)s->cells * (size_t)s->cells * sizeof *own);
    int result = own ? 0 : hs_error("views", NULL, "out of memory");
    struct hs_progress progress;
    if (result != 0 || nm_netpix_open(&pix, (int)s->cells) != 0) {
        free(own);
        return -1;
    }
    nm_kernel_make(s->resolution_m, s->cell_m, 1e-6, kernel);
    hs_progress_begin(&progress, "views", (uint64_t)r->library.views);
    for (int v = 0; v < r->library.views && result == 0; v++) {
        result = draw_view(r, view, &pix, kernel, v, own);
        hs_progress_update(&progress, (uint64_t)v + 1);
    }
    hs_progress_end(&progress);
    nm_netpix_close(&pix);
    free(own);
    return result == 0 ? nm_library_calibrate(&r->library, r->settings.calibration.clutter) : -1;
}

static int make_library(struct run *r)
{
    struct nm_target_view view;
    const struct setup *s = &r->settings.setup;
    if ((r->learned && take_training(r) != 0) ||
        nm_library_open(&r->library, (int)r->views, (int)s->cells / NM_CELLS_PER_PIXEL) != 0 ||
        nm_target_view_open(&view, s, s->depression_deg) != 0) {
        return -1;
    }
    const int result = r->training ? show_views(r, &view) : draw_views(r, &view);
    nm_target_view_close(&view);
    return result;
}

static int match_chip(struct run *r, int i, const struct nm_calibration *calibration)
{
    struct nm_chip chip;
    struct nm_chip_entry *e = &r->list.entries[i];
    if (nm_dataset_chip(&chip, e, calibration) != 0) {
        return -1;
    }
    const struct nm_picture *p = &chip.picture;
    int result = 0;
    if (p->width != r->searcher.width || p->height != r->searcher.height) {
        nm_searcher_close(&r->searcher);
        result = nm_searcher_open(&r->searcher, &r->library, p->width, p->height);
    }
    result = result == 0 ? nm_match_open(&r->matches[i], r->library.views) : -1;
    if (result == 0) {
        nm_search(&r->searcher, p, (int)r->reach_px, &r->matches[i]);
    }
    nm_picture_close(&chip.picture);
    return result;
}

static int match_all(struct run *r)
{
    const struct nm_calibration calibration = nm_settings_calibration(&r->settings);
    struct hs_progress progress;
    int result = 0;
    hs_progress_begin(&progress, "chips", (uint64_t)r->list.count);
    for (int i = 0; i < r->list.count && result == 0; i++) {
        result = match_chip(r, i, &calibration);
        hs_progress_update(&progress, (uint64_t)i + 1);
    }
    hs_progress_end(&progress);
    return result;
}

/* The list's shift is right and down on the file's picture, from its middle. */
static void enter(struct run *r, int i)
{
    struct nm_chip_entry *e = &r->list.entries[i];
    const struct nm_origin at = r->matches[i].origins[r->chosen[i]];
    const int down = at.y - (r->searcher.height - r->library.side_px) / 2;
    e->azimuth_deg = r->chosen[i] * 360.0 / r->library.views;
    e->depression_deg = r->settings.setup.depression_deg;
    e->shift_x = at.x - (r->searcher.width - r->library.side_px) / 2;
    e->shift_y = r->settings.calibration.is_near_on_top ? down : -down;
}

static int write_scores(const struct run *r)
{
    struct hs_atomic_file file;
    if (hs_atomic_open(&file, r->scores) != 0) {
        return -1;
    }
    fputs("file\tazimuth\tcorrelation\tmargin\tcorrelation of the opposite\n", file.stream);
    for (int i = 0; i < r->list.count; i++) {
        const struct nm_match *m = &r->matches[i];
        const int opposite = (r->chosen[i] + r->library.views / 2) % r->library.views;
        fprintf(file.stream, "%s\t%.2f\t%.4f\t%.4f\t%.4f\n", r->list.entries[i].path,
                r->list.entries[i].azimuth_deg, m->scores[r->chosen[i]],
                nm_search_margin(m, r->library.views, r->chosen[i]), m->scores[opposite]);
    }
    return hs_atomic_commit(&file);
}

static void print_summary(const struct run *r)
{
    double correlation = 0, opposite = 0;
    int close = 0, against = 0;
    for (int i = 0; i < r->list.count; i++) {
        const struct nm_match *m = &r->matches[i];
        const double margin = nm_search_margin(m, r->library.views, r->chosen[i]);
        correlation += m->scores[r->chosen[i]] / r->list.count;
        opposite +=
            m->scores[(r->chosen[i] + r->library.views / 2) % r->library.views] / r->list.count;
        close += fabs(margin) < ambiguous;
        against += margin < 0;
    }
    printf("%d chips against %d views: correlation %.3f, that of the opposite views %.3f\n",
           r->list.count, r->library.views, correlation, opposite);
    printf(
        "ambiguous (another view, more than 30 degrees away, fits within %g): %d; "
        "fits better: %d\n",
        ambiguous, close, against);
    hs_report_put("chips", r->list.count);
    hs_report_put("views", r->library.views);
    hs_report_put("correlation", correlation);
    hs_report_put("opposite_correlation", opposite);
    hs_report_put("ambiguous", close);
    hs_report_put("better_elsewhere", against);
    if (r->is_in_order) {
        hs_report_put("step_deg", r->step_deg);
        printf("steady step from chip to chip: %.0f degrees\n", r->step_deg);
    }
}

static int choose(struct run *r)
{
    int result = 0;
    if (r->is_in_order) {
        result = nm_choose_in_order(r->matches, r->list.count, r->library.views, r->chosen,
                                    &r->step_deg);
    } else {
        nm_choose_alone(r->matches, r->list.count, r->library.views, r->chosen);
    }
    for (int i = 0; i < r->list.count && result == 0 && r->is_turned; i++) {
        r->chosen[i] = (r->chosen[i] + r->library.views / 2) % r->library.views;
    }
    return result;
}

static int run(struct run *r)
{
    r->matches = calloc((size_t)r->list.count, sizeof *r->matches);
    r->chosen = calloc((size_t)r->list.count, sizeof *r->chosen);
    if (!r->matches || !r->chosen) {
        return hs_error("chips", NULL, "out of memory");
    }
    if (make_library(r) != 0 || match_all(r) != 0 || choose(r) != 0) {
        return -1;
    }
    for (int i = 0; i < r->list.count; i++) {
        enter(r, i);
    }
    print_summary(r);
    return nm_chip_list_write(&r->list, r->out, "aspects found by landmass-netem register") == 0 &&
                   (!r->scores || write_scores(r) == 0)
               ? 0
               : -1;
}

static void close_run(struct run *r)
{
    for (int i = 0; r->matches && i < r->list.count; i++) {
        nm_match_close(&r->matches[i]);
    }
    free(r->matches);
    free(r->chosen);
    if (r->training) {
        nm_training_close(r->training);
    }
    free(r->training);
    nm_library_close(&r->library);
    nm_searcher_close(&r->searcher);
    nm_chip_list_free(&r->list);
}

int nm_cmd_register(int argc, char **argv)
{
    struct run r = {.settings = nm_settings_default(), .views = 180, .reach_px = 12};
    int exit_code;
    struct hs_option options[OPTIONS] = {
        {"out", HS_OUTPUT, &r.out, 0, 0, "FILE", "the list", true},
        {"scores", HS_OUTPUT, &r.scores, 0, 0, "FILE", "how well each chip fits, as a table",
         false},
        {"turned", HS_FLAG, &r.is_turned, 0, 0, NULL,
         "take the views opposite to the best: the chips were registered back to front", false},
        {"training", HS_INPUT, &r.learned, 0, 0, "FILE",
         "that `train` left: its networks draw the views", false},
        {"views", HS_INTEGER, &r.views, 4, 3600, "N", "simulated, evenly around", false},
        {"shift", HS_INTEGER, &r.reach_px, 0, 512, "PX",
         "how far from the middle of its chip a target may be", false},
        {"in-order", HS_FLAG, &r.is_in_order, 0, 0, NULL,
         "the chips follow one another as they were taken, on circles about the target", false},
    };
    nm_target_options(&r.settings, options + 7);
    nm_chip_options(&r.settings, options + 7 + NM_TARGET_OPTIONS);
    if (!hs_options_read(&usage, options, OPTIONS, argc, argv, &exit_code)) {
        return exit_code;
    }
    if (nm_chip_list_read(&r.list, r.settings.chips) != 0) {
        return HS_EXIT_FAILED;
    }
    const int result = run(&r);
    close_run(&r);
    return result == 0 ? HS_EXIT_OK : HS_EXIT_FAILED;
}
