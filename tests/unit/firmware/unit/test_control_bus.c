/* Controls on the bus: a unit tells what its operator does, and another one that may obey does the
 * same, so that both show the same. */
#include "check.h"
#include "lm/canas.h"
#include "lm/canas_control.h"
#include "unit_rig.h"

enum { NODE = 20, HEARD_MAX = 256 };

/* The rig's bus, with frames of somebody else before its own, and what was sent. */
struct wire {
    int (*receive)(void *ctx, struct lm_can_frame *frame);
    void *ctx;
    struct lm_can_frame sent[HEARD_MAX], waiting[HEARD_MAX];
    uint32_t sent_count, waiting_next, waiting_count;
};

static int hear(void *ctx, struct lm_can_frame *frame)
{
    struct wire *w = ctx;
    if (w->waiting_next != w->waiting_count) {
        *frame = w->waiting[w->waiting_next++];
        return 1;
    }
    return w->receive(w->ctx, frame);
}

static int keep(void *ctx, const struct lm_can_frame *frame)
{
    struct wire *w = ctx;
    const bool is_control = frame->id >= LM_CONTROL_ID && frame->id < LM_CONTROL_ID + 20;
    if (is_control) {
        assert_in_range(w->sent_count, 0, HEARD_MAX - 1);
        w->sent[w->sent_count++] = *frame;
    }
    return LM_OK;
}

static struct rig *make(struct wire *w, uint8_t node, bool is_obeying)
{
    struct rig *r = make_rig();
    *w = (struct wire){.receive = r->board.can.receive, .ctx = r->board.can.ctx};
    r->board.can = (struct lm_can){.ctx = w, .receive = hear, .send = keep};
    r->board.lent.bus_node = node;
    r->board.lent.tells_reports = true;
    r->board.lent.obeys_controls = is_obeying;
    assert_int_equal(lm_unit_init(&r->unit, &r->board.lent), LM_OK);
    return r;
}

/* One step of both. What the first says, the second hears in its next step. */
static void step_both(struct rig *first, struct wire *from, struct rig *second, struct wire *to)
{
    run(first, STEP_US * 1e-6);
    to->waiting_next = to->waiting_count = 0;
    for (uint32_t i = 0; i < from->sent_count; i++) {
        to->waiting[to->waiting_count] = from->sent[i];
        to->waiting[to->waiting_count++].time_us = second->now_us;
    }
    from->sent_count = 0;
    run(second, STEP_US * 1e-6);
}

TEST(a_display_that_obeys_has_the_settings_of_the_one_that_is_operated)
{
    static struct wire from, to;
    struct rig *first = make(&from, NODE, false), *second = make(&to, NODE + 1, true);
    const struct lm_control acts[] = {range_10,
                                      lm_control_button(true, 1),
                                      lm_control_button(false, 1),
                                      lm_control_button(true, 21),
                                      lm_control_button(false, 21),
                                      {.kind = LM_CONTROL_GAIN, .gain_db = -4},
                                      lm_control_knob(300),
                                      patch_here,
                                      {.kind = LM_CONTROL_FREEZE, .is_frozen = true},
                                      lm_control_slew(1000, 0)};
    const uint32_t count = sizeof acts / sizeof *acts;
    for (uint32_t i = 0; i < 1500; i++) {
        if (i >= 800 && i % 50 == 0 && i / 50 - 16 < count) {
            command(first, acts[i / 50 - 16]);
        }
        step_both(first, &from, second, &to);
    }
    const struct lm_page *a = &first->unit.page, *b = &second->unit.page;
    assert_int_equal(a->picture, LM_PICTURE_PATCH);
    assert_int_equal(a->picture, b->picture);
    assert_int_equal(a->range_index, b->range_index);
    assert_int_equal(a->gain_db, b->gain_db);
    assert_int_equal(a->is_frozen, b->is_frozen);
    assert_memory_equal(&a->palette, &b->palette, sizeof a->palette);
    assert_int_equal(second->unit.cursor.slew_x, 1000);
    assert_int_equal(first->unit.control_bus.count.told, count);
    assert_int_equal(second->unit.control_bus.count.heard, count);
    assert_int_equal(second->unit.control_bus.count.told, 0); /* or two would never end */
    free_rig(first);
    free_rig(second);
}

TEST(a_display_that_may_not_obey_counts_and_does_nothing)
{
    static struct wire from, to;
    struct rig *first = make(&from, NODE, false), *second = make(&to, NODE + 1, false);
    run(first, 1.5);
    run(second, 1.5);
    const uint32_t range = second->unit.page.range_index;
    command(first, range_10);
    step_both(first, &from, second, &to);
    step_both(first, &from, second, &to);
    assert_int_not_equal(first->unit.page.range_index, range);
    assert_int_equal(second->unit.page.range_index, range);
    assert_in_range(second->unit.control_bus.count.refused, 1, 2);
    free_rig(first);
    free_rig(second);
}

TEST(a_control_that_the_unit_refused_is_not_told)
{
    static struct wire from;
    struct rig *r = make(&from, NODE, false);
    command(r, (struct lm_control){.kind = LM_CONTROL_GAIN, .gain_db = 99});
    run(r, 0.1);
    assert_int_equal(r->unit.count.commands_refused, 1);
    assert_int_equal(from.sent_count, 0);
    free_rig(r);
}

TEST(the_step_that_is_told_is_the_one_that_acted)
{
    static struct wire from;
    struct rig *r = make(&from, NODE, false);
    run(r, 1);
    const uint64_t at_us = r->now_us;
    command(r, range_10);
    run(r, 0.1);
    assert_int_equal(from.sent_count, 2);
    const uint8_t *d = from.sent[0].data + 4;
    assert_int_equal((uint32_t)d[0] << 24 | (uint32_t)d[1] << 16 | (uint32_t)d[2] << 8 | d[3],
                     at_us);
    free_rig(r);
}

/* Eight a step from each source; what is more waits for the next step, and nothing is lost. */
TEST(a_burst_of_controls_is_taken_eight_a_step)
{
    static struct wire from, to;
    struct rig *first = make(&from, NODE, false), *second = make(&to, NODE + 1, true);
    run(first, 1);
    run(second, 1);
    from.sent_count = 0;
    for (int32_t db = 1; db <= 10; db++) {
        command(first, (struct lm_control){.kind = LM_CONTROL_GAIN, .gain_db = db});
    }
    run(first, STEP_US * 1e-6);
    assert_int_equal(first->unit.page.gain_db, 8);
    run(first, STEP_US * 1e-6);
    assert_int_equal(first->unit.page.gain_db, 10);
    run(first, 0.1);
    for (uint32_t i = 0; i < from.sent_count; i++) {
        to.waiting[to.waiting_count] = from.sent[i];
        to.waiting[to.waiting_count++].time_us = second->now_us;
    }
    run(second, STEP_US * 1e-6);
    assert_int_equal(second->unit.page.gain_db, 8);
    run(second, STEP_US * 1e-6);
    assert_int_equal(second->unit.page.gain_db, 10);
    assert_int_equal(second->unit.control_bus.count.heard, 10);
    free_rig(first);
    free_rig(second);
}
