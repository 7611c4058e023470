#include "netem/experiment.h"

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

static int compare(struct nm_training *t, const struct nm_samples *ours,
                   const struct nm_samples *theirs, double gain, bool *is_first,
                   bool *is_first_by_mse)
{
    for (int i = 0; i < ours->count; i++) {
        struct nm_fit own, other;
        const struct nm_sample *s = &ours->items[i];
        const struct nm_sample *near = nm_nearest(theirs, s->azimuth_deg, false);
        if (near &&
            (nm_fit_chip(t, s, s, gain, &own) != 0 || nm_fit_chip(t, s, near, gain, &other) != 0)) {
            return -1;
        }
        is_first[i] = is_first[i] && (!near || own.best_cw_ssim > other.best_cw_ssim);
        is_first_by_mse[i] = is_first_by_mse[i] && (!near || own.mse < other.mse);
    }
    return 0;
}

int nm_experiment_beside(struct nm_experiment *e, const struct nm_samples *chips,
                         const struct nm_chip_list *others, const struct nm_summary *summary,
                         struct nm_vehicle *vehicle, bool *is_first, bool *is_first_by_mse)
{
    struct nm_dataset d;
    const struct nm_calibration calibration = nm_settings_calibration(&e->settings);
    const double gain = summary->learned_best_gain;
    if (nm_dataset_load(&d, others, &e->view, &calibration, 0, 1) != 0) {
        return -1;
    }
    const struct nm_samples theirs = {d.samples, d.count};
    vehicle->count = d.count;
    vehicle->fit = (struct nm_fit){0, 0, 0};
    const int result = fit_all(e->training, &theirs, gain, &vehicle->fit) == 0
                           ? compare(e->training, chips, &theirs, gain, is_first, is_first_by_mse)
                           : -1;
    nm_dataset_free(&d);
    return result;
}
