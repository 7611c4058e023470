#include "netem/experiment.h"

#include "hs/error.h"

#include <stdlib.h>

/* Mean fit of the other vehicle's chips, each from its own azimuth. */
static int fit_all(struct nm_training *t, const struct nm_samples *theirs, double gain,
                   struct nm_fit *mean)
{
    for (int i = 0; i < theirs->count; i++) {
        struct nm_fit fit;
        const struct nm_sample *s = &theirs->items[i];
        if (nm_fit_chip(t, s, s, gain, &fit) != 0) {
            return -1;
        }
        mean->mse += fit.mse / theirs->count;
        mean->cw_ssim += fit.cw_ssim / theirs->count;
        mean->best_cw_ssim += fit.best_cw_ssim / theirs->count;
    }
    return 0;
}

/* Does a picture of the aspect of `own` fit that chip better than `other`'s? */
static int compare_picture(struct nm_training *t, const double *picture,
                           const struct nm_sample *own, const struct nm_sample *other, double gain,
                           bool *by_cw_ssim, bool *by_mse)
{
    struct nm_fit ours, theirs;
    if (nm_fit_picture(t, picture, own, gain, &ours) != 0 ||
        nm_fit_picture(t, picture, other, gain, &theirs) != 0) {
        return -1;
    }
    *by_cw_ssim = *by_cw_ssim && ours.best_cw_ssim > theirs.best_cw_ssim;
    *by_mse = *by_mse && ours.mse < theirs.mse;
    return 0;
}

static int compare_chip(struct nm_training *t, const struct nm_samples *training,
                        const struct nm_sample *own, const struct nm_sample *other, double gain,
                        double *cut, struct nm_first *first)
{
    const struct nm_sample *near = nm_nearest(training, own->azimuth_deg, true);
    if (nm_simulate(&t->simulator, &t->model, &own->paths) != 0 ||
        compare_picture(t, t->simulator.pixels, own, other, gain, &first->by_cw_ssim,
                        &first->by_mse) != 0) {
        return -1;
    }
    if (!near) {
        first->null_by_cw_ssim = first->null_by_mse = false;
        return 0;
    }
    nm_picture_cut(&near->real, near->origin, t->simulator.side_px, cut);
    return compare_picture(t, cut, own, other, 1, &first->null_by_cw_ssim, &first->null_by_mse);
}

static int compare(struct nm_training *t, const struct nm_samples *training,
                   const struct nm_samples *ours, const struct nm_samples *theirs, double gain,
                   struct nm_first *firsts)
{
    const size_t side = (size_t)t->simulator.side_px;
    double *cut = malloc(side * side * sizeof *cut);
    int result = cut ? 0 : hs_error("scores", NULL, "out of memory");
    for (int i = 0; i < ours->count && result == 0; i++) {
        const struct nm_sample *other = nm_nearest(theirs, ours->items[i].azimuth_deg, false);
        if (other) {
            result = compare_chip(t, training, &ours->items[i], other, gain, cut, &firsts[i]);
        }
    }
    free(cut);
    return result;
}

int nm_experiment_beside(struct nm_experiment *e, const struct nm_samples *chips,
                         const struct nm_chip_list *others, const struct nm_summary *summary,
                         struct nm_vehicle *vehicle, struct nm_first *firsts)
{
    struct nm_dataset d;
    const struct nm_calibration calibration = nm_settings_calibration(&e->settings);
    const struct nm_samples training = nm_dataset_training(&e->dataset);
    const double gain = summary->learned_best_gain;
    if (nm_dataset_load(&d, others, &e->view, &calibration, 0, 1) != 0) {
        return -1;
    }
    const struct nm_samples theirs = {d.samples, d.count};
    vehicle->count = d.count;
    vehicle->fit = (struct nm_fit){0, 0, 0};
    const int result = fit_all(e->training, &theirs, gain, &vehicle->fit) == 0
                           ? compare(e->training, &training, chips, &theirs, gain, firsts)
                           : -1;
    nm_dataset_free(&d);
    return result;
}
