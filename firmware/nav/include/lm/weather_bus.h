/* Weather told by the bus: circles of rain, and jammers (docs/bus.md, "Weather").
 *
 * A circle of rain is a set of four values, a jammer one of three. Each value comes in a frame of
 * its own; only a set that is whole changes anything. The values of a set have the same node,
 * number (service code) and message code, and come within LM_WEATHER_SET_US. */
#ifndef LM_WEATHER_BUS_H
#define LM_WEATHER_BUS_H

#include <stdbool.h>
#include <stdint.h>

#include "lm/bus_event.h"
#include "lm/environment.h"

enum {
    LM_WEATHER_SLOTS = LM_RAINS_MAX + LM_JAMMERS_MAX, /* circles of rain first */
    LM_WEATHER_PARTS = 4,                             /* values of the longer set */
    LM_WEATHER_SET_US = 1000000                       /* longest time from first to last value */
};

/* One circle of rain or one jammer. */
struct lm_weather_slot {
    /* The set that is coming in. */
    struct {
        uint64_t begun_us; /* time of its first value */
        int32_t part[LM_WEATHER_PARTS];
        uint8_t parts; /* one bit for each value that came; 0: no set is under way */
        uint8_t node, code;
    } set;
    /* The last whole set. */
    bool is_there;
    uint8_t node;
    uint64_t time_us; /* of its first value */
    union {
        struct lm_rain rain;
        struct lm_jammer jammer;
    } is;
};

/* What was heard; the caller owns it. Starts as zeros. Counters only ever grow. */
struct lm_weather_bus {
    struct lm_weather_slot slot[LM_WEATHER_SLOTS];
    uint32_t stale_us, dead_us; /* ages of the event taken last: see lm/bus_event.h */
    struct {
        uint32_t sets;    /* sets that took effect */
        uint32_t torn;    /* sets left incomplete by a value of the next */
        uint32_t refused; /* whole sets that lm_environment_check refused */
        uint32_t numbers; /* values of number LM_RAINS_MAX, LM_JAMMERS_MAX or above */
        uint32_t rivals;  /* values of a second node while the first one's set is not stale */
    } count;
};

/* Take an event. Events of other fields, and of redundancy channels above 0, change nothing. */
void lm_weather_bus_take(struct lm_weather_bus *w, const struct lm_bus_event *event);

/* Append the weather in force at `now_us` to *e, as far as *e has room, and forget what is dead.
 * Ages count as in lm/nav.h. Returns true when some of it is stale. Cost: 100 instructions. */
bool lm_weather_bus_at(struct lm_weather_bus *w, uint64_t now_us, struct lm_environment *e);

#endif
