/* Gateway: datagrams of DIS in, frames of live targets out.
 *
 * It keeps every entity that passes the filters and that the table makes a target of, gives up to
 * 256 of them a number of the bus, and tells the display of each when it is new, when the display's
 * own dead reckoning is off by more than a threshold, and at least once a second. It never sends
 * more than a share of the bus. What it leaves out is counted.
 *
 * Time is an argument, in microseconds on one clock; the gateway has none of its own. */
#ifndef DIS_GATEWAY_H
#define DIS_GATEWAY_H

#include "dis/kinds.h"
#include "dis/pdu.h"
#include "dis/target.h"

enum { DIS_ENTITIES_MAX = 16384, DIS_FILTER_MAX = 32 };

/* Numbers that pass; none: all do. */
struct dis_filter {
    uint16_t number[DIS_FILTER_MAX];
    int count;
};

struct dis_settings {
    struct dis_filter exercises, sites, applications;
    struct dis_id ownship; /* no target of its own, and the nearest to it come first */
    bool has_ownship;
    bool has_centre; /* the nearest to this place come first */
    struct dis_place centre;
    struct dis_sea_level sea;
    bool tells_clock;   /* dis/clock.h */
    double timeout_s;   /* silence after which an entity is removed */
    double heartbeat_s; /* each target is told at least so often */
    double threshold_m, threshold_deg;
    double bits_per_s, load; /* of the bus, and the share of it that may be used */
    uint8_t node;            /* number of this sender on the bus, 1..255 */
    uint8_t first_number, last_number;
};

/* The settings of landmass-dis without options: no filter, all 256 numbers, 40 % of 1 Mbit/s. */
struct dis_settings dis_settings_usual(void);

/* What was met and what became of it. */
struct dis_counts {
    uint64_t datagrams, bytes, pdus, states, updates, commands, other_pdus, other_versions;
    uint64_t fault[DIS_FAULT_COUNT];
    uint64_t other_exercise, other_site, ownship, update_of_unknown;
    uint64_t attached; /* of CIGI: an entity that another one carries */
    uint64_t entities, deactivated, timed_out, without_room; /* entities that came and went */
    uint64_t skipped, without_rule;                          /* entities that are no targets */
    uint64_t too_fast, too_high;                             /* states that the bus cannot carry */
    uint64_t sets, new_sets, changed_sets, heartbeats, removals, frames, refused_frames;
    uint64_t late; /* heartbeats that waited for room on the bus for more than a second */
    uint32_t targets, targets_most, left_out, left_out_most;
};

/* Takes a frame; false: it is lost. `time_us` is when it goes out at the earliest. */
struct dis_sink {
    bool (*send)(void *context, const struct lm_can_frame *frame, int64_t time_us);
    void *context;
};

struct dis_gateway;

/* A gateway with these settings and kinds, which is borrowed, and whose rules count their entities.
 * NULL, with the error reported, when there is no memory. */
struct dis_gateway *dis_gateway_new(const struct dis_settings *settings, struct dis_kinds *kinds,
                                    const struct dis_sink *sink);
void dis_gateway_free(struct dis_gateway *g);

/* Take a datagram that came at `now_us`. A target that is new or surprising is sent by the next
 * step. */
void dis_gateway_take(struct dis_gateway *g, const uint8_t *bytes, size_t length, int64_t now_us);

/* Send what is due. Call it after each datagram, and every 5 ms or so. Cost: some 0.2 ms with 256
 * targets. */
void dis_gateway_step(struct dis_gateway *g, int64_t now_us);

/* Remove every target from the display, at the end of the run. */
void dis_gateway_end(struct dis_gateway *g, int64_t now_us);

const struct dis_counts *dis_gateway_counts(const struct dis_gateway *g);

/* Is the exercise frozen by a Stop/Freeze PDU? */
bool dis_gateway_is_frozen(const struct dis_gateway *g);

/* An entity, for a listing: `index` below dis_gateway_entities(). */
struct dis_listed {
    struct dis_id id;
    struct dis_type type;
    const char *marking;
    int number; /* of the bus; -1: none */
    struct dis_kind kind;
    bool has_kind;
    struct dis_place place; /* now */
};
int dis_gateway_entities(const struct dis_gateway *g);
struct dis_listed dis_gateway_entity(const struct dis_gateway *g, int index, int64_t now_us);

/* Types that no rule fits, at most DIS_STRANGE_MAX of them. */
enum { DIS_STRANGE_MAX = 16 };
int dis_gateway_strange(const struct dis_gateway *g, struct dis_type types[DIS_STRANGE_MAX]);

#endif
