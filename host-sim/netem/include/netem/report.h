/* Report of a training, as pictures and tables: the figures of the paper from 16 on. */
#ifndef NETEM_REPORT_H
#define NETEM_REPORT_H

#include "netem/score.h"
#include "netem/target_view.h"
#include "netem/train.h"

/* Figs. 16, 18, 19 and 23: loss by epoch, logarithmic, of one or several trainings. */
struct nm_loss_curve {
    const char *name; /* borrowed */
    const struct nm_epoch *epochs;
    int count;
};
int nm_report_losses(const char *path, const char *title, const struct nm_loss_curve *curves,
                     int count);

/* Figs. 20 and 21: the learned coefficients of `material_count` materials; beside them, where `law`
 * is not NULL, those of a law that is written down, as dots. */
int nm_report_specular(const char *path, const struct nm_model *model,
                       const struct nm_materials *materials, int material_count,
                       const struct reflect_law *law);
int nm_report_back(const char *path, const struct nm_model *model,
                   const struct nm_materials *materials, int material_count,
                   const struct reflect_law *law);

/* Fig. 22: the large kernel over 60 dB, and the small ones from the least to the largest value. */
int nm_report_kernels(const char *path, const struct nm_model *model);

/* Table V: columns of chips, each a square of `side` pixels, near row first and drawn with it at
 * the bottom. `pictures` holds `rows` pictures for each of `count` chips; `titles` names the rows.
 * White is 1 after the square root, so that clutter shows. */
int nm_report_table(const char *path, const double *const *pictures, int count, int rows, int side,
                    const char *const *titles, const char *const *names);

/* Fig. 25: a score of each chip over its azimuth, one curve a simulator. */
struct nm_score_curve {
    const char *name; /* borrowed */
    const double *azimuth_deg, *score;
    int count;
};
int nm_report_scores(const char *path, const char *title, const struct nm_score_curve *curves,
                     int count);

#endif
