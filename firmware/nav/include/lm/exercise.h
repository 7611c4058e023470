/* Exercise clock: the time by which everything moves that moves by itself. Displays that hear the
 * same clock draw the same (docs/bus.md, "Exercise clock").
 *
 * Without a clock on the bus it is the time since the start, and `seed` that of the board. */
#ifndef LM_EXERCISE_H
#define LM_EXERCISE_H

#include <stdbool.h>
#include <stdint.h>

#include "lm/bus_event.h"

enum {
    LM_EXERCISE_RATE_ONE = 256,   /* a second of the exercise in a second */
    LM_EXERCISE_STEP_US = 250000, /* a larger difference is a step; a smaller one, jitter */
    LM_EXERCISE_RATE_MAX = 16 * 256
};

/* State; the caller owns it. Counters only ever grow. */
struct lm_exercise {
    uint64_t time_us; /* of the exercise, as of the last lm_exercise_at */
    uint32_t rate_q8; /* 0: the exercise stands; up to LM_EXERCISE_RATE_MAX */
    uint32_t seed;    /* chooses the draws of speckle and noise */
    bool is_told;     /* a clock was heard on the bus; it then runs on even if it falls silent */
    bool is_stale;    /* it has fallen silent */
    uint8_t node;     /* its sender */

    uint64_t told_us, anchor_us; /* the exercise's time at anchor_us of the unit's clock */
    uint64_t heard_us;           /* arrival of the last time */
    uint32_t stale_us;
    struct {
        uint32_t steps;  /* times that differed by more than LM_EXERCISE_STEP_US */
        uint32_t rivals; /* values of a second node while the first one is received */
    } count;
};

/* Begin without a clock, with the board's seed. */
void lm_exercise_init(struct lm_exercise *x, uint32_t seed);

/* Take an event of the bus. Events of other fields change nothing, nor do rates out of range, which
 * a user's own table allows. */
void lm_exercise_take(struct lm_exercise *x, const struct lm_bus_event *event);

/* The exercise's time at a time of the unit's clock, by what was told until now. */
uint64_t lm_exercise_clock(const struct lm_exercise *x, uint64_t now_us);

/* Update time_us and is_stale as of `now_us`. What was told last counts: the clock runs on from it
 * at the told rate. It never runs back by less than LM_EXERCISE_STEP_US while it runs, but stands
 * until the told time has come. Call in every step. */
void lm_exercise_at(struct lm_exercise *x, uint64_t now_us);

#endif
