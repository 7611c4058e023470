/* Settings of the sub-commands of landmass-netem, in groups: model and tracing (tracer/setup.h),
 * chips, training. */
#ifndef NETEM_SETTINGS_H
#define NETEM_SETTINGS_H

#include "netem/dataset.h"

struct nm_settings {
    struct setup setup;
    double kernel_gain; /* 0: by nm_kernel_gain */
    /* chips */
    const char *chips;
    struct nm_calibration calibration;
    double gain; /* 0: by the clutter */
    double share;
    /* training */
    const char *architecture, *connection, *loss, *method;
    double rate, pix_rate, momentum, average;
    long batch, pretrain, epochs, pix_epochs, reach_px, seed;
};

enum {
    NM_VIEW_OPTIONS = SETUP_MODEL_OPTIONS + 6,
    NM_LAW_OPTIONS = 4,
    NM_TARGET_OPTIONS = NM_VIEW_OPTIONS + NM_LAW_OPTIONS + 1,
};
enum { NM_CHIP_OPTIONS = 8, NM_TRAIN_OPTIONS = 14 };

/* The defaults that --help names. */
struct nm_settings nm_settings_default(void);

/* Fill in the options of each group; `o` has room for as many as the enum says. */
void nm_view_options(struct nm_settings *s,
                     struct hs_option *o); /* the model and how it is traced */
void nm_law_options(struct nm_settings *s, struct hs_option *o); /* the simulator's own law */
void nm_target_options(struct nm_settings *s,
                       struct hs_option *o); /* both, and the kernel's gain */
void nm_chip_options(struct nm_settings *s, struct hs_option *o);
void nm_train_options(struct nm_settings *s, struct hs_option *o);

/* After reading the command line: what the words among the settings mean. Return 0, or -1 with the
 * error reported. */
int nm_settings_plan(const struct nm_settings *s, struct nm_plan *plan,
                     const struct nm_architecture **architecture);
enum nm_connection nm_settings_connection(const struct nm_settings *s);
struct nm_calibration nm_settings_calibration(const struct nm_settings *s);

/* The fixed kernel of these settings, NM_LARGE wide. */
void nm_settings_kernel(const struct nm_settings *s, double *kernel);

/* The least depression of the list and the settings. */
double nm_settings_lowest(const struct nm_settings *s, const struct nm_chip_list *list);

#endif
