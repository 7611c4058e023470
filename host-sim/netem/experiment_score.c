#include "hs/atomic_file.h"
#include "hs/error.h"
#include "hs/output_path.h"
#include "hs/progress.h"
#include "hs/report.h"
#include "netem/experiment.h"
#include "netem/null_model.h"
#include "netem/report.h"
#include "netem/speckle.h"
#include "tracer/pix.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* REAL twice: below the own law's picture and below the learned one, which may lie elsewhere. */
enum { OWN_REAL, OWN, LEARNED_REAL, LEARNED, KINDS };
enum { SHOWN = 8, SHEETS = 3, SQUARE_GAINS = 41, BEST_GAINS = 17, FITTED_MAX = 24 };

/* What both simulators show of some chips, registered; amplitudes through tanh. */
struct shown {
    int count, side, aperture; /* the last of the radar's response, in pixels (tracer/pix.h) */
    double *pixels;            /* owned: KINDS squares for each chip */
};

static double *square_of(const struct shown *s, int chip, int kind)
{
    return s->pixels + (size_t)(chip * KINDS + kind) * (size_t)(s->side * s->side);
}

/* The simulator's own picture, its amplitudes times `gain`, in t->simulator.pixels. */
static void draw_own(struct nm_training *t, const struct nm_sample *sample, double gain)
{
    const int side = t->simulator.side_px;
    for (int i = 0; i < side * side; i++) {
        t->simulator.pixels[i] = tanh(gain * sample->own_amplitudes[i]);
    }
}

static struct nm_origin place(struct nm_training *t, const struct nm_sample *sample)
{
    return t->plan.reach_px > 0 ? nm_register(&t->registrar, t->simulator.pixels, &sample->real,
                                              sample->origin, t->plan.reach_px, NULL)
                                : sample->origin;
}

/* Chip i of about FITTED_MAX, spread over all of them. */
static const struct nm_sample *fitted(const struct nm_samples *samples, int i, int count)
{
    return &samples->items[(long)i * samples->count / count];
}

static double square_error(struct nm_training *t, const struct nm_samples *samples, double gain)
{
    const int count = samples->count < FITTED_MAX ? samples->count : FITTED_MAX;
    double sum = 0;
    for (int i = 0; i < count; i++) {
        const struct nm_sample *s = fitted(samples, i, count);
        draw_own(t, s, gain);
        sum +=
            nm_loss(NM_MSE, t->simulator.pixels, t->simulator.side_px, &s->real, place(t, s), NULL);
    }
    return sum;
}

/* The gain of the least square error among SQUARE_GAINS from `middle` / `span` to `middle` *
 * `span`.
 */
static double fit_square_near(struct nm_training *t, const struct nm_samples *samples,
                              double middle, double span)
{
    double best_gain = middle, least = INFINITY;
    for (int g = 0; g < SQUARE_GAINS; g++) {
        const double gain = middle * pow(span, -1 + 2.0 * g / (SQUARE_GAINS - 1));
        const double sum = square_error(t, samples, gain);
        best_gain = sum < least ? gain : best_gain;
        least = fmin(sum, least);
    }
    return best_gain;
}

/* Amplitudes may have any unit: from a thousandth to a thousandfold of what makes the own law's
 * mean that of the real chips; then finer. */
static double fit_square(struct nm_training *t, const struct nm_samples *samples)
{
    const int side = t->simulator.side_px;
    double own = 0, real = 0;
    for (int i = 0; i < samples->count; i++) {
        const struct nm_sample *s = &samples->items[i];
        for (int k = 0; k < side * side; k++) {
            own += s->own_amplitudes[k] / (side * side);
        }
        for (int k = 0; k < s->real.width * s->real.height; k++) {
            real += s->real.pixels[k] / (s->real.width * s->real.height);
        }
    }
    const double coarse = fit_square_near(t, samples, own > 0 ? real / own : 1, 1000);
    return fit_square_near(t, samples, coarse, pow(1000, 2.0 / (SQUARE_GAINS - 1)));
}

static void keep(const struct nm_training *t, const struct nm_sample *sample, struct nm_origin at,
                 double *simulated, double *real)
{
    const int side = t->simulator.side_px;
    memcpy(simulated, t->simulator.pixels, (size_t)(side * side) * sizeof *simulated);
    nm_picture_cut(&sample->real, at, side, real);
}

static int show(struct nm_training *t, const struct nm_sample *sample, double own_gain,
                struct shown *s, int i)
{
    struct nm_origin at;
    draw_own(t, sample, own_gain);
    keep(t, sample, place(t, sample), square_of(s, i, OWN), square_of(s, i, OWN_REAL));
    if (nm_training_show(t, sample, &at) != 0) {
        return -1;
    }
    keep(t, sample, at, square_of(s, i, LEARNED), square_of(s, i, LEARNED_REAL));
    return 0;
}

/* Up to `most` of the samples. Returns 0, or -1 with the error reported and nothing to free. */
static int show_all(struct nm_training *t, const struct nm_samples *samples, int most,
                    double own_gain, struct shown *s)
{
    const int side = t->simulator.side_px, count = samples->count < most ? samples->count : most;
    *s = (struct shown){
        count, side, 0,
        malloc(((size_t)count * KINDS * (size_t)(side * side) + 1) * sizeof *s->pixels)};
    int result = s->pixels ? 0 : hs_error("scores", "take fewer chips", "out of memory");
    for (int i = 0; i < count && result == 0; i++) {
        result = show(t, fitted(samples, i, count), own_gain, s, i);
    }
    if (result != 0) {
        free(s->pixels);
    }
    return result;
}

/* CW-SSIM of chip i at a gain; `scratch` is a square. NaN out of memory. */
static double cw_ssim_at(const struct shown *s, int i, int kind, double gain, double *scratch)
{
    double score;
    nm_brighten(square_of(s, i, kind), s->side * s->side, gain, scratch);
    return nm_score_cw_ssim(scratch, square_of(s, i, kind - 1), s->side, &score) == 0 ? score : NAN;
}

/* The gain, a fifth to five, of the best mean CW-SSIM. */
static double fit_best(const struct shown *s, int kind, double *scratch)
{
    double best_gain = 1, most = 0;
    for (int g = 0; g < BEST_GAINS; g++) {
        const double gain = pow(5, -1 + 2.0 * g / (BEST_GAINS - 1));
        double sum = 0;
        for (int i = 0; i < s->count; i++) {
            sum += cw_ssim_at(s, i, kind, gain, scratch);
        }
        best_gain = sum > most ? gain : best_gain;
        most = fmax(sum, most);
    }
    return best_gain;
}

/* Scores of each chip. */
struct scored {
    struct nm_score learned, own;
    double learned_best, own_best, azimuth_deg;
};

struct place_in_circle {
    double azimuth_deg;
    int chip;
};

static void add(struct nm_score *sum, const struct nm_score *score, int count)
{
    sum->mse += score->mse / count;
    sum->ssim += score->ssim / count;
    sum->cw_ssim += score->cw_ssim / count;
}

static int score_chip(const struct shown *s, int i, const struct nm_summary *m, double *scratch,
                      struct scored *scored)
{
    if (nm_score(square_of(s, i, LEARNED), square_of(s, i, LEARNED_REAL), s->side,
                 &scored->learned) != 0 ||
        nm_score(square_of(s, i, OWN), square_of(s, i, OWN_REAL), s->side, &scored->own) != 0) {
        return -1;
    }
    scored->learned_best = cw_ssim_at(s, i, LEARNED, m->learned_best_gain, scratch);
    scored->own_best = cw_ssim_at(s, i, OWN, m->own_best_gain, scratch);
    return 0;
}

static int score_all(const struct shown *s, const struct nm_samples *samples, struct nm_summary *m,
                     double *scratch, struct scored *scored)
{
    struct hs_progress progress;
    int result = 0;
    hs_progress_begin(&progress, "scoring", (uint64_t)s->count);
    for (int i = 0; i < s->count && result == 0; i++) {
        scored[i] = (struct scored){.azimuth_deg = samples->items[i].azimuth_deg};
        result = score_chip(s, i, m, scratch, &scored[i]);
        add(&m->learned, &scored[i].learned, s->count);
        add(&m->own, &scored[i].own, s->count);
        m->learned_best += scored[i].learned_best / s->count;
        m->own_best += scored[i].own_best / s->count;
        hs_progress_update(&progress, (uint64_t)i + 1);
    }
    hs_progress_end(&progress);
    return result;
}

static int write_scores(const struct scored *scored, const struct nm_samples *samples,
                        const char *path)
{
    struct hs_atomic_file file;
    if (hs_atomic_open(&file, path) != 0) {
        return -1;
    }
    fputs(
        "chip\tazimuth\tmse\tssim\tcw_ssim\tbest_cw_ssim\town_mse\town_ssim\town_cw_ssim\t"
        "own_best_cw_ssim\n",
        file.stream);
    for (int i = 0; i < samples->count; i++) {
        const struct nm_score *l = &scored[i].learned, *o = &scored[i].own;
        fprintf(file.stream, "%s\t%.2f\t%.6f\t%.4f\t%.4f\t%.4f\t%.6f\t%.4f\t%.4f\t%.4f\n",
                samples->items[i].name, scored[i].azimuth_deg, l->mse, l->ssim, l->cw_ssim,
                scored[i].learned_best, o->mse, o->ssim, o->cw_ssim, scored[i].own_best);
    }
    return hs_atomic_commit(&file);
}

static int by_azimuth(const void *a, const void *b)
{
    const struct place_in_circle *p = a, *q = b;
    return (p->azimuth_deg > q->azimuth_deg) - (p->azimuth_deg < q->azimuth_deg);
}

/* Each simulated picture of `which` with the speckle of one look, at the gain that suits it best:
 * as a real chip has it. `speckled` has room for all of them. */
static int speckle_all(const struct shown *s, const int *which, int count, double gain,
                       double *speckled)
{
    struct hs_rng rng;
    const int pixels = s->side * s->side;
    int result = 0;
    hs_rng_seed(&rng, 1);
    for (int k = 0; k < count && result == 0; k++) {
        nm_brighten(square_of(s, which[k], LEARNED), pixels, gain, speckled + k * pixels);
        result = nm_speckle(speckled + k * pixels, s->side, s->aperture, 1, &rng);
    }
    return result;
}

static int draw_sheet(const struct shown *s, const struct scored *scored, const int *which,
                      int count, double gain, const char *path)
{
    enum { ROWS = 3 };
    const double *pictures[SHOWN * ROWS];
    static const char *const titles[ROWS] = {"real chip", "with speckle", "learned"};
    char text[SHOWN][16];
    const char *names[SHOWN];
    double *speckled = malloc((size_t)count * (size_t)(s->side * s->side) * sizeof *speckled);
    if (!speckled) {
        return hs_error(path, NULL, "out of memory");
    }
    int result = speckle_all(s, which, count, gain, speckled);
    for (int k = 0; k < count; k++) {
        snprintf(text[k], sizeof text[k], "%.0f deg", scored[which[k]].azimuth_deg);
        names[k] = text[k];
        pictures[k * ROWS] = square_of(s, which[k], LEARNED_REAL);
        pictures[k * ROWS + 1] = speckled + k * s->side * s->side;
        pictures[k * ROWS + 2] = square_of(s, which[k], LEARNED);
    }
    result =
        result == 0 ? nm_report_table(path, pictures, count, ROWS, s->side, titles, names) : -1;
    free(speckled);
    return result;
}

/* SHEETS sheets of up to SHOWN chips each, from all around in order of azimuth. */
static int draw_sheets(const struct shown *s, const struct scored *scored, double gain,
                       const char *folder)
{
    struct place_in_circle *order = malloc(((size_t)s->count + 1) * sizeof *order);
    const int count = s->count < SHEETS * SHOWN ? s->count : SHEETS * SHOWN;
    int which[SHEETS * SHOWN], result = order ? 0 : hs_error(folder, NULL, "out of memory");
    for (int i = 0; i < s->count && result == 0; i++) {
        order[i] = (struct place_in_circle){scored[i].azimuth_deg, i};
    }
    if (result == 0) {
        qsort(order, (size_t)s->count, sizeof *order, by_azimuth);
    }
    for (int k = 0; k < count && result == 0; k++) {
        which[k] = order[k * s->count / count].chip;
    }
    free(order);
    for (int k = 0; k < count && result == 0; k += SHOWN) {
        char name[32], path[4096];
        snprintf(name, sizeof name, "sheet-%d.png", k / SHOWN + 1);
        result = hs_output_path(path, sizeof path, folder, name) == 0
                     ? draw_sheet(s, scored, which + k, count - k < SHOWN ? count - k : SHOWN, gain,
                                  path)
                     : -1;
    }
    return result;
}

static int draw_table(const struct shown *s, const struct scored *scored, const char *path)
{
    enum { ROWS = 3 };
    const double *pictures[SHOWN * ROWS];
    static const char *const titles[ROWS] = {"real chip", "own law", "learned"};
    char text[SHOWN][16];
    const char *names[SHOWN];
    const int count = s->count < SHOWN ? s->count : SHOWN;
    for (int k = 0; k < count; k++) {
        const int i = k * s->count / count;
        snprintf(text[k], sizeof text[k], "%.0f deg", scored[i].azimuth_deg);
        names[k] = text[k];
        pictures[k * ROWS] = square_of(s, i, LEARNED_REAL);
        pictures[k * ROWS + 1] = square_of(s, i, OWN);
        pictures[k * ROWS + 2] = square_of(s, i, LEARNED);
    }
    return nm_report_table(path, pictures, count, ROWS, s->side, titles, names);
}

static int draw_curves(const struct scored *scored, int count, const char *path)
{
    double *values = malloc(3 * ((size_t)count + 1) * sizeof *values);
    if (!values) {
        return hs_error("scores", NULL, "out of memory");
    }
    double *azimuth = values, *learned = values + count, *own = values + 2 * (size_t)count;
    for (int i = 0; i < count; i++) {
        azimuth[i] = scored[i].azimuth_deg;
        learned[i] = scored[i].learned_best;
        own[i] = scored[i].own_best;
    }
    const struct nm_score_curve curves[2] = {{"learned", azimuth, learned, count},
                                             {"own law", azimuth, own, count}};
    const int result =
        nm_report_scores(path, "cw-ssim with the real chip, each at its best gain", curves, 2);
    free(values);
    return result;
}

static int report(const struct shown *s, const struct scored *scored,
                  const struct nm_samples *samples, double gain, const char *folder)
{
    char table[4096], curves[4096], scores[4096];
    if (hs_output_path(table, sizeof table, folder, "table.png") != 0 ||
        hs_output_path(curves, sizeof curves, folder, "cw-ssim.png") != 0 ||
        hs_output_path(scores, sizeof scores, folder, "scores.tsv") != 0) {
        return -1;
    }
    return draw_table(s, scored, table) == 0 && draw_curves(scored, s->count, curves) == 0 &&
                   write_scores(scored, samples, scores) == 0 &&
                   draw_sheets(s, scored, gain, folder) == 0
               ? 0
               : -1;
}

static int fit_gains(struct nm_experiment *e, double *scratch, struct nm_summary *m)
{
    struct shown s;
    const struct nm_samples training = nm_dataset_training(&e->dataset);
    m->own_gain = fit_square(e->training, &training);
    if (show_all(e->training, &training, FITTED_MAX, m->own_gain, &s) != 0) {
        return -1;
    }
    m->learned_best_gain = fit_best(&s, LEARNED, scratch);
    m->own_best_gain = fit_best(&s, OWN, scratch);
    free(s.pixels);
    return 0;
}

int nm_experiment_score(struct nm_experiment *e, const struct nm_samples *samples,
                        const char *folder, struct nm_summary *summary)
{
    struct shown s = {0};
    const int side = e->training->simulator.side_px;
    double *scratch = malloc((size_t)(side * side) * sizeof *scratch);
    struct scored *scored = calloc((size_t)samples->count + 1, sizeof *scored);
    *summary = (struct nm_summary){.count = samples->count};
    int result = scratch && scored ? 0 : hs_error("scores", NULL, "out of memory");
    if (result == 0 && samples->count == 0) {
        result = hs_error("scores", "give another --share", "has no chips to score");
    }
    result = result == 0 ? fit_gains(e, scratch, summary) : -1;
    if (result == 0) {
        const struct nm_samples training = nm_dataset_training(&e->dataset);
        result =
            nm_null_scores(e->training, &training, samples, summary->nulls, &summary->near_deg);
    }
    if (result == 0) {
        result = show_all(e->training, samples, samples->count, summary->own_gain, &s);
    }
    if (result == 0) {
        const struct setup *setup = &e->settings.setup;
        s.aperture = pix_aperture(setup->resolution_m, NM_CELLS_PER_PIXEL * setup->cell_m);
        result = score_all(&s, samples, summary, scratch, scored) == 0
                     ? report(&s, scored, samples, summary->learned_best_gain, folder)
                     : -1;
        free(s.pixels);
    }
    free(scratch);
    free(scored);
    return result;
}

static void report_score(const char *key, const struct nm_score *s, double best_gain, double best)
{
    hs_report_object(key);
    hs_report_put("mse", s->mse);
    hs_report_put("ssim", s->ssim);
    hs_report_put("cw_ssim", s->cw_ssim);
    hs_report_put("best_gain", best_gain);
    hs_report_put("best_cw_ssim", best);
    hs_report_close();
}

static void report_summary(const struct nm_summary *s, const char *what)
{
    hs_report_object("score");
    hs_report_put("what", what);
    hs_report_put("chips", s->count);
    report_score("learned", &s->learned, s->learned_best_gain, s->learned_best);
    report_score("own_law", &s->own, s->own_best_gain, s->own_best);
    hs_report_put("own_law_gain", s->own_gain);
    for (int n = 0; n < NM_NULLS; n++) {
        hs_report_object(nm_null_names[n]);
        hs_report_put("mse", s->nulls[n].mse);
        hs_report_put("ssim", s->nulls[n].ssim);
        hs_report_put("cw_ssim", s->nulls[n].cw_ssim);
        hs_report_close();
    }
    hs_report_put("nearest_chip_deg", s->near_deg);
    hs_report_close();
}

/* What needs no simulator: a score that is no better says nothing. */
static void print_nulls(const struct nm_summary *s)
{
    static const char *const titles[NM_NULLS] = {"flat picture", "mean chip", "nearest chip",
                                                 "chips smoothed"};
    for (int n = 0; n < NM_NULLS; n++) {
        printf("  null model, %-12s   mse %.6f   ssim %.4f   cw-ssim %.4f\n", titles[n],
               s->nulls[n].mse, s->nulls[n].ssim, s->nulls[n].cw_ssim);
    }
    printf(
        "  of training chips: their mean everywhere, their mean picture, the real one of the\n"
        "  nearest other azimuth, %.1f degrees away, and the mean of those about the azimuth\n",
        s->near_deg);
}

void nm_summary_print(const struct nm_summary *s, const char *what)
{
    report_summary(s, what);
    printf("%s, %d chips:\n", what, s->count);
    printf("  learned   mse %.6f   ssim %.4f   cw-ssim %.4f, at its best gain (%.2f) %.4f\n",
           s->learned.mse, s->learned.ssim, s->learned.cw_ssim, s->learned_best_gain,
           s->learned_best);
    printf("  own law   mse %.6f   ssim %.4f   cw-ssim %.4f, at its best gain (%.2f) %.4f\n",
           s->own.mse, s->own.ssim, s->own.cw_ssim, s->own_best_gain, s->own_best);
    printf("  the own law's gain of least squares on the training chips is %.3g\n", s->own_gain);
    print_nulls(s);
}
