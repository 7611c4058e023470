#include "netem/null_model.h"

#include "hs/error.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

const char *const nm_null_names[NM_NULLS] = {"flat", "mean_chip", "nearest_chip", "smoothed_chips"};

void nm_brighten(const double *pixels, int count, double gain, double *brighter)
{
    for (int i = 0; i < count; i++) {
        brighter[i] = tanh(gain * atanh(fmin(pixels[i], 1 - 1e-12)));
    }
}

static double apart_deg(double a, double b)
{
    return fabs(remainder(a - b, 360));
}

const struct nm_sample *nm_nearest(const struct nm_samples *samples, double azimuth_deg,
                                   bool is_another)
{
    const struct nm_sample *nearest = NULL;
    double least_deg = INFINITY;
    for (int i = 0; i < samples->count; i++) {
        const double deg = apart_deg(samples->items[i].azimuth_deg, azimuth_deg);
        if (deg < least_deg && !(is_another && deg < 1e-9)) {
            nearest = &samples->items[i];
            least_deg = deg;
        }
    }
    return nearest;
}

static struct nm_origin place(struct nm_training *t, const double *picture,
                              const struct nm_sample *sample)
{
    return t->plan.reach_px > 0 ? nm_register(&t->registrar, picture, &sample->real, sample->origin,
                                              t->plan.reach_px, NULL)
                                : sample->origin;
}

static void take_mean(const struct nm_samples *training, int side, double *mean, double *scratch)
{
    memset(mean, 0, (size_t)(side * side) * sizeof *mean);
    for (int i = 0; i < training->count; i++) {
        const struct nm_sample *s = &training->items[i];
        nm_picture_cut(&s->real, s->origin, side, scratch);
        for (int k = 0; k < side * side; k++) {
            mean[k] += scratch[k] / training->count;
        }
    }
}

static void take_flat(const double *mean, int count, double *flat)
{
    double sum = 0;
    for (int k = 0; k < count; k++) {
        sum += mean[k];
    }
    for (int k = 0; k < count; k++) {
        flat[k] = sum / count;
    }
}

/* The mean of the training chips about an azimuth, without the chip itself. */
static void take_smoothed(const struct nm_samples *training, const struct nm_sample *chip, int side,
                          double *smoothed, double *scratch)
{
    static const double width_deg = 8;
    double weights = 0;
    memset(smoothed, 0, (size_t)(side * side) * sizeof *smoothed);
    for (int i = 0; i < training->count; i++) {
        const struct nm_sample *s = &training->items[i];
        const double off = apart_deg(s->azimuth_deg, chip->azimuth_deg) / width_deg;
        /* Were all of them far away, the nearest would count. */
        const double weight = s == chip ? 0 : exp(-off * off / 2) + 1e-300;
        nm_picture_cut(&s->real, s->origin, side, scratch);
        weights += weight;
        for (int k = 0; k < side * side; k++) {
            smoothed[k] += weight * scratch[k];
        }
    }
    for (int k = 0; k < side * side; k++) {
        smoothed[k] /= weights > 0 ? weights : 1;
    }
}

static void add(struct nm_score *sum, const struct nm_score *score, int count)
{
    sum->mse += score->mse / count;
    sum->ssim += score->ssim / count;
    sum->cw_ssim += score->cw_ssim / count;
}

/* One chip beside the pictures. */
static int score_chip(struct nm_training *t, const struct nm_sample *chip, double *pictures,
                      double *cut, int count, struct nm_score scores[NM_NULLS])
{
    const int side = t->simulator.side_px;
    for (int n = 0; n < NM_NULLS; n++) {
        struct nm_score score;
        const double *picture = pictures + n * side * side;
        /* A flat picture fits everywhere alike. */
        const struct nm_origin at = n == NM_NULL_FLAT ? chip->origin : place(t, picture, chip);
        nm_picture_cut(&chip->real, at, side, cut);
        if (nm_score(picture, cut, side, &score) != 0) {
            return -1;
        }
        add(&scores[n], &score, count);
    }
    return 0;
}

static int score_all(struct nm_training *t, const struct nm_samples *training,
                     const struct nm_samples *chips, double *pictures,
                     struct nm_score scores[NM_NULLS], double *near_deg)
{
    const int side = t->simulator.side_px, pixels = side * side;
    double *cut = pictures + NM_NULLS * pixels, sum_deg = 0;
    int result = 0;
    take_mean(training, side, pictures + NM_NULL_MEAN * pixels, cut);
    take_flat(pictures + NM_NULL_MEAN * pixels, pixels, pictures + NM_NULL_FLAT * pixels);
    for (int i = 0; i < chips->count && result == 0; i++) {
        const struct nm_sample *chip = &chips->items[i];
        const struct nm_sample *near = nm_nearest(training, chip->azimuth_deg, true);
        near = near ? near : &training->items[0];
        sum_deg += apart_deg(near->azimuth_deg, chip->azimuth_deg);
        nm_picture_cut(&near->real, near->origin, side, pictures + NM_NULL_NEAREST * pixels);
        take_smoothed(training, chip, side, pictures + NM_NULL_SMOOTHED * pixels, cut);
        result = score_chip(t, chip, pictures, cut, chips->count, scores);
    }
    if (near_deg) {
        *near_deg = sum_deg / chips->count;
    }
    return result;
}

int nm_null_scores(struct nm_training *t, const struct nm_samples *training,
                   const struct nm_samples *chips, struct nm_score scores[NM_NULLS],
                   double *near_deg)
{
    const size_t pixels = (size_t)t->simulator.side_px * (size_t)t->simulator.side_px;
    const double start = training->count > 0 ? 0 : NAN;
    for (int n = 0; n < NM_NULLS; n++) {
        scores[n] = (struct nm_score){start, start, start};
    }
    if (training->count == 0) {
        return 0;
    }
    double *pictures = malloc((NM_NULLS + 1) * pixels * sizeof *pictures);
    if (!pictures) {
        return hs_error("scores", NULL, "out of memory");
    }
    const int result = score_all(t, training, chips, pictures, scores, near_deg);
    free(pictures);
    return result;
}

int nm_fit_picture(struct nm_training *t, const double *picture, const struct nm_sample *sample,
                   double best_gain, struct nm_fit *fit)
{
    const int side = t->simulator.side_px, pixels = side * side;
    double *cut = malloc(2 * (size_t)pixels * sizeof *cut);
    if (!cut) {
        return hs_error("scores", NULL, "out of memory");
    }
    nm_picture_cut(&sample->real, place(t, picture, sample), side, cut);
    nm_brighten(picture, pixels, best_gain, cut + pixels);
    fit->mse = nm_score_mse(picture, cut, side);
    const int result = nm_score_cw_ssim(picture, cut, side, &fit->cw_ssim) == 0
                           ? nm_score_cw_ssim(cut + pixels, cut, side, &fit->best_cw_ssim)
                           : -1;
    free(cut);
    return result;
}

int nm_fit_chip(struct nm_training *t, const struct nm_sample *aspect,
                const struct nm_sample *sample, double best_gain, struct nm_fit *fit)
{
    return nm_simulate(&t->simulator, &t->model, &aspect->paths) == 0
               ? nm_fit_picture(t, t->simulator.pixels, sample, best_gain, fit)
               : -1;
}
