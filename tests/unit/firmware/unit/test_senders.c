/* What the glass, the BIT page and the fault log say of a sender that is not what it should be. */
#include "bus_frames.h"
#include "check.h"
#include "glass_text.h"
#include "height_rows.h"
#include "lm/bit.h"
#include "unit_rig.h"

#include <stdio.h>
#include <string.h>

enum { ROW_BAD = 6 };

/* Frames of pitch, beside the flight's, that are given to the unit's decoder at once. */
static void say(struct rig *r, uint8_t node, uint8_t code, float value)
{
    struct lm_can_frame frame =
        bus_frame(311, LM_CANAS_FLOAT, code, bus_float_bits(value), r->now_us);
    struct lm_bus_event events[LM_BUS_EVENTS];
    frame.data[0] = node;
    const uint32_t count = lm_bus_take(&r->unit.bus, &frame, events);
    for (uint32_t i = 0; i < count; i++) {
        lm_nav_take(&r->unit.nav, &events[i]);
    }
}

static struct rig *start(void)
{
    struct rig *r = make_rig();
    assert_int_equal(lm_unit_init(&r->unit, &r->board.lent), LM_OK);
    return r;
}

static bool warns(const struct rig *r, const char *words)
{
    const struct lm_surface glass = glass_of(r);
    return glass_find(&glass, words, r->unit.palette.warning, r->unit.palette.ink, NULL);
}

TEST(a_flight_without_fault_has_no_flag)
{
    struct rig *r = start();
    run(r, 3);
    assert_int_equal(r->unit.flags & LM_FLAG_SENDER, 0);
    assert_int_equal(lm_sender_counts(&r->unit).sum, 0);
    assert_string_equal(lm_sender_fault(&r->unit).words, "");
    free_rig(r);
}

TEST(a_rival_is_said_on_the_glass_for_three_seconds_and_kept_in_the_log)
{
    struct rig *r = start();
    run(r, 1);
    say(r, 9, 1, 0);
    say(r, 77, 1, 0);
    const uint32_t rivals = r->unit.nav.rivals;
    assert_true(rivals >= 1);
    run(r, 0.5);
    assert_int_equal(r->unit.flags & LM_FLAG_SENDER, LM_FLAG_SENDER);
    assert_true(warns(r, "SENDER") && warns(r, "RIVAL NODE 77"));
    bool is_logged = false;
    for (uint32_t age = 0; lm_fault_log_at(&r->unit.faults, age); age++) {
        const uint32_t flag = lm_fault_log_at(&r->unit.faults, age)->flag;
        is_logged = is_logged || strcmp(lm_flag_word(flag), "SENDER") == 0;
    }
    assert_true(is_logged);
    char row[40];
    snprintf(row, sizeof row, "SENDERS  %u", lm_sender_counts(&r->unit).sum);
    assert_non_null(strstr(lm_bit_row(&r->unit, ROW_BAD).words, row));
    run(r, 3);
    assert_int_equal(r->unit.flags & LM_FLAG_SENDER, 0);
    free_rig(r);
}

TEST(a_stuck_sender_is_named)
{
    struct rig *r = start();
    run(r, 1);
    for (uint8_t code = 0; code < 3; code++) {
        say(r, 9, code, 0);
    }
    for (int i = 0; i < 12; i++) {
        say(r, 9, 3, 0);
    }
    assert_true(r->unit.bus.canas.count.stuck > 0);
    run(r, 0.2);
    assert_true(warns(r, "SENDER") && warns(r, "STUCK NODE 9"));
    free_rig(r);
}

TEST(a_stuck_sender_of_a_further_table_is_named_too)
{
    static const struct lm_bus_profile profile = {
        .name = "more", .rows = height_rows, .row_count = 1};
    struct rig *r = make_rig();
    r->board.lent.tables[1] = r->board.lent.tables[0] = (struct lm_board_table){&profile, 1};
    assert_int_equal(lm_unit_init(&r->unit, &r->board.lent), LM_OK);
    run(r, 1);
    for (uint8_t code = 0; code < 15; code++) {
        struct lm_bus_event events[LM_BUS_EVENTS];
        struct lm_can_frame frame =
            bus_frame(700, LM_CANAS_FLOAT, code < 3 ? code : 3, bus_float_bits(1000), r->now_us);
        frame.data[0] = 31;
        lm_bus_take(&r->unit.more[1], &frame, events);
    }
    run(r, 0.2);
    assert_true(warns(r, "SENDER") && warns(r, "STUCK NODE 31"));
    free_rig(r);
}

TEST(senders_that_differ_are_said)
{
    struct rig *r = start();
    run(r, 1);
    const struct lm_bus_event first = {.value = 0,
                                       .time_us = r->now_us,
                                       .stale_ms = 300,
                                       .dead_ms = 2000,
                                       .field = LM_BUS_TRUE_ALTITUDE,
                                       .priority = 8,
                                       .node = 1};
    struct lm_bus_event second = first;
    second.value = 500 * 64;
    second.priority = 9;
    lm_nav_take(&r->unit.nav, &first);
    lm_nav_take(&r->unit.nav, &second);
    run(r, 0.2);
    assert_true(warns(r, "SENDER") && warns(r, "SENDERS DIFFER"));
    free_rig(r);
}

TEST(refused_nodes_are_counted_and_no_fault)
{
    static const uint8_t nobody[LM_BUS_NODE_BYTES] = {0};
    struct rig *r = make_rig();
    r->board.lent.bus_nodes = nobody;
    assert_int_equal(lm_unit_init(&r->unit, &r->board.lent), LM_OK);
    run(r, 1);
    assert_true(lm_sender_counts(&r->unit).refused > 50);
    assert_int_equal(r->unit.flags & LM_FLAG_SENDER, 0);
    assert_int_equal(r->unit.flags & LM_FLAG_NAV_DEAD, LM_FLAG_NAV_DEAD);
    free_rig(r);
}
