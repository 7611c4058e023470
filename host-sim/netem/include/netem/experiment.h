/* Experiment: a whole training, from chips and their aspects to a folder of results. */
#ifndef NETEM_EXPERIMENT_H
#define NETEM_EXPERIMENT_H

#include "netem/null_model.h"
#include "netem/score.h"
#include "netem/settings.h"
#include "netem/train.h"

struct nm_experiment {
    struct nm_settings settings;
    struct nm_target_view view; /* owned */
    struct nm_materials
        materials;                /* of the model, with surfaces if the networks are told of them */
    struct nm_dataset dataset;    /* owned */
    struct nm_training *training; /* owned */
};

/* The target on its ground, without chips. `e` is zeroed by the call. Returns 0, or -1 with the
 * error reported and nothing to close. */
int nm_experiment_open(struct nm_experiment *e, const struct nm_settings *settings,
                       double lowest_depression_deg);
void nm_experiment_close(struct nm_experiment *e);

/* Read and trace the chips of the list. Returns 0, or -1 reported. */
int nm_experiment_load(struct nm_experiment *e, const struct nm_chip_list *list);

/* Train from the beginning, or from FOLDER/training.netem when `is_resumed`; that file is written
 * after each epoch, a line printed and an item put into the report's array "epochs". A finished or
 * begun training is never overwritten. Returns 0, or -1 reported. */
int nm_experiment_train(struct nm_experiment *e, const char *folder, bool is_resumed);

/* Take a training that exists. Returns 0, or -1 reported. */
int nm_experiment_take(struct nm_experiment *e, const char *path);

/* loss.png, specular.png, back.png and kernels.png; the learned laws beside `truth` unless NULL. */
int nm_experiment_plot(const struct nm_training *t, const char *folder, int material_count,
                       const struct reflect_law *truth);

/* Means over some chips. A network that is trained for the least square error shows the mean of
 * what it cannot foretell, which is paler than any chip; CW-SSIM minds. So each simulator is also
 * scored with all its amplitudes brought, by one gain, to where its CW-SSIM on the training chips
 * is best. */
struct nm_summary {
    struct nm_score learned, own;  /* networks as trained; own law at the gain of least squares */
    double own_gain;               /* of the amplitudes that landmass-target render writes */
    double learned_best, own_best; /* CW-SSIM at each one's best gain */
    double learned_best_gain, own_best_gain; /* those gains, over the two above */
    struct nm_score nulls[NM_NULLS];         /* as trained: they need no gain */
    double near_deg;                         /* how far the nearest other chips are away */
    int count;
};

/* Score the chips `samples` by the learned simulator and by its own law, both registered:
 * scores.tsv, cw-ssim.png (at the best gains), table.png and sheet-1.png to sheet-3.png in the
 * folder: simulated chips beside real ones, in order of azimuth. All gains are fitted on the
 * training chips. Returns 0, or -1 reported. */
int nm_experiment_score(struct nm_experiment *e, const struct nm_samples *samples,
                        const char *folder, struct nm_summary *summary);

/* How the learned simulator fits chips of other vehicles. */
struct nm_vehicle {
    const char *name; /* borrowed */
    int count;
    struct nm_fit fit; /* mean */
};

/* Whether a picture of a chip's aspect fits that chip better than any other vehicle's chip: the
 * learned picture at the best gain, and as a null model the training chip of the nearest other
 * azimuth. */
struct nm_first {
    bool by_cw_ssim, by_mse, null_by_cw_ssim, null_by_mse;
};

/* Score another vehicle's chips, whose aspects are known (`register` finds those that this model
 * fits best), at the best gain of `summary`. Each of `chips` stays first in `firsts` as long as its
 * picture fits it better than the other vehicle's chip of the nearest azimuth. Returns 0, or -1
 * reported. */
int nm_experiment_beside(struct nm_experiment *e, const struct nm_samples *chips,
                         const struct nm_chip_list *others, const struct nm_summary *summary,
                         struct nm_vehicle *vehicle, struct nm_first *firsts);

/* Print the summary, and report it as the object "score" (hs/report.h). */
void nm_summary_print(const struct nm_summary *summary, const char *what);

#endif
