#include "slots_told.h"

#include <string.h>
#include <time.h>

enum { LOOK_US = 500000 };

void slots_told_open(struct slots_told *t, const struct storage *storage, const char *progress)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    *t = (struct slots_told){.progress = progress,
                             .since_ms =
                                 (uint64_t)now.tv_sec * 1000u + (uint64_t)now.tv_nsec / 1000000u,
                             .now = storage_state(storage)};
}

void slots_told_service(struct slots_told *t, uint64_t now_us)
{
    if (now_us >= t->look_us) {
        t->look_us = now_us + LOOK_US;
        (void)slot_progress_read(t->progress, t->since_ms, &t->now);
    }
}

bool slots_told_next(struct slots_told *t, struct lm_control *control)
{
    if (memcmp(&t->now, &t->told, sizeof t->now) == 0) {
        return false;
    }
    t->told = t->now;
    *control = (struct lm_control){.kind = LM_CONTROL_SLOTS, .slots = t->now};
    return true;
}
