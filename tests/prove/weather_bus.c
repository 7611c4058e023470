/* Rain, jammers and sea of the bus (lm/weather_bus.h).
 *
 * Invariant: each circle of rain and each jammer in force, and the sea's state, lie within the
 * limits of lm_environment_check.
 *
 * Proved, for any state that keeps it, any event and any time: it is kept, of a slot chosen freely,
 * hence of all; no access outside an object, no shift too wide. The weather that is added keeps the
 * numbers of circles and jammers within LM_RAINS_MAX and LM_JAMMERS_MAX.
 *
 * Assumed: the environment that it is added to has no more than those. */
#include "firmware/nav/weather_bus.c"

#include "firmware/base/environment.c"
#include "prove.h"

struct lm_weather_bus nondet_weather_bus(void);
struct lm_bus_event nondet_event(void);
struct lm_environment nondet_environment(void);

static bool is_kept(const struct lm_weather_bus *w, uint32_t n)
{
    const struct lm_weather_slot *s = &w->slot[n];
    const bool is_sound = n < LM_RAINS_MAX ? is_rain(&s->is.rain) : is_jammer(&s->is.jammer);
    const bool is_sea_sound =
        !w->state.is_there || (w->state.value >= 0 && w->state.value <= LM_SEA_STATE_MAX);
    return (!s->is_there || is_sound) && is_sea_sound;
}

void prove_take(void)
{
    struct lm_weather_bus w = nondet_weather_bus();
    const struct lm_bus_event event = nondet_event();
    const uint32_t n = nondet_u32();
    ASSUME(n < LM_WEATHER_SLOTS && is_kept(&w, n));
    lm_weather_bus_take(&w, &event);
    PROVE(is_kept(&w, n));
}

void prove_at(void)
{
    struct lm_weather_bus w = nondet_weather_bus();
    struct lm_environment e = nondet_environment();
    for (uint32_t n = 0; n < LM_WEATHER_SLOTS; n++) {
        ASSUME(is_kept(&w, n));
    }
    ASSUME(lm_environment_check(&e) == LM_OK);
    lm_weather_bus_at(&w, nondet_u64(), &e);
    PROVE(lm_environment_check(&e) == LM_OK);
}
