#include "supervisor.h"

struct lm_liveness zcu102_life_of(const struct lm_unit *unit, uint32_t steps,
                                  const struct drv_can *can, const struct lm_liveness *last)
{
    const bool is_bus_idle = can->head == can->tail;
    return (struct lm_liveness){.steps = steps,
                                .frames = unit->count.frames,
                                .bus = is_bus_idle ? last->bus + 1 : can->tail,
                                .shown = unit->count.frames};
}

enum zcu102_cause zcu102_supervise(struct zcu102_supervisor *s, uint64_t now_us,
                                   const struct lm_liveness *now)
{
    static const enum zcu102_cause causes[] = {[LM_ALIVE] = ZCU102_POWER_ON,
                                               [LM_LIFE_NO_STEP] = ZCU102_NO_STEP,
                                               [LM_LIFE_NO_FRAME] = ZCU102_NO_FRAME,
                                               [LM_LIFE_NO_BUS] = ZCU102_NO_BUS,
                                               [LM_LIFE_NOT_SHOWN] = ZCU102_NO_FRAME};
    if (now_us < s->next_us) {
        return ZCU102_POWER_ON;
    }
    const enum lm_life life = lm_liveness_judge(&s->last, now);
    s->last = *now;
    s->next_us = now_us + ZCU102_SUPERVISION_US;
    if (life == LM_ALIVE) {
        drv_watchdog_feed(s->watchdog);
    }
    return causes[life];
}
