#include "lm/weather_bus.h"

#include "age.h"
#include "fx/sat.h"
#include "lm/status.h"
#include "lm/units.h"

/* Number of a field in its set. */
struct part {
    bool is_jammer;
    uint8_t number;
};

static bool part_of(enum lm_bus_field field, struct part *part)
{
    static const uint8_t rain[] = {LM_BUS_RAIN_LATITUDE, LM_BUS_RAIN_LONGITUDE, LM_BUS_RAIN_RADIUS,
                                   LM_BUS_RAIN_RATE};
    static const uint8_t jammer[] = {LM_BUS_JAMMER_LATITUDE, LM_BUS_JAMMER_LONGITUDE,
                                     LM_BUS_JAMMER_RATIO};
    for (uint32_t i = 0; i < LM_WEATHER_PARTS; i++) {
        if (rain[i] == field || (i < sizeof jammer && jammer[i] == field)) {
            *part = (struct part){rain[i] != field, (uint8_t)i};
            return true;
        }
    }
    return false;
}

static enum lm_age age_of(const struct lm_weather_bus *w, uint64_t time_us, uint64_t now_us)
{
    return lm_age_of(w->stale_us, w->dead_us, time_us, now_us);
}

static enum lm_age age_of_sea(const struct lm_weather_sea *s, uint64_t now_us)
{
    return s->is_there ? lm_age_of(s->stale_us, s->dead_us, s->time_us, now_us) : LM_AGE_DEAD;
}

enum { ALL = (1 << LM_WEATHER_SLOTS) - 1 };

/* Bit n of a mask is slot n. All bits are the sea as well. */
static void clear(struct lm_weather_bus *w, uint32_t mask)
{
    for (uint32_t n = 0; n < LM_WEATHER_SLOTS; n++) {
        if (mask >> n & 1) {
            w->slot[n].is_there = false;
            w->slot[n].set.parts = 0;
        }
    }
    if (mask == ALL) {
        w->state.is_there = w->wind.is_there = false;
    }
}

/* Convert a set to rain or jammer. Numbers are clamped to their types, which exceed every limit of
 * lm_environment_check. Radii are in 64ths of a metre. */
static struct lm_environment meaning_of(const struct lm_weather_slot *s, bool is_jammer)
{
    struct lm_environment e = {.rain_count = !is_jammer, .jammer_count = is_jammer};
    const int32_t *part = s->set.part;
    const struct lm_position position = {(fx_bam_t)part[0], (fx_bam_t)part[1]};
    if (is_jammer) {
        e.jammer[0] =
            (struct lm_jammer){position, (int16_t)fx_clamp_i32(part[2], INT16_MIN, INT16_MAX)};
    } else {
        e.rain[0] = (struct lm_rain){position, (uint32_t)lm_m_of_m_q6(fx_max_i32(part[2], 0)),
                                     (uint16_t)fx_clamp_i32(part[3], 0, UINT16_MAX)};
    }
    return e;
}

static void finish_set(struct lm_weather_bus *w, struct lm_weather_slot *s, bool is_jammer)
{
    const struct lm_environment e = meaning_of(s, is_jammer);
    s->set.parts = 0;
    if (lm_environment_check(&e) != LM_OK) {
        w->count.refused++;
        return;
    }
    if (is_jammer) {
        s->is.jammer = e.jammer[0];
    } else {
        s->is.rain = e.rain[0];
    }
    s->is_there = true;
    s->node = s->set.node;
    s->time_us = s->set.begun_us;
    w->count.sets++;
}

/* True if the value belongs to the set that is being received. */
static bool goes_on(const struct lm_weather_slot *s, const struct lm_bus_event *event,
                    uint32_t number)
{
    return s->set.parts != 0 && (s->set.parts >> number & 1) == 0 && s->set.node == event->node &&
           s->set.code == event->code && event->time_us >= s->set.begun_us &&
           event->time_us - s->set.begun_us <= LM_WEATHER_SET_US;
}

static void add_part(struct lm_weather_bus *w, struct lm_weather_slot *s,
                     const struct lm_bus_event *event, const struct part *part)
{
    if (!goes_on(s, event, part->number)) {
        w->count.torn += s->set.parts != 0;
        s->set.parts = 0;
        s->set.node = event->node;
        s->set.code = event->code;
        s->set.begun_us = event->time_us;
    }
    s->set.part[part->number] = event->value;
    s->set.parts |= (uint8_t)(1u << part->number);
    if (s->set.parts == (part->is_jammer ? 7 : 15)) {
        finish_set(w, s, part->is_jammer);
    }
}

/* Take a value of the sea. While one is good, only its own sender and better ones are heard. */
static void take_sea(struct lm_weather_bus *w, struct lm_weather_sea *s,
                     const struct lm_bus_event *event)
{
    const bool is_good = age_of_sea(s, event->time_us) == LM_AGE_GOOD;
    if (is_good && event->priority > s->priority) {
        return;
    }
    if (is_good && event->priority == s->priority && event->node != s->node) {
        w->count.rivals++;
        return;
    }
    *s = (struct lm_weather_sea){.is_there = true,
                                 .node = event->node,
                                 .priority = event->priority,
                                 .value = event->value,
                                 .time_us = event->time_us,
                                 .stale_us = (uint32_t)lm_us_of_ms(event->stale_ms),
                                 .dead_us = (uint32_t)lm_us_of_ms(event->dead_ms)};
}

static void take_sea_state(struct lm_weather_bus *w, const struct lm_bus_event *event)
{
    if (event->value < 0 || event->value > LM_SEA_STATE_MAX) {
        w->count.refused++;
        return;
    }
    take_sea(w, &w->state, event);
}

void lm_weather_bus_take(struct lm_weather_bus *w, const struct lm_bus_event *event)
{
    struct part part;
    if (event->channel != 0) {
        return; /* frames of two channels would break each other's sets */
    }
    if (event->field == LM_BUS_WEATHER_CLEAR) {
        clear(w, (uint32_t)event->value);
        return;
    }
    if (event->field == LM_BUS_SEA_STATE) {
        take_sea_state(w, event);
        return;
    }
    if (event->field == LM_BUS_WIND_DIRECTION) {
        take_sea(w, &w->wind, event);
        return;
    }
    if (!part_of((enum lm_bus_field)event->field, &part)) {
        return;
    }
    w->stale_us = (uint32_t)lm_us_of_ms(event->stale_ms);
    w->dead_us = (uint32_t)lm_us_of_ms(event->dead_ms);
    if (event->service >= (part.is_jammer ? LM_JAMMERS_MAX : LM_RAINS_MAX)) {
        w->count.numbers++;
        return;
    }
    struct lm_weather_slot *s =
        &w->slot[(part.is_jammer ? (uint32_t)LM_RAINS_MAX : 0) + event->service];
    if (s->is_there && s->node != event->node &&
        age_of(w, s->time_us, event->time_us) == LM_AGE_GOOD) {
        w->count.rivals++;
        return;
    }
    add_part(w, s, event, &part);
}

/* Add the sea as far as nothing is commanded. Returns true if what was added is stale. */
static bool add_sea(struct lm_weather_bus *w, uint64_t now_us, struct lm_environment *e)
{
    const enum lm_age state_age = age_of_sea(&w->state, now_us),
                      wind_age = age_of_sea(&w->wind, now_us);
    const bool is_state_used = state_age != LM_AGE_DEAD && !e->is_sea_commanded;
    const bool is_wind_used = wind_age != LM_AGE_DEAD && !e->has_wind;
    w->state.is_there = state_age != LM_AGE_DEAD;
    w->wind.is_there = wind_age != LM_AGE_DEAD;
    e->sea_state = is_state_used ? (uint8_t)w->state.value : e->sea_state;
    if (is_wind_used) {
        e->has_wind = true;
        e->wind_from = (fx_bam_t)w->wind.value;
    }
    return (is_state_used && state_age == LM_AGE_STALE) ||
           (is_wind_used && wind_age == LM_AGE_STALE);
}

bool lm_weather_bus_at(struct lm_weather_bus *w, uint64_t now_us, struct lm_environment *e)
{
    bool is_any_stale = add_sea(w, now_us, e);
    for (uint32_t n = 0; n < LM_WEATHER_SLOTS; n++) {
        struct lm_weather_slot *s = &w->slot[n];
        const enum lm_age age = s->is_there ? age_of(w, s->time_us, now_us) : LM_AGE_DEAD;
        s->is_there = age != LM_AGE_DEAD;
        is_any_stale = is_any_stale || age == LM_AGE_STALE;
        if (age != LM_AGE_DEAD && n < LM_RAINS_MAX && e->rain_count < LM_RAINS_MAX) {
            e->rain[e->rain_count++] = s->is.rain;
        } else if (age != LM_AGE_DEAD && n >= LM_RAINS_MAX && e->jammer_count < LM_JAMMERS_MAX) {
            e->jammer[e->jammer_count++] = s->is.jammer;
        }
    }
    return is_any_stale;
}
