#include "lm/exercise.h"

#include "fx/sat.h"
#include "lm/units.h"

void lm_exercise_init(struct lm_exercise *x, uint32_t seed)
{
    *x = (struct lm_exercise){.rate_q8 = LM_EXERCISE_RATE_ONE, .seed = seed};
}

/* The told clock. Times are below 2^51 us (71 years) and the rate is at most 2^12. A frame ahead of
 * the unit's clock counts as now. */
static uint64_t clock_at(const struct lm_exercise *x, uint64_t now_us)
{
    const uint64_t since_us = now_us > x->anchor_us ? now_us - x->anchor_us : 0;
    return x->told_us + (since_us * x->rate_q8 >> 8);
}

uint64_t lm_exercise_clock(const struct lm_exercise *x, uint64_t now_us)
{
    return x->is_told ? clock_at(x, now_us) : now_us;
}

static bool is_silent(const struct lm_exercise *x, uint64_t now_us)
{
    return now_us > x->heard_us && now_us - x->heard_us > x->stale_us;
}

static void take_time(struct lm_exercise *x, const struct lm_bus_event *event)
{
    const uint64_t told_us = (uint64_t)fx_max_i32(event->value, 0) * 1000;
    const uint64_t was_us = clock_at(x, event->time_us);
    const uint64_t apart_us = told_us > was_us ? told_us - was_us : was_us - told_us;
    x->count.steps += x->is_told && apart_us > LM_EXERCISE_STEP_US;
    x->told_us = told_us;
    x->anchor_us = x->heard_us = event->time_us;
    x->stale_us = (uint32_t)lm_us_of_ms(event->stale_ms);
    x->node = event->node;
    x->is_told = true;
}

static void take_rate(struct lm_exercise *x, const struct lm_bus_event *event)
{
    if (fx_is_within_i32(event->value, 0, LM_EXERCISE_RATE_MAX)) {
        x->told_us = clock_at(x, event->time_us);
        x->anchor_us = event->time_us;
        x->rate_q8 = (uint32_t)event->value;
    }
}

void lm_exercise_take(struct lm_exercise *x, const struct lm_bus_event *event)
{
    if (event->field < LM_BUS_EXERCISE_TIME || event->field > LM_BUS_EXERCISE_SEED ||
        event->channel != 0) {
        return;
    }
    if (x->is_told && event->node != x->node && !is_silent(x, event->time_us)) {
        x->count.rivals++;
    } else if (event->field == LM_BUS_EXERCISE_TIME) {
        take_time(x, event);
    } else if (event->field == LM_BUS_EXERCISE_RATE) {
        take_rate(x, event);
    } else {
        x->seed = (uint32_t)event->value;
    }
}

void lm_exercise_at(struct lm_exercise *x, uint64_t now_us)
{
    const uint64_t next_us = lm_exercise_clock(x, now_us);
    const bool is_jitter = x->is_told && x->rate_q8 != 0 && next_us < x->time_us &&
                           x->time_us - next_us < LM_EXERCISE_STEP_US;
    x->is_stale = x->is_told && is_silent(x, now_us);
    x->time_us = is_jitter ? x->time_us : next_us;
}
