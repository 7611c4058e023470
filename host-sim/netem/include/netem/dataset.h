/* Dataset: chips and their traced aspects, ready for training. */
#ifndef NETEM_DATASET_H
#define NETEM_DATASET_H

#include "netem/chip.h"
#include "netem/chip_list.h"
#include "netem/target_view.h"
#include "netem/train.h"

#include <stdbool.h>

/* From the amplitudes of a file to the pixels that training sees. */
struct nm_calibration {
    double gain;          /* of amplitudes whose entry has none; NaN: by the clutter */
    double clutter;       /* mean amplitude that the frame about the target is brought to */
    bool is_normalised;   /* tanh was taken already (Niu, (12)): take pixels as they are */
    bool is_near_on_top;  /* else the chip's lowest row is nearest to the radar, as in MSTAR */
    bool is_counted_left; /* the collection's azimuths grow to the left, not to the right */
    double turn_deg;      /* added to them then: what the collection calls 0 */
};

/* Mean amplitude of the frame: the outer eighth of the picture on each side. */
double nm_frame_mean(const struct nm_picture *picture);

/* Reads the entry's chip: near row first, calibrated, tanh taken, aspect filled in from the entry
 * or the file. The entry's gain is filled in when it is unknown. Returns 0, or -1 with the error
 * reported and nothing to close. */
int nm_dataset_chip(struct nm_chip *chip, struct nm_chip_entry *entry,
                    const struct nm_calibration *calibration);

/* The simulator's own pictures of a traced sample by `law`: `own` and `own_amplitudes`. Returns 0,
 * or -1 out of memory, reported. */
int nm_sample_draw(struct nm_sample *sample, const struct setup *setup,
                   const struct reflect_law *law);

struct nm_dataset {
    struct nm_sample *samples; /* owned; the first `training` are for training */
    int count, training;
    struct reflect_law law; /* of the simulator's own pictures */
};

/* Reads and traces all chips of the list, whose aspects must be known. Those that the list leaves
 * open go to training with probability `share`, told by `seed`.
 * Returns 0, or -1 with the error reported and nothing to free. */
int nm_dataset_load(struct nm_dataset *d, const struct nm_chip_list *list,
                    const struct nm_target_view *view, const struct nm_calibration *calibration,
                    double share, uint64_t seed);
void nm_dataset_free(struct nm_dataset *d);

/* The samples of each part; they borrow from `d`. */
struct nm_samples nm_dataset_training(const struct nm_dataset *d);
struct nm_samples nm_dataset_validation(const struct nm_dataset *d);

#endif
