/* Progress of a load, told by the loader to a panel that flies meanwhile: one line in a small file,
 * on which the loader holds a lock as long as it lives. So a loader that was killed is told from
 * one that works, and what it said last does not stay.
 *
 *     "LMLOAD runs 042 0000000000123456\n"     state, per cent, milliseconds of CLOCK_MONOTONIC
 *
 * The file belongs into memory (/run), because the panel reads it in its loop. */
#ifndef SLOTS_PROGRESS_H
#define SLOTS_PROGRESS_H

#include <stdbool.h>
#include <stdint.h>

#include "lm/controls.h"

struct slot_teller {
    int fd;          /* -1: nobody is told */
    int32_t percent; /* as told last; -1: nothing yet */
};

/* Begin with "runs 0". Without the file's folder, or where another loader has the lock, nobody is
 * told: *t is safe to use all the same. */
void slot_teller_open(struct slot_teller *t, const char *path);

/* A load that runs, at 0..100 per cent. Writes when the number is another one than before. */
void slot_teller_run(struct slot_teller *t, int32_t percent);

/* The end: LM_LOAD_DONE or LM_LOAD_FAILED. Closes the file. */
void slot_teller_end(struct slot_teller *t, enum lm_load how);

/* What a loader says: load and percent of *state, the rest stays. LM_LOAD_NONE without a file, and
 * of what ended before `since_ms`, when the panel started. LM_LOAD_FAILED of a loader that is gone
 * without having said how it ended. False, with nothing changed, if the file cannot be understood:
 * it is being written, or is none of ours. Waits for nothing in memory. */
bool slot_progress_read(const char *path, uint64_t since_ms, struct lm_slots_state *state);

#endif
