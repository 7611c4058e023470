/* Live targets of the bus (lm/live_bus.h).
 *
 * Invariant: each target in force has a kind, a reckoning, a latitude, a height and a turn within
 * the limits of lm/live.h; `count` is the number of them; the one whose age is looked at next is
 * one of them.
 *
 * Proved, for any state that keeps it, any event and any time: it is kept; no access outside an
 * object, no overflow, no shift too wide. Whatever comes, changes or goes moves `change`. What an
 * event puts in force, its own node has sent, in one set. prove_set: a set that takes effect has
 * the parts that its kind names and no others. prove_clock: no target jumps when the clock steps.
 * That its speed is within the limit is not proved: the arithmetic of live.c does not need it
 * (`live_at`).
 *
 * Assumed: two targets and two nodes stand for all, and those of an event are among them; the
 * .proof file shrinks their tables. What fx_atan2 returns is any angle. */
#include "firmware/nav/live_bus.c"

#include "prove.h"

enum { NODES = sizeof(((struct lm_live_bus *)0)->heard_us) / sizeof(uint64_t) };

struct lm_live_bus nondet_live_bus(void);
struct lm_bus_event nondet_event(void);

fx_bam_t fx_atan2(int32_t y, int32_t x)
{
    return nondet_u32();
}

static bool is_flag(bool flag)
{
    return flag == 0 || flag == 1;
}

static bool is_target_kept(const struct lm_live_target *t)
{
    return t->node < NODES && is_flag(t->is_there) && is_flag(t->has_height) &&
           (!t->is_there || (t->kind < LM_LIVE_KINDS && t->reckoning < LM_LIVE_RECKONINGS &&
                             fx_abs_u32((int32_t)t->position.latitude) <= FX_BAM_90 &&
                             fx_abs_u32(t->height_m_q6) <= LM_LIVE_HEIGHT_MAX_Q6 &&
                             fx_abs_u32(t->turn) <= LM_LIVE_TURN_MAX));
}

static bool is_kept(const struct lm_live_bus *b)
{
    uint32_t count = 0;
    bool are_kept = true;
    for (uint32_t i = 0; i < LM_LIVE_MAX; i++) {
        are_kept = are_kept && is_target_kept(&b->live.target[i]);
        count += b->live.target[i].is_there;
    }
    return are_kept && count == b->live.count && b->next < LM_LIVE_MAX;
}

static struct lm_live_bus a_bus(void)
{
    struct lm_live_bus b = nondet_live_bus();
    ASSUME(is_kept(&b));
    return b;
}

void prove_set(void)
{
    struct lm_live_bus b = a_bus();
    const struct lm_live_set set = b.set[0];
    const uint32_t sets = b.count.sets, refused = b.count.refused;
    ASSUME(set.node < NODES);
    finish_set(&b, 0);
    PROVE(b.count.sets + b.count.refused == sets + refused + 1 && b.set[0].parts == 0);
    PROVE(b.count.sets == sets || (set.parts == needed_of(&set) && (set.parts & ALWAYS) == ALWAYS));
}

void prove_take(void)
{
    struct lm_live_bus b = a_bus();
    const struct lm_bus_event event = nondet_event();
    ASSUME(event.service < LM_LIVE_MAX && event.node < NODES);
    const struct lm_live_set set = b.set[event.service];
    const uint32_t count = b.live.count, change = b.live.change, sets = b.count.sets;
    lm_live_bus_take(&b, &event, nondet_u64());
    PROVE(is_kept(&b) && b.live.count <= count + 1);
    PROVE(b.live.count == count || b.live.change != change);
    PROVE(b.count.sets == sets ||
          (b.live.change == change + 1 && b.live.target[event.service].is_there &&
           b.live.target[event.service].node == event.node &&
           (set.parts == 0 || set.node == event.node)));
    PROVE(event.field != LM_BUS_LIVE_CLEAR || event.channel != 0 || b.live.count == 0);
}

void prove_age(void)
{
    struct lm_live_bus b = a_bus();
    const uint32_t count = b.live.count, change = b.live.change;
    lm_live_bus_age(&b, nondet_u64());
    PROVE(is_kept(&b) && b.live.count <= count && b.live.change - change == count - b.live.count);
}

void prove_clock(void)
{
    struct lm_live_bus b = a_bus();
    const uint64_t before_us = b.live.target[0].motion_us, from_us = nondet_u64(),
                   to_us = nondet_u64();
    lm_live_bus_step_clock(&b, from_us, to_us);
    const uint64_t after_us = b.live.target[0].motion_us;
    PROVE(is_kept(&b));
    PROVE(before_us > from_us || after_us <= to_us);
    PROVE(after_us == 0 || to_us - after_us == from_us - before_us);
}
