#include "supervisor.h"

struct zcu102_beats zcu102_beats_of(const struct lm_unit *unit, uint32_t steps,
                                    const struct drv_can *can, const struct zcu102_beats *last)
{
    const bool is_bus_idle = can->head == can->tail;
    return (struct zcu102_beats){.steps = steps,
                                 .frames = unit->count.frames,
                                 .bus = is_bus_idle ? last->bus + 1 : can->tail};
}

enum zcu102_cause zcu102_supervise(struct zcu102_supervisor *s, uint64_t now_us,
                                   const struct zcu102_beats *now)
{
    if (now_us < s->next_us) {
        return ZCU102_POWER_ON;
    }
    const struct zcu102_beats last = s->last;
    s->last = *now;
    s->next_us = now_us + ZCU102_SUPERVISION_US;
    if (now->steps == last.steps) {
        return ZCU102_NO_STEP;
    }
    if (now->frames == last.frames) {
        return ZCU102_NO_FRAME;
    }
    if (now->bus == last.bus) {
        return ZCU102_NO_BUS;
    }
    drv_watchdog_feed(s->watchdog);
    return ZCU102_POWER_ON;
}
