#include "dis/gateway.h"

#include "dis/clock.h"
#include "entities.h"
#include "feed.h"
#include "hs/error.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    FRAME_BITS = 135, /* of a frame with eight bytes, stuffing included */
    BURST_FRAMES = 16,
    SWEEP_US = 100000,   /* between two looks at who fell silent */
    CHOOSE_US = 1000000, /* between two choices of the nearest */
    LATE_US = 1000000,
    ALL = 65535
};

/* A clock that is off by more than this is none to go by. */
#define CLOCK_OFF_MAX_S 2.0

/* An entity that wants a number; the least rank gets one first. */
struct ranked {
    double rank;
    int at;
    bool has_number;
};

struct dis_gateway {
    struct dis_settings set;
    struct dis_kinds *kinds; /* borrowed */
    struct dis_sink sink;
    struct dis_counts count;
    struct entities entities;
    int of_number[DIS_TARGETS];   /* its entity, or -1 */
    bool is_leaving[DIS_TARGETS]; /* its removal waits for room on the bus */
    int next_number;
    uint8_t code;       /* of the next set */
    double frames_left; /* that may be sent now */
    int64_t step_us, sweep_us, choose_us, slot_us;
    bool has_stepped, is_frozen;
    struct dis_clock clock;
    int64_t frozen_us;
    bool has_ownship_place;
    struct dis_place ownship_place;
    struct dis_type strange[DIS_STRANGE_MAX];
    int strange_count;
    struct ranked ranked[DIS_ENTITIES_MAX]; /* while choosing */
};

struct dis_settings dis_settings_usual(void)
{
    return (struct dis_settings){.timeout_s = 12,
                                 .heartbeat_s = 1,
                                 .threshold_m = 2,
                                 .threshold_deg = 3,
                                 .bits_per_s = 1e6,
                                 .load = 0.4,
                                 .node = 60,
                                 .last_number = 255};
}

struct dis_gateway *dis_gateway_new(const struct dis_settings *settings, struct dis_kinds *kinds,
                                    const struct dis_sink *sink)
{
    struct dis_gateway *g = calloc(1, sizeof *g);
    if (g == NULL) {
        (void)hs_error("gateway", NULL, "no memory for its entities");
        return NULL;
    }
    g->set = *settings;
    g->kinds = kinds;
    g->sink = *sink;
    g->next_number = settings->first_number;
    g->frames_left = BURST_FRAMES;
    entities_clear(&g->entities);
    for (int i = 0; i < DIS_TARGETS; i++) {
        g->of_number[i] = -1;
    }
    return g;
}

void dis_gateway_free(struct dis_gateway *g)
{
    free(g);
}

/* ---- numbers of the bus ---- */

/* The one that has been free for longest, more or less: the next behind the last one given. */
static void give_number(struct dis_gateway *g, int at)
{
    const int numbers = g->set.last_number - g->set.first_number + 1;
    for (int i = 0; i < numbers; i++) {
        const int number =
            g->set.first_number + (g->next_number - g->set.first_number + i) % numbers;
        if (g->of_number[number] < 0 && !g->is_leaving[number]) {
            g->of_number[number] = at;
            g->entities.one[at].number = number;
            g->entities.one[at].was_told = false;
            g->next_number = number + 1 > g->set.last_number ? g->set.first_number : number + 1;
            return;
        }
    }
}

static void take_number(struct dis_gateway *g, int at)
{
    struct entity *e = &g->entities.one[at];
    if (e->number != NO_NUMBER) {
        g->of_number[e->number] = -1;
        g->is_leaving[e->number] = e->was_told;
        e->number = NO_NUMBER;
        e->was_told = false;
    }
}

static void drop_entity(struct dis_gateway *g, int at)
{
    take_number(g, at);
    entities_drop(&g->entities, at);
    if (at < g->entities.count && g->entities.one[at].number != NO_NUMBER) {
        g->of_number[g->entities.one[at].number] = at; /* the last one moved here */
    }
}

/* ---- what comes in ---- */

static bool passes(const struct dis_filter *f, uint16_t number)
{
    for (int i = 0; i < f->count; i++) {
        if (f->number[i] == number) {
            return true;
        }
    }
    return f->count == 0;
}

/* The instant that a PDU is of: by its own clock where that is UTC and agrees with ours. */
static int64_t instant_us(const struct dis_pdu *pdu, int64_t now_us)
{
    bool is_absolute;
    const double told_s = dis_timestamp_s(pdu->timestamp, &is_absolute);
    const double ours_s = (double)(now_us % INT64_C(3600000000)) * 1e-6;
    const double ahead_s = remainder(told_s - ours_s, 3600);
    return is_absolute && ahead_s <= 0 && ahead_s >= -CLOCK_OFF_MAX_S
               ? now_us + llround(ahead_s * 1e6)
               : now_us;
}

static void note_strange(struct dis_gateway *g, const struct dis_type *type)
{
    for (int i = 0; i < g->strange_count; i++) {
        if (memcmp(&g->strange[i], type, sizeof *type) == 0) {
            return;
        }
    }
    if (g->strange_count < DIS_STRANGE_MAX) {
        g->strange[g->strange_count++] = *type;
    }
}

static bool is_same_type(const struct dis_type *a, const struct dis_type *b)
{
    return memcmp(a, b, sizeof *a) == 0; /* no padding: 1 + 1 + 2 + 4 bytes */
}

static void look_up_kind(struct dis_gateway *g, struct entity *e)
{
    struct dis_rule *rule = dis_kinds_find(g->kinds, &e->type, &e->kind);
    e->is_wanted = rule != NULL && !e->kind.is_skipped;
    g->count.skipped += rule != NULL && e->kind.is_skipped;
    g->count.without_rule += rule == NULL;
    if (rule == NULL) {
        note_strange(g, &e->type);
    } else {
        rule->entities++;
    }
}

/* What an update does not tell stays as it was. */
static void take_motion(struct entity *e, const struct dis_entity_state *s, int64_t of_us)
{
    const struct dis_motion before = e->motion;
    e->motion = s->motion;
    e->motion_us = of_us;
    if (s->is_update) {
        e->motion.algorithm = before.algorithm;
        memcpy(e->motion.acceleration_m_s2, before.acceleration_m_s2,
               sizeof before.acceleration_m_s2);
        memcpy(e->motion.turn_rad_s, before.turn_rad_s, sizeof before.turn_rad_s);
    } else {
        memcpy(e->marking, s->marking, sizeof e->marking);
    }
}

static int find_or_add(struct dis_gateway *g, const struct dis_entity_state *s, int64_t now_us)
{
    int at = entities_find(&g->entities, &s->id);
    if (at >= 0) {
        return at;
    }
    if (s->is_update) {
        g->count.update_of_unknown++;
        return -1;
    }
    at = entities_add(&g->entities, &s->id);
    if (at < 0) {
        g->count.without_room++;
        return -1;
    }
    g->count.entities++;
    g->entities.one[at].first_us = now_us;
    g->entities.one[at].type = s->type;
    look_up_kind(g, &g->entities.one[at]);
    return at;
}

static void judge(struct dis_gateway *g, int at, int64_t now_us);

/* `of_us` is the instant that the state is of. */
static void take_state(struct dis_gateway *g, const struct dis_entity_state *s, int64_t of_us,
                       int64_t now_us)
{
    if (g->set.has_ownship && dis_id_is(&s->id, &g->set.ownship)) {
        g->count.ownship++;
        g->ownship_place = dis_place_of(s->motion.place_m);
        g->has_ownship_place = true;
        return;
    }
    if (s->is_deactivated) {
        const int at = entities_find(&g->entities, &s->id);
        if (at >= 0) {
            g->count.deactivated++;
            drop_entity(g, at);
        }
        return;
    }
    const int at = find_or_add(g, s, now_us);
    if (at < 0) {
        return;
    }
    struct entity *e = &g->entities.one[at];
    if (!s->is_update && !is_same_type(&e->type, &s->type)) {
        e->type = s->type;
        look_up_kind(g, e);
    }
    take_motion(e, s, of_us);
    e->heard_us = now_us;
    judge(g, at, now_us);
}

static void take_command(struct dis_gateway *g, const struct dis_command *c, int64_t now_us)
{
    const bool is_for_all = c->receiver.site == ALL && c->receiver.application == ALL;
    if (!is_for_all || c->is_start != g->is_frozen) {
        return;
    }
    g->is_frozen = !c->is_start;
    dis_clock_set(&g->clock, g->is_frozen, now_us);
    if (!c->is_start) {
        g->frozen_us = now_us;
        return;
    }
    for (int i = 0; i < g->entities.count; i++) { /* the time that stood is not lived through */
        struct entity *e = &g->entities.one[i];
        const int64_t stood_us =
            now_us - (e->motion_us > g->frozen_us ? e->motion_us : g->frozen_us);
        e->motion_us += stood_us;
        e->heard_us = now_us;
    }
}

static enum dis_fault take_pdu(struct dis_gateway *g, const struct dis_pdu *pdu, int64_t now_us)
{
    struct dis_entity_state state;
    struct dis_command command;
    enum dis_fault fault = DIS_FAULT_NONE;
    switch (pdu->type) {
    case DIS_ENTITY_STATE:
    case DIS_ENTITY_STATE_UPDATE:
        fault = dis_entity_state_read(pdu, &state);
        if (fault != DIS_FAULT_NONE) {
            return fault;
        }
        g->count.states += !state.is_update;
        g->count.updates += state.is_update;
        if (!passes(&g->set.sites, state.id.site) ||
            !passes(&g->set.applications, state.id.application)) {
            g->count.other_site++;
            return DIS_FAULT_NONE;
        }
        take_state(g, &state, instant_us(pdu, now_us), now_us);
        return DIS_FAULT_NONE;
    case DIS_START_RESUME:
    case DIS_STOP_FREEZE:
        fault = dis_command_read(pdu, &command);
        if (fault == DIS_FAULT_NONE) {
            g->count.commands++;
            take_command(g, &command, now_us);
        }
        return fault;
    default:
        g->count.other_pdus++;
        return DIS_FAULT_NONE;
    }
}

void dis_gateway_take(struct dis_gateway *g, const uint8_t *bytes, size_t length, int64_t now_us)
{
    struct dis_datagram d;
    struct dis_pdu pdu;
    enum dis_fault fault = DIS_FAULT_NONE;
    enum dis_step step;
    g->count.datagrams++;
    g->count.bytes += length;
    dis_datagram_begin(&d, bytes, length);
    while ((step = dis_datagram_next(&d, &pdu, &fault)) != DIS_STEP_END) {
        if (step == DIS_STEP_BROKEN) {
            g->count.fault[fault]++;
            return;
        }
        g->count.pdus++;
        if (step == DIS_STEP_VERSION) {
            g->count.other_versions++;
        } else if (!passes(&g->set.exercises, pdu.exercise)) {
            g->count.other_exercise++;
        } else {
            fault = take_pdu(g, &pdu, now_us);
            g->count.fault[fault] += fault != DIS_FAULT_NONE;
        }
    }
}

/* ---- what other readers bring ---- */

void dis_gateway_take_entity(struct dis_gateway *g, const struct dis_entity_state *s,
                             int64_t now_us)
{
    take_state(g, s, now_us, now_us);
}

void dis_gateway_hear_all(struct dis_gateway *g, int64_t now_us)
{
    for (int i = 0; i < g->entities.count; i++) {
        g->entities.one[i].heard_us = now_us;
    }
}

struct dis_counts *dis_gateway_tally(struct dis_gateway *g)
{
    return &g->count;
}

/* ---- who gets a number ---- */

static double since_s(const struct dis_gateway *g, const struct entity *e, int64_t now_us)
{
    const int64_t until_us = g->is_frozen && g->frozen_us < now_us ? g->frozen_us : now_us;
    return until_us > e->motion_us ? (double)(until_us - e->motion_us) * 1e-6 : 0;
}

/* Can the bus carry it? One that can gets a number if there is a free one. */
static void judge(struct dis_gateway *g, int at, int64_t now_us)
{
    struct entity *e = &g->entities.one[at];
    struct dis_target target;
    if (!e->is_wanted) {
        take_number(g, at);
        return;
    }
    const enum dis_unfit unfit =
        dis_target_of(&e->motion, &e->kind, &g->set.sea, since_s(g, e, now_us), &target);
    g->count.too_fast += unfit == DIS_TOO_FAST;
    g->count.too_high += unfit == DIS_TOO_HIGH;
    e->is_fit = unfit == DIS_FIT;
    if (!e->is_fit) {
        take_number(g, at);
    } else if (e->number == NO_NUMBER) {
        give_number(g, at);
    }
}

static double distance_m(const struct dis_place *a, const struct dis_place *b)
{
    double from_m[3], to_m[3];
    dis_place_back(a, from_m);
    dis_place_back(b, to_m);
    return hypot(hypot(from_m[0] - to_m[0], from_m[1] - to_m[1]), from_m[2] - to_m[2]);
}

/* Who has a number keeps it until another is nearer by a tenth, or, without a centre, for good. */
static double rank_of(const struct dis_gateway *g, const struct entity *e, int64_t now_us)
{
    const bool has_number = e->number != NO_NUMBER;
    if (!g->has_ownship_place && !g->set.has_centre) {
        return has_number ? -(double)INFINITY : (double)e->first_us;
    }
    const struct dis_state s = dis_reckon(&e->motion, since_s(g, e, now_us));
    const struct dis_place place = dis_place_of(s.place_m);
    const struct dis_place *centre = g->has_ownship_place ? &g->ownship_place : &g->set.centre;
    return distance_m(&place, centre) * (has_number ? 0.9 : 1);
}

static int compare_ranked(const void *a, const void *b)
{
    const struct ranked *x = a, *y = b;
    return x->rank < y->rank ? -1 : x->rank > y->rank ? 1 : x->at - y->at;
}

static uint32_t larger(uint32_t a, uint32_t b)
{
    return a > b ? a : b;
}

static void count_left_out(struct dis_gateway *g, int wanted, int numbers)
{
    g->count.left_out = wanted > numbers ? (uint32_t)(wanted - numbers) : 0;
    g->count.left_out_most = larger(g->count.left_out_most, g->count.left_out);
}

/* Those that want a number, the best first. Those with one that are not among the best lose it. */
static void choose(struct dis_gateway *g, int64_t now_us)
{
    struct ranked *ranked = g->ranked;
    const int numbers = g->set.last_number - g->set.first_number + 1;
    int count = 0;
    for (int i = 0; i < g->entities.count; i++) {
        const struct entity *e = &g->entities.one[i];
        if (e->is_wanted && e->is_fit) {
            ranked[count++] = (struct ranked){rank_of(g, e, now_us), i, e->number != NO_NUMBER};
        }
    }
    qsort(ranked, (size_t)count, sizeof *ranked, compare_ranked);
    for (int i = numbers; i < count; i++) {
        if (ranked[i].has_number) {
            take_number(g, ranked[i].at);
        }
    }
    for (int i = 0; i < count && i < numbers; i++) {
        if (!ranked[i].has_number) {
            give_number(g, ranked[i].at);
        }
    }
    count_left_out(g, count, numbers);
}

static void sweep(struct dis_gateway *g, int64_t now_us)
{
    for (int i = g->entities.count - 1; i >= 0 && !g->is_frozen; i--) {
        const struct entity *e = &g->entities.one[i];
        if ((double)(now_us - e->heard_us) * 1e-6 > g->set.timeout_s) {
            g->count.timed_out++;
            drop_entity(g, i);
        }
    }
}

/* ---- what goes out ---- */

static void put(struct dis_gateway *g, const struct lm_can_frame *frame, int64_t now_us)
{
    const int64_t at_us = g->slot_us > now_us ? g->slot_us : now_us;
    g->slot_us = at_us + (int64_t)ceil(FRAME_BITS * 1e6 / g->set.bits_per_s);
    g->frames_left -= 1;
    g->count.frames++;
    g->count.refused_frames += !g->sink.send(g->sink.context, frame, at_us);
}

static void put_clock(struct dis_gateway *g, int64_t now_us)
{
    struct lm_can_frame frames[DIS_CLOCK_FRAMES];
    if (!g->set.tells_clock || g->frames_left < DIS_CLOCK_FRAMES) {
        return;
    }
    const int count = dis_clock_frames(&g->clock, g->set.node, now_us, frames);
    for (int i = 0; i < count; i++) {
        put(g, &frames[i], now_us);
    }
}

static void put_removals(struct dis_gateway *g, int64_t now_us)
{
    for (int number = 0; number < DIS_TARGETS && g->frames_left >= 1; number++) {
        if (g->is_leaving[number]) {
            const struct lm_can_frame f = dis_removal(g->set.node, (uint8_t)number, g->code++);
            put(g, &f, now_us);
            g->is_leaving[number] = false;
            g->count.removals++;
        }
    }
}

/* A target that may be due, and how much so: above 2 for what is new, above 1 for what the display
 * has wrong, up to 1 for a heartbeat. */
struct due {
    double urgency;
    int number;
    struct dis_target target;
};

static double urgency_of(const struct dis_gateway *g, const struct entity *e,
                         const struct dis_target *now, int64_t now_us)
{
    if (!e->was_told) {
        return 3;
    }
    const double age_s = (double)(now_us - e->told_us) * 1e-6;
    const struct dis_error error = dis_target_error(&e->told, age_s, now);
    const double off =
        fmax(error.metres / g->set.threshold_m, error.degrees / g->set.threshold_deg);
    return error.is_other                ? 2
           : off > 1                     ? 2 - 1 / (off + 1)
           : age_s >= g->set.heartbeat_s ? 1 - 1 / (age_s + 1)
                                         : 0;
}

static int compare_due(const void *a, const void *b)
{
    const struct due *x = a, *y = b;
    return x->urgency > y->urgency ? -1 : x->urgency < y->urgency ? 1 : x->number - y->number;
}

static void tell(struct dis_gateway *g, const struct due *due, int64_t now_us)
{
    struct lm_can_frame frames[DIS_SET_MAX];
    struct entity *e = &g->entities.one[g->of_number[due->number]];
    const int count =
        dis_target_frames(&due->target, g->set.node, (uint8_t)due->number, g->code, frames);
    g->code++;
    for (int i = 0; i < count; i++) {
        put(g, &frames[i], now_us);
    }
    g->count.sets++;
    g->count.new_sets += due->urgency > 2;
    g->count.changed_sets += due->urgency > 1 && due->urgency <= 2;
    g->count.heartbeats += due->urgency <= 1;
    g->count.late +=
        e->was_told && (double)(now_us - e->told_us) > g->set.heartbeat_s * 1e6 + (double)LATE_US;
    e->told = due->target;
    e->told_us = now_us;
    e->was_told = true;
}

static void put_targets(struct dis_gateway *g, int64_t now_us)
{
    struct due due[DIS_TARGETS];
    int count = 0;
    g->count.targets = 0;
    for (int number = 0; number < DIS_TARGETS; number++) {
        const int at = g->of_number[number];
        if (at < 0) {
            continue;
        }
        const struct entity *e = &g->entities.one[at];
        struct due *d = &due[count];
        if (dis_target_of(&e->motion, &e->kind, &g->set.sea, since_s(g, e, now_us), &d->target) !=
            DIS_FIT) {
            g->entities.one[at].is_fit = false; /* reckoned out of what the bus carries */
            take_number(g, at);
            continue;
        }
        g->count.targets++;
        d->number = number;
        d->urgency = urgency_of(g, e, &d->target, now_us);
        count += d->urgency > 0;
    }
    g->count.targets_most = larger(g->count.targets_most, g->count.targets);
    qsort(due, (size_t)count, sizeof *due, compare_due);
    for (int i = 0; i < count && g->frames_left >= DIS_SET_MAX; i++) {
        tell(g, &due[i], now_us);
    }
}

/* Frames that the share of the bus allows since the last step. */
static void refill(struct dis_gateway *g, int64_t now_us)
{
    const double passed_s = g->has_stepped ? (double)(now_us - g->step_us) * 1e-6 : 0;
    const double per_s = g->set.bits_per_s * g->set.load / FRAME_BITS;
    g->frames_left = fmin(BURST_FRAMES, g->frames_left + fmax(0, passed_s) * per_s);
    g->step_us = now_us;
    g->has_stepped = true;
}

void dis_gateway_step(struct dis_gateway *g, int64_t now_us)
{
    refill(g, now_us);
    if (now_us - g->sweep_us >= SWEEP_US || now_us < g->sweep_us) {
        g->sweep_us = now_us;
        sweep(g, now_us);
    }
    if (now_us - g->choose_us >= CHOOSE_US || now_us < g->choose_us) {
        g->choose_us = now_us;
        choose(g, now_us);
    }
    put_clock(g, now_us);
    put_removals(g, now_us);
    put_targets(g, now_us);
}

void dis_gateway_end(struct dis_gateway *g, int64_t now_us)
{
    for (int i = g->entities.count - 1; i >= 0; i--) {
        drop_entity(g, i);
    }
    g->frames_left = DIS_TARGETS;
    put_removals(g, now_us);
}

/* ---- what others look at ---- */

const struct dis_counts *dis_gateway_counts(const struct dis_gateway *g)
{
    return &g->count;
}

bool dis_gateway_is_frozen(const struct dis_gateway *g)
{
    return g->is_frozen;
}

int dis_gateway_entities(const struct dis_gateway *g)
{
    return g->entities.count;
}

struct dis_listed dis_gateway_entity(const struct dis_gateway *g, int index, int64_t now_us)
{
    const struct entity *e = &g->entities.one[index];
    const struct dis_state s = dis_reckon(&e->motion, since_s(g, e, now_us));
    return (struct dis_listed){.id = e->id,
                               .type = e->type,
                               .marking = e->marking,
                               .number = e->number,
                               .kind = e->kind,
                               .has_kind = e->is_wanted,
                               .place = dis_place_of(s.place_m)};
}

int dis_gateway_strange(const struct dis_gateway *g, struct dis_type types[DIS_STRANGE_MAX])
{
    memcpy(types, g->strange, sizeof g->strange);
    return g->strange_count;
}
