/* Bus weather: rain, jammers and the sea received over the bus (docs/bus.md, "Weather"). A circle
 * of rain is a set of four values, a jammer a set of three. Each value comes in its own frame, and
 * only a complete set takes effect. Sea state and wind are values by themselves. */
#ifndef LM_WEATHER_BUS_H
#define LM_WEATHER_BUS_H

#include <stdbool.h>
#include <stdint.h>

#include "lm/bus_event.h"
#include "lm/environment.h"

enum {
    LM_WEATHER_SLOTS = LM_RAINS_MAX + LM_JAMMERS_MAX, /* circles of rain first */
    LM_WEATHER_PARTS = 4,
    LM_WEATHER_SET_US = 1000000 /* a set whose frames take longer is discarded */
};

/* Slot: one circle of rain or jammer. */
struct lm_weather_slot {
    struct {
        uint64_t begun_us; /* arrival of the set's first frame */
        int32_t part[LM_WEATHER_PARTS];
        uint8_t parts; /* bit n: part n was received; 0: no set is under way */
        uint8_t node, code;
    } set;            /* the set that is being received */
    bool is_there;    /* a complete set is in force: `is` */
    uint8_t node;     /* sender of the set in force */
    uint64_t time_us; /* time of the set in force */
    union {
        struct lm_rain rain;
        struct lm_jammer jammer;
    } is;
};

/* Sea state, or direction of the wind over it. */
struct lm_weather_sea {
    bool is_there;
    uint8_t node, priority; /* of the sender */
    int32_t value;          /* in the unit of the field */
    uint64_t time_us;
    uint32_t stale_us, dead_us;
};

/* State; the caller owns it. It starts as zeros. Counters only ever grow. */
struct lm_weather_bus {
    struct lm_weather_slot slot[LM_WEATHER_SLOTS];
    struct lm_weather_sea state, wind;
    uint32_t stale_us, dead_us; /* ages of the event taken last: lm/bus_event.h */
    struct {
        uint32_t sets;    /* sets that took effect */
        uint32_t torn;    /* sets left incomplete when frames of the next came */
        uint32_t refused; /* sets and states out of range, which a user's own table allows */
        uint32_t numbers; /* frames with a circle's or jammer's number that does not exist */
        uint32_t rivals;  /* frames of a second node while the first one is received */
    } count;
};

/* Take an event of the bus. Events of fields that are not weather change nothing. */
void lm_weather_bus_take(struct lm_weather_bus *w, const struct lm_bus_event *event);

/* Append the weather in force at `now_us` to *e, as far as there is room, and discard what is dead.
 * A sea state of *e that is commanded, and a wind that it has, stay.
 * Returns true if any of it is stale, by the ages of lm/nav.h. Cost: 100 instructions. */
bool lm_weather_bus_at(struct lm_weather_bus *w, uint64_t now_us, struct lm_environment *e);

#endif
