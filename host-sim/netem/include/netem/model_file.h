/* Model file: a training, with everything that is needed to resume it exactly or to simulate with
 * what it learned. Text; docs/netem.md describes it. */
#ifndef NETEM_MODEL_FILE_H
#define NETEM_MODEL_FILE_H

#include "netem/train.h"

/* Appears whole or not at all, numbers to the last bit. Returns 0, or -1 with the error reported.
 */
int nm_model_write(const struct nm_training *t, const char *path);

/* Opens `t` (nm_training_open) for pictures of cells x cells and brings it to the state that was
 * written. Nothing in the file is believed unchecked. Returns 0, or -1 with the error reported and
 * nothing to close. */
int nm_model_read(struct nm_training *t, const char *path, int cells);

#endif
