/* What the panel tells its unit of the slots, for the BIT page: how they were found at the start,
 * and how far a load is. It comes as a control, and so is in the recording like a key. */
#ifndef PANEL_SLOTS_TOLD_H
#define PANEL_SLOTS_TOLD_H

#include "slots/progress.h"
#include "storage.h"

struct slots_told {
    const char *progress; /* path, borrowed; empty: none */
    uint64_t since_ms;    /* when the panel started: CLOCK_MONOTONIC */
    uint64_t look_us;     /* time of the next look */
    struct lm_slots_state now, told;
};

/* After storage_open. */
void slots_told_open(struct slots_told *t, const struct storage *storage, const char *progress);

/* Once in half a second: read how far a load is. */
void slots_told_service(struct slots_told *t, uint64_t now_us);

/* True with a control if there is something new. */
bool slots_told_next(struct slots_told *t, struct lm_control *control);

#endif
