/* Watchdog rule: when a board may feed its watchdog.
 *
 * A board counts what has happened (struct lm_liveness) and feeds only when every count has grown
 * since it fed last (lm_liveness_judge says LM_ALIVE). One part that stands still starves the dog,
 * however busy the others are. Counts may wrap. A board that does better than starve (it restarts
 * at once and keeps the cause) acts on the other answers. */
#ifndef LM_LIVENESS_H
#define LM_LIVENESS_H

#include <stdint.h>

struct lm_liveness {
    uint32_t steps;  /* calls of lm_unit_step that have ended */
    uint32_t frames; /* pictures that the unit drew: count.frames of struct lm_unit */
    uint32_t bus;    /* times that the bus was asked for frames and had no more */
    uint32_t shown;  /* pictures that reached the glass, or found none connected; `frames` where the
                        board cannot tell */
};

enum lm_life { LM_ALIVE, LM_LIFE_NO_STEP, LM_LIFE_NO_FRAME, LM_LIFE_NO_BUS, LM_LIFE_NOT_SHOWN };

/* What has stood still between two looks; the first in the order of enum lm_life. Pure. */
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
