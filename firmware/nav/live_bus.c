#include "lm/live_bus.h"

#include "age.h"
#include "fx/sat.h"
#include "fx/trig.h"
#include "lm/units.h"

/* Parts of a set, by number. The first three are always there. */
enum { LATITUDE, LONGITUDE, KIND, HEIGHT, VELOCITY, HEADING, RCS, ACCELERATION };
enum { ALWAYS = 1 << LATITUDE | 1 << LONGITUDE | 1 << KIND };

/* Number of the part that a field is, or LM_LIVE_PARTS. */
static uint32_t part_of(uint8_t field)
{
    static const uint8_t fields[LM_LIVE_PARTS] = {
        [LATITUDE] = LM_BUS_LIVE_LATITUDE, [LONGITUDE] = LM_BUS_LIVE_LONGITUDE,
        [KIND] = LM_BUS_LIVE_KIND,         [HEIGHT] = LM_BUS_LIVE_HEIGHT,
        [VELOCITY] = LM_BUS_LIVE_VELOCITY, [HEADING] = LM_BUS_LIVE_HEADING,
        [RCS] = LM_BUS_LIVE_RCS,           [ACCELERATION] = LM_BUS_LIVE_ACCELERATION};
    uint32_t part = 0;
    while (part < LM_LIVE_PARTS && fields[part] != field) {
        part++;
    }
    return part;
}

static enum lm_age age_at(const struct lm_live_bus *b, uint64_t heard_us, uint64_t now_us)
{
    return lm_age_of(b->stale_us, b->dead_us, heard_us, now_us);
}

static void remove_target(struct lm_live_bus *b, uint32_t number)
{
    struct lm_live_target *t = &b->live.target[number];
    b->live.count -= t->is_there;
    b->live.change += t->is_there;
    t->is_there = false;
}

/* Byte 0..3 of the kind, and the upper or lower half of a pair. */
static uint8_t byte_of(int32_t word, uint32_t number)
{
    return (uint8_t)((uint32_t)word >> (24 - 8 * number));
}

static int16_t first_of(int32_t pair)
{
    return (int16_t)((uint32_t)pair >> 16);
}

static int16_t second_of(int32_t pair)
{
    return (int16_t)((uint32_t)pair & 0xffff);
}

/* Convert a set. What it leaves out was 0 when it began. */
static struct lm_live_target meaning_of(const struct lm_live_set *s)
{
    const int32_t *part = s->part;
    const uint8_t kind = byte_of(part[KIND], 0), has = byte_of(part[KIND], 3);
    struct lm_live_target t = {
        .heard_us = s->begun_us,
        .motion_us = s->motion_us,
        .position = {(fx_bam_t)part[LATITUDE], (fx_bam_t)part[LONGITUDE]},
        .height_m_q6 = part[HEIGHT],
        .velocity = {first_of(part[VELOCITY]), second_of(part[VELOCITY])},
        .acceleration = {first_of(part[ACCELERATION]), second_of(part[ACCELERATION])},
        .heading = (fx_bam_t)(uint16_t)first_of(part[HEADING]) << 16,
        .turn = second_of(part[HEADING]),
        .kind = kind < LM_LIVE_KINDS ? kind : LM_LIVE_UNKNOWN,
        .reckoning = byte_of(part[KIND], 1),
        .signature = byte_of(part[KIND], 2),
        .node = s->node,
        .is_there = true,
        .has_height = (has & LM_LIVE_HAS_HEIGHT) != 0,
    };
    t.rcs_dbsm_q8 = (int16_t)(has & LM_LIVE_HAS_RCS ? fx_clamp_i32(part[RCS], INT16_MIN, INT16_MAX)
                                                    : lm_live_echoes[t.kind].rcs_dbsm * 256);
    if ((has & LM_LIVE_HAS_HEADING) == 0) {
        t.heading = fx_atan2(t.velocity[0], t.velocity[1]);
    }
    return t;
}

/* A table of the user's own may have wider ranges than the built-in one. */
static bool is_sound(const struct lm_live_target *t, uint8_t has)
{
    const int32_t east = t->velocity[0], north = t->velocity[1], most_dbsm_q8 = 100 * 256;
    return (has & ~LM_LIVE_HAS) == 0 && t->reckoning < LM_LIVE_RECKONINGS &&
           fx_abs_u32((int32_t)t->position.latitude) <= FX_BAM_90 &&
           fx_abs_u32(t->height_m_q6) <= LM_LIVE_HEIGHT_MAX_Q6 &&
           (uint32_t)(east * east) + (uint32_t)(north * north) <=
               (uint32_t)LM_LIVE_SPEED_MAX * LM_LIVE_SPEED_MAX &&
           fx_abs_u32(t->turn) <= LM_LIVE_TURN_MAX && fx_abs_u32(t->rcs_dbsm_q8) <= most_dbsm_q8;
}

/* Parts of a set, by what its kind says. Height is the first that may be left out: its bit in the
 * kind is bit 0, and bit HEIGHT here. */
static uint8_t needed_of(const struct lm_live_set *s)
{
    return (uint8_t)(ALWAYS | (byte_of(s->part[KIND], 3) & LM_LIVE_HAS) << HEIGHT);
}

static void finish_set(struct lm_live_bus *b, uint32_t number)
{
    struct lm_live_set *s = &b->set[number];
    const struct lm_live_target t = meaning_of(s);
    const bool has_more = s->parts != needed_of(s);
    s->parts = 0;
    if (has_more || !is_sound(&t, byte_of(s->part[KIND], 3))) {
        b->count.refused++;
        return;
    }
    b->live.count += !b->live.target[number].is_there;
    b->live.change++;
    b->live.target[number] = t;
    b->heard_us[t.node] = t.heard_us;
    b->count.sets++;
}

/* True if the value belongs to the set that is being received. */
static bool goes_on(const struct lm_live_set *s, const struct lm_bus_event *event, uint32_t part)
{
    return s->parts != 0 && (s->parts >> part & 1) == 0 && s->node == event->node &&
           s->code == event->code && event->time_us >= s->begun_us &&
           event->time_us - s->begun_us <= LM_LIVE_SET_US;
}

static void add_part(struct lm_live_bus *b, const struct lm_bus_event *event, uint32_t part,
                     uint64_t motion_us)
{
    struct lm_live_set *s = &b->set[event->service];
    if (!goes_on(s, event, part)) {
        b->count.torn += s->parts != 0;
        *s = (struct lm_live_set){.begun_us = event->time_us,
                                  .motion_us = motion_us,
                                  .node = event->node,
                                  .code = event->code};
    }
    s->part[part] = event->value;
    s->parts |= (uint8_t)(1u << part);
    const uint8_t needed = needed_of(s);
    if ((s->parts & needed) == needed) {
        finish_set(b, event->service);
    }
}

static void take_removal(struct lm_live_bus *b, const struct lm_bus_event *event)
{
    const bool is_all = event->field == LM_BUS_LIVE_CLEAR;
    const uint32_t first = is_all ? 0 : event->service, end = is_all ? LM_LIVE_MAX : first + 1;
    for (uint32_t i = first; i < end; i++) {
        b->count.removed += b->live.target[i].is_there;
        b->set[i].parts = 0;
        remove_target(b, i);
    }
}

void lm_live_bus_take(struct lm_live_bus *b, const struct lm_bus_event *event, uint64_t motion_us)
{
    if (!lm_bus_is_live(event->field) || event->channel != 0) {
        return; /* frames of two channels would break each other's sets */
    }
    const uint32_t part = part_of(event->field);
    if (part == LM_LIVE_PARTS) {
        take_removal(b, event);
        return;
    }
    b->stale_us = (uint32_t)lm_us_of_ms(event->stale_ms);
    b->dead_us = (uint32_t)lm_us_of_ms(event->dead_ms);
    const struct lm_live_target *t = &b->live.target[event->service];
    const bool is_rival = t->is_there && t->node != event->node &&
                          age_at(b, t->heard_us, event->time_us) == LM_AGE_GOOD;
    if (is_rival) {
        b->count.rivals++;
        return;
    }
    add_part(b, event, part, motion_us);
}

/* A time before 0 becomes 0. */
static uint64_t moved(uint64_t time_us, uint64_t from_us, uint64_t to_us)
{
    const uint64_t ago_us =
        from_us - time_us; /* modulo 2^64: it may lie ahead, by a clock's jitter */
    return time_us > from_us || ago_us < to_us ? to_us - ago_us : 0;
}

void lm_live_bus_step_clock(struct lm_live_bus *b, uint64_t from_us, uint64_t to_us)
{
    for (uint32_t i = 0; i < LM_LIVE_MAX; i++) {
        b->live.target[i].motion_us = moved(b->live.target[i].motion_us, from_us, to_us);
        b->set[i].motion_us = moved(b->set[i].motion_us, from_us, to_us);
    }
}

void lm_live_bus_age(struct lm_live_bus *b, uint64_t now_us)
{
    for (uint32_t i = 0; i < LM_LIVE_AGED_A_STEP; i++) {
        const struct lm_live_target *t = &b->live.target[b->next];
        b->is_silent_found |= t->is_there && age_at(b, b->heard_us[t->node], now_us) != LM_AGE_GOOD;
        if (t->is_there && age_at(b, t->heard_us, now_us) == LM_AGE_DEAD) {
            b->count.aged++;
            remove_target(b, b->next);
        }
        b->next = (b->next + 1) % LM_LIVE_MAX;
        if (b->next == 0) {
            b->is_silent = b->is_silent_found;
            b->is_silent_found = false;
        }
    }
}
