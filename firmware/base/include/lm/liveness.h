/* Watchdog rule: when a board may feed its watchdog.
 *
 * A board counts events of each part (struct lm_liveness). It feeds only if every count has changed
 * since it fed last, which is LM_ALIVE. One part that stands still lets the watchdog expire,
 * however busy the others are. The board owns both structs; counts may wrap.
 *
 *     if (lm_liveness_judge(&last, &now) == LM_ALIVE) {
 *         feed_watchdog();
 *         last = now;
 *     }
 *
 * The other results name the first part that stood still. A board that restarts at once and records
 * the cause acts on them. */
#ifndef LM_LIVENESS_H
#define LM_LIVENESS_H

#include <stdint.h>

struct lm_liveness {
    uint32_t steps;  /* calls of lm_unit_step that have returned */
    uint32_t frames; /* pictures that the unit drew: count.frames of struct lm_unit */
    uint32_t bus;    /* times that the bus was read until it had no more frames */
    uint32_t shown;  /* pictures that reached the glass, or found no display connected. A board that
                        cannot tell sets it to `frames`. */
};

/* Result of the rule: LM_ALIVE, or the count that has not changed. */
enum lm_life {
    LM_ALIVE,
    LM_LIFE_NO_STEP,  /* steps */
    LM_LIFE_NO_FRAME, /* frames */
    LM_LIFE_NO_BUS,   /* bus */
    LM_LIFE_NOT_SHOWN /* shown */
};

/* Compare two readings of the counts. If several have not changed, the result is the first in the
 * order of enum lm_life. Changes nothing. */
static inline enum lm_life lm_liveness_judge(const struct lm_liveness *last,
                                             const struct lm_liveness *now)
{
    return now->steps == last->steps     ? LM_LIFE_NO_STEP
           : now->frames == last->frames ? LM_LIFE_NO_FRAME
           : now->bus == last->bus       ? LM_LIFE_NO_BUS
           : now->shown == last->shown   ? LM_LIFE_NOT_SHOWN
                                         : LM_ALIVE;
}

#endif
