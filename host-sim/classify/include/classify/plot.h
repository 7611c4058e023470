/* Plot of a training: its error curve as a PNG. */
#ifndef CLASSIFY_PLOT_H
#define CLASSIFY_PLOT_H

#include "classify/mlp_train.h"

/* RMS error, recognition and, where there is one, validation by epoch, on one axis from 0 to 1;
 * grey uprights mark the cures of local minima. Returns 0, or -1 reported. */
int db_plot_training(const char *path, const struct db_train_report *report);

#endif
