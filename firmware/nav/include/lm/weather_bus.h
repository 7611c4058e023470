/* Rain and jammers as the bus tells them: docs/bus.md, "Weather". A circle of rain is four values,
 * a jammer three; each comes in a frame of its own, and only all of them together change anything.
 */
#ifndef LM_WEATHER_BUS_H
#define LM_WEATHER_BUS_H

#include <stdbool.h>
#include <stdint.h>

#include "lm/bus_event.h"
#include "lm/environment.h"

enum {
    LM_WEATHER_SLOTS = LM_RAINS_MAX + LM_JAMMERS_MAX, /* circles of rain first */
    LM_WEATHER_PARTS = 4,
    LM_WEATHER_SET_US = 1000000 /* a set whose frames take longer is none */
};

/* One circle or jammer. */
struct lm_weather_slot {
    struct {
        uint64_t begun_us; /* its first frame */
        int32_t part[LM_WEATHER_PARTS];
        uint8_t parts; /* a bit for each that came; 0: no set is under way */
        uint8_t node, code;
    } set; /* that is coming in */
    bool is_there;
    uint8_t node;
    uint64_t time_us; /* of the set that it was made of */
    union {
        struct lm_rain rain;
        struct lm_jammer jammer;
    } is;
};

/* What the display remembers; the caller owns it. Starts as zeros. Counters only ever grow. */
struct lm_weather_bus {
    struct lm_weather_slot slot[LM_WEATHER_SLOTS];
    uint32_t stale_us, dead_us; /* of the event taken last: see lm/bus_event.h */
    struct {
        uint32_t sets;    /* that took effect */
        uint32_t torn;    /* left incomplete by frames of the next */
        uint32_t refused; /* whole, but out of range: of a table of the user's own */
        uint32_t numbers; /* frames of a circle or jammer that there is not */
        uint32_t rivals;  /* frames of a second node while the first one is heard */
    } count;
};

/* Take an event of the bus. Events of fields that are not weather change nothing. */
void lm_weather_bus_take(struct lm_weather_bus *w, const struct lm_bus_event *event);

/* Append what is in force at `now_us` to *e, as far as there is room, and forget what is dead.
 * Whether any of it is stale. Ages are those of lm/nav.h. Cost: 100 instructions. */
bool lm_weather_bus_at(struct lm_weather_bus *w, uint64_t now_us, struct lm_environment *e);

#endif
