#include "lm/malfunction_bus.h"

#include "fx/sat.h"
#include "lm/units.h"

enum { ALL = 255 };

/* Least and greatest amount of a kind, in its unit. */
static const int16_t limit[LM_MALFUNCTIONS][2] = {
    [LM_MALFUNCTION_NO_TRANSMIT] = {-180, 180}, [LM_MALFUNCTION_WEAK_TRANSMIT] = {0, 60},
    [LM_MALFUNCTION_NOISE] = {0, 60},           [LM_MALFUNCTION_STUCK] = {-180, 180},
    [LM_MALFUNCTION_DRIFT] = {-180, 180},       [LM_MALFUNCTION_LOST_FROM] = {-180, 180},
    [LM_MALFUNCTION_LOST_TO] = {-180, 180},     [LM_MALFUNCTION_FROZEN] = {-180, 180},
    [LM_MALFUNCTION_TILT] = {-30, 30},          [LM_MALFUNCTION_KEY] = {1, 28},
};

/* Time since then; a frame ahead of the clock counts as now. */
static uint64_t age_us(uint64_t then_us, uint64_t now_us)
{
    return now_us > then_us ? now_us - then_us : 0;
}

static void set_one(struct lm_malfunction_bus *b, const struct lm_bus_event *event)
{
    const uint32_t kind = event->service;
    if (kind >= LM_MALFUNCTIONS ||
        !fx_is_within_i32(event->value, limit[kind][0] * 256, limit[kind][1] * 256)) {
        b->count.refused++;
        return;
    }
    b->now.set |= 1u << kind;
    b->now.amount_q8[kind] = event->value;
    b->heard_us[kind] = event->time_us;
    b->stale_us = (uint32_t)lm_us_of_ms(event->stale_ms);
    b->dead_us = (uint32_t)lm_us_of_ms(event->dead_ms);
}

static void clear(struct lm_malfunction_bus *b, int32_t which)
{
    if (which == ALL) {
        b->now.set = 0;
    } else if (fx_is_within_i32(which, 0, LM_MALFUNCTIONS - 1)) {
        b->now.set &= ~(1u << which);
    } else {
        b->count.refused++;
    }
}

void lm_malfunction_bus_take(struct lm_malfunction_bus *b, const struct lm_bus_event *event)
{
    const bool is_clear = event->field == LM_BUS_MALFUNCTION_CLEAR;
    if ((event->field != LM_BUS_MALFUNCTION && !is_clear) || event->channel != 0) {
        return;
    }
    if (b->now.set != 0 && event->node != b->node &&
        age_us(b->last_us, event->time_us) <= b->stale_us) {
        b->count.rivals++;
        return;
    }
    b->node = event->node;
    b->last_us = event->time_us;
    if (is_clear) {
        clear(b, event->value);
    } else {
        set_one(b, event);
    }
}

void lm_malfunction_bus_at(struct lm_malfunction_bus *b, uint64_t now_us)
{
    b->is_stale = false;
    for (uint32_t kind = 0; kind < LM_MALFUNCTIONS; kind++) {
        const uint64_t old_us = age_us(b->heard_us[kind], now_us);
        b->now.set &= old_us > b->dead_us ? ~(1u << kind) : UINT32_MAX;
        b->is_stale |= (b->now.set >> kind & 1) != 0 && old_us > b->stale_us;
    }
}
