/* Live bus: live targets received over the bus (docs/bus.md, "Live targets"). Each is a set of
 * values, and each value comes in its own frame. Only a complete set takes effect. */
#ifndef LM_LIVE_BUS_H
#define LM_LIVE_BUS_H

#include <stdbool.h>
#include <stdint.h>

#include "lm/bus_event.h"
#include "lm/live.h"

enum {
    LM_LIVE_PARTS = 8,
    LM_LIVE_SET_US = 200000, /* a set whose frames take longer is discarded */
    LM_LIVE_AGED_A_STEP = 8
};

/* Parts that a set may leave out: bits of the last byte of LM_BUS_LIVE_KIND. */
enum {
    LM_LIVE_HAS_HEIGHT = 1,
    LM_LIVE_HAS_VELOCITY = 2,
    LM_LIVE_HAS_HEADING = 4,
    LM_LIVE_HAS_RCS = 8,
    LM_LIVE_HAS_ACCELERATION = 16,
    LM_LIVE_HAS = 31
};

/* State; the caller owns it. It starts as zeros. Counters only ever grow. */
struct lm_live_bus {
    struct lm_live live; /* in force */
    struct lm_live_set {
        uint64_t begun_us, motion_us; /* at the set's first frame */
        int32_t part[LM_LIVE_PARTS];
        uint8_t parts; /* bit n: part n was received; 0: no set is under way */
        uint8_t node, code;
    } set[LM_LIVE_MAX];         /* those that are being received */
    uint32_t stale_us, dead_us; /* ages of the event taken last: lm/bus_event.h */
    uint32_t next;              /* the next whose age is looked at */
    uint64_t heard_us[256];     /* last set of each node */
    bool is_silent;             /* a node that has targets here was silent for stale_us */
    bool is_silent_found;       /* in the present round of ages */
    struct {
        uint32_t sets;    /* sets that took effect */
        uint32_t torn;    /* sets left incomplete when frames of the next came */
        uint32_t refused; /* sets with a number out of range, or with parts that they do not name */
        uint32_t rivals;  /* frames of a second node while the first one is received */
        uint32_t removed; /* targets that a frame removed */
        uint32_t aged;    /* targets removed because no set came */
    } count;
};

/* Take an event of the bus. `motion_us` is the clock of what moves when it arrived. Events of other
 * fields change nothing. Cost: 80 instructions, 250 for the last value of a set. */
void lm_live_bus_take(struct lm_live_bus *b, const struct lm_bus_event *event, uint64_t motion_us);

/* The clock of what moves has stepped from one time to another: what was told holds at as long ago
 * as before, so that no target jumps. Cost: 10 instructions for each of LM_LIVE_MAX. */
void lm_live_bus_step_clock(struct lm_live_bus *b, uint64_t from_us, uint64_t to_us);

/* Look at the ages of the next LM_LIVE_AGED_A_STEP targets, and remove those that are dead. Call it
 * once a step: each is looked at once in LM_LIVE_MAX / LM_LIVE_AGED_A_STEP steps, and is_silent is
 * of the last such round. Cost: 100 instructions. */
void lm_live_bus_age(struct lm_live_bus *b, uint64_t now_us);

#endif
