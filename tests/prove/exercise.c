/* Exercise clock (lm/exercise.h).
 *
 * Invariant: the rate is 0..LM_EXERCISE_RATE_MAX.
 *
 * Proved, for any state that keeps it, any event and any time: it is kept; no shift is too wide.
 * Once a clock was told and runs, the exercise's time never goes back by less than
 * LM_EXERCISE_STEP_US. An event of another field or channel changes nothing.
 *
 * Assumed: nothing. Times beyond 2^51 us would wrap, which harms no memory. */
#include "firmware/nav/exercise.c"

#include "prove.h"

struct lm_exercise nondet_exercise(void);
struct lm_bus_event nondet_event(void);

void prove_take(void)
{
    struct lm_exercise x = nondet_exercise();
    const struct lm_bus_event event = nondet_event();
    ASSUME(x.rate_q8 <= LM_EXERCISE_RATE_MAX);
    const struct lm_exercise before = x;
    lm_exercise_take(&x, &event);
    PROVE(x.rate_q8 <= LM_EXERCISE_RATE_MAX);
    const bool is_other = event.field < LM_BUS_EXERCISE_TIME ||
                          event.field > LM_BUS_EXERCISE_SEED || event.channel != 0;
    PROVE(!is_other ||
          (x.told_us == before.told_us && x.rate_q8 == before.rate_q8 && x.seed == before.seed &&
           x.anchor_us == before.anchor_us && x.node == before.node));
    PROVE(x.time_us == before.time_us);
}

void prove_at(void)
{
    struct lm_exercise x = nondet_exercise();
    const uint64_t before_us = x.time_us;
    ASSUME(x.rate_q8 <= LM_EXERCISE_RATE_MAX);
    lm_exercise_at(&x, nondet_u64());
    PROVE(!x.is_told || x.rate_q8 == 0 || x.time_us >= before_us ||
          before_us - x.time_us >= LM_EXERCISE_STEP_US);
    PROVE(x.is_told || !x.is_stale);
}
