#include "experiment.h"

#include "report.h"

#include "hs/atomic_file.h"
#include "hs/error.h"
#include "hs/progress.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SHOWN = 8, KINDS = 3, REAL = 0, OWN = 1, LEARNED = 2, GAINS = 41, FITTED_MAX = 24 };

/* Everything of the scored chips: for each, KINDS squares. */
struct scored {
    int count, side;
    double *pixels;
    struct nm_score *learned, *own;
    double *azimuth_deg;
};

static int scored_open(struct scored *s, int count, int side)
{
    const size_t n = (size_t)count + 1;
    *s = (struct scored){count,
                         side,
                         malloc(n * KINDS * (size_t)(side * side) * sizeof(double)),
                         malloc(n * sizeof *s->learned),
                         malloc(n * sizeof *s->own),
                         malloc(n * sizeof(double))};
    return s->pixels && s->learned && s->own && s->azimuth_deg
               ? 0
               : hs_error("scores", "take fewer chips", "out of memory");
}

static void scored_close(struct scored *s)
{
    free(s->pixels);
    free(s->learned);
    free(s->own);
    free(s->azimuth_deg);
}

static double *square_of(const struct scored *s, int chip, int kind)
{
    return s->pixels + (size_t)(chip * KINDS + kind) * (size_t)(s->side * s->side);
}

/* The simulator's own picture, its kernel times `gain`, in t->simulator.pixels. */
static void draw_own(struct nm_training *t, const struct nm_sample *sample, double gain,
                     double *kernel)
{
    for (int i = 0; i < NM_LARGE * NM_LARGE; i++) {
        kernel[i] = gain * t->model.kernel[i];
    }
    nm_netpix_fixed(&t->simulator.pix, kernel, sample->own, t->simulator.pixels);
}

static struct nm_origin place(struct nm_training *t, const struct nm_sample *sample)
{
    return t->plan.reach_px > 0 ? nm_register(&t->registrar, t->simulator.pixels, &sample->real,
                                              sample->origin, t->plan.reach_px, NULL)
                                : sample->origin;
}

/* The gain, from a thousandth of the kernel's to a hundredfold, of the least mean square error. */
static double fit_gain(struct nm_training *t, const struct nm_samples *samples, double *kernel)
{
    double best_gain = 1, least = INFINITY;
    const int count = samples->count < FITTED_MAX ? samples->count : FITTED_MAX;
    for (int g = 0; g < GAINS && count > 0; g++) {
        const double gain = pow(10, -3 + 5.0 * g / (GAINS - 1));
        double sum = 0;
        for (int i = 0; i < count; i++) {
            const struct nm_sample *s = &samples->items[i * samples->count / count];
            draw_own(t, s, gain, kernel);
            sum += nm_loss(NM_MSE, t->simulator.pixels, t->simulator.side_px, &s->real, place(t, s),
                           NULL);
        }
        best_gain = sum < least ? gain : best_gain;
        least = fmin(sum, least);
    }
    return best_gain;
}

/* Score what the simulator shows against the real chip below it, and keep both. */
static int score_shown(struct nm_training *t, const struct nm_sample *sample, struct nm_origin at,
                       double *kept, double *real, struct nm_score *score)
{
    const int side = t->simulator.side_px;
    memcpy(kept, t->simulator.pixels, (size_t)(side * side) * sizeof *kept);
    nm_picture_cut(&sample->real, at, side, real);
    return nm_score(kept, real, side, score);
}

static int score_chip(struct nm_training *t, const struct nm_sample *sample, double own_gain,
                      double *kernel, struct scored *s, int i)
{
    struct nm_origin at;
    double *real = square_of(s, i, REAL);
    draw_own(t, sample, own_gain, kernel);
    if (score_shown(t, sample, place(t, sample), square_of(s, i, OWN), real, &s->own[i]) != 0 ||
        nm_training_show(t, sample, &at) != 0) {
        return -1;
    }
    s->azimuth_deg[i] = sample->azimuth_deg;
    return score_shown(t, sample, at, square_of(s, i, LEARNED), real, &s->learned[i]);
}

static void add(struct nm_score *sum, const struct nm_score *score, int count)
{
    sum->mse += score->mse / count;
    sum->ssim += score->ssim / count;
    sum->cw_ssim += score->cw_ssim / count;
}

static int write_scores(const struct scored *s, const struct nm_samples *samples, const char *path)
{
    struct hs_atomic_file file;
    if (hs_atomic_open(&file, path) != 0) {
        return -1;
    }
    fputs("chip\tazimuth\tmse\tssim\tcw_ssim\town_mse\town_ssim\town_cw_ssim\n", file.stream);
    for (int i = 0; i < s->count; i++) {
        const struct nm_score *l = &s->learned[i], *o = &s->own[i];
        fprintf(file.stream, "%s\t%.2f\t%.6f\t%.4f\t%.4f\t%.6f\t%.4f\t%.4f\n",
                samples->items[i].name, s->azimuth_deg[i], l->mse, l->ssim, l->cw_ssim, o->mse,
                o->ssim, o->cw_ssim);
    }
    return hs_atomic_commit(&file);
}

static int draw_table(const struct scored *s, const char *path)
{
    const double *pictures[SHOWN * KINDS];
    static const char *const titles[KINDS] = {"real chip", "own law", "learned"};
    char text[SHOWN][16];
    const char *names[SHOWN];
    const int shown = s->count < SHOWN ? s->count : SHOWN;
    for (int k = 0; k < shown; k++) {
        const int i = k * s->count / shown;
        snprintf(text[k], sizeof text[k], "%.0f deg", s->azimuth_deg[i]);
        names[k] = text[k];
        for (int kind = 0; kind < KINDS; kind++) {
            pictures[k * KINDS + kind] = square_of(s, i, kind);
        }
    }
    return nm_report_table(path, pictures, shown, KINDS, s->side, titles, names);
}

static int draw_curves(const struct scored *s, const char *path)
{
    double *cw = malloc(2 * ((size_t)s->count + 1) * sizeof *cw);
    if (!cw) {
        return hs_error("scores", NULL, "out of memory");
    }
    for (int i = 0; i < s->count; i++) {
        cw[i] = s->learned[i].cw_ssim;
        cw[s->count + i] = s->own[i].cw_ssim;
    }
    const struct nm_score_curve curves[2] = {{"learned", s->azimuth_deg, cw, s->count},
                                             {"own law", s->azimuth_deg, cw + s->count, s->count}};
    const int result = nm_report_scores(path, "cw-ssim with the real chip", curves, 2);
    free(cw);
    return result;
}

static int report(const struct scored *s, const struct nm_samples *samples, const char *folder)
{
    char table[4096], curves[4096], scores[4096];
    if (nm_report_path(table, sizeof table, folder, "table.png") != 0 ||
        nm_report_path(curves, sizeof curves, folder, "cw-ssim.png") != 0 ||
        nm_report_path(scores, sizeof scores, folder, "scores.tsv") != 0) {
        return -1;
    }
    return draw_table(s, table) == 0 && draw_curves(s, curves) == 0 &&
                   write_scores(s, samples, scores) == 0
               ? 0
               : -1;
}

static int score_all(struct nm_experiment *e, const struct nm_samples *samples, double *kernel,
                     struct scored *s, struct nm_summary *summary)
{
    const struct nm_samples training = nm_dataset_training(&e->dataset);
    struct hs_progress progress;
    int result = 0;
    if (summary->own_gain == 0) {
        summary->own_gain = fit_gain(e->training, &training, kernel);
    }
    hs_progress_begin(&progress, "scoring", (uint64_t)s->count);
    for (int i = 0; i < s->count && result == 0; i++) {
        result = score_chip(e->training, &samples->items[i], summary->own_gain, kernel, s, i);
        if (result == 0) {
            add(&summary->learned, &s->learned[i], s->count);
            add(&summary->own, &s->own[i], s->count);
        }
        hs_progress_update(&progress, (uint64_t)i + 1);
    }
    hs_progress_end(&progress);
    return result;
}

int nm_experiment_score(struct nm_experiment *e, const struct nm_samples *samples,
                        const char *folder, double own_gain, struct nm_summary *summary)
{
    struct scored s = {0};
    double *kernel = malloc(NM_LARGE * NM_LARGE * sizeof *kernel);
    *summary = (struct nm_summary){.count = samples->count, .own_gain = own_gain};
    int result = kernel ? 0 : hs_error("scores", NULL, "out of memory");
    result = samples->count > 0
                 ? result
                 : hs_error("scores", "give another --share", "has no chips to score");
    result = result == 0 ? scored_open(&s, samples->count, e->training->simulator.side_px) : -1;
    if (result == 0) {
        result = score_all(e, samples, kernel, &s, summary);
    }
    result = result == 0 ? report(&s, samples, folder) : -1;
    scored_close(&s);
    free(kernel);
    return result;
}

void nm_summary_print(const struct nm_summary *s, const char *what)
{
    printf("%s, %d chips:\n", what, s->count);
    printf("  learned   mse %.6f   ssim %.4f   cw-ssim %.4f\n", s->learned.mse, s->learned.ssim,
           s->learned.cw_ssim);
    printf(
        "  own law   mse %.6f   ssim %.4f   cw-ssim %.4f   (gain fitted on the training chips: "
        "%.3g)\n",
        s->own.mse, s->own.ssim, s->own.cw_ssim, s->own_gain);
}
