/* Senders that are not what they should be: a message code that stands still, and a node that is
 * not on the list. */
#include "bus_frames.h"
#include "check.h"
#include "lm/bus.h"

/* A value of pitch from a node. */
static enum lm_bus_outcome say(struct lm_bus *b, uint8_t node, uint8_t code, float value)
{
    struct lm_bus_event event = {0};
    struct lm_can_frame frame = bus_frame(311, LM_CANAS_FLOAT, code, bus_float_bits(value), 1000);
    frame.data[0] = node;
    return bus_take(b, &frame, &event);
}

TEST(a_sender_that_stops_counting_is_stuck_and_still_heard)
{
    struct lm_bus b;
    lm_bus_init(&b, &lm_bus_canas17);
    for (int i = 0; i < 20; i++) {
        assert_int_equal(say(&b, 7, (uint8_t)i, 1), LM_BUS_VALUE);
    }
    for (int i = 1; i < 12; i++) { /* code 19 came once */
        assert_int_equal(say(&b, 7, 19, (float)i), LM_BUS_VALUE);
        assert_int_equal(b.canas.count.stuck, i < LM_CANAS_STILL - 1 ? 0 : i - LM_CANAS_STILL + 2);
    }
    assert_int_equal(b.canas.stuck_node, 7);
    const uint32_t before = b.canas.count.stuck;
    assert_int_equal(say(&b, 7, 20, 1), LM_BUS_VALUE);
    assert_int_equal(b.canas.count.stuck, before);
}

TEST(a_sender_that_never_counted_is_no_fault)
{
    struct lm_bus b;
    lm_bus_init(&b, &lm_bus_canas17);
    for (int i = 0; i < 50; i++) {
        assert_int_equal(say(&b, 7, 0, 1), LM_BUS_VALUE);
    }
    assert_int_equal(b.canas.count.stuck, 0);
    /* Another node's code says nothing of this one's. */
    assert_int_equal(say(&b, 8, 5, 1), LM_BUS_VALUE);
    for (int i = 0; i < 50; i++) {
        assert_int_equal(say(&b, 8, 5, 1), LM_BUS_VALUE);
    }
    assert_int_equal(b.canas.count.stuck, 0);
}

TEST(a_node_that_is_not_on_the_list_leaves_no_trace)
{
    static const uint8_t nodes[LM_BUS_NODE_BYTES] = {[0] = 1 << 7, [31] = 1 << 7}; /* 7 and 255 */
    struct lm_bus b;
    lm_bus_init(&b, &lm_bus_canas17);
    lm_bus_hear_only(&b, nodes);
    for (int node = 1; node < 256; node++) {
        const bool is_heard = node == 7 || node == 255;
        assert_int_equal(say(&b, (uint8_t)node, (uint8_t)node, 1),
                         is_heard ? LM_BUS_VALUE : LM_BUS_NODE_REFUSED);
    }
    assert_int_equal(b.count.outcome[LM_BUS_NODE_REFUSED], 253);
    assert_int_equal(b.canas.count.sequence_breaks, 0);
    lm_bus_hear_only(&b, NULL);
    assert_int_equal(say(&b, 9, 0, 1), LM_BUS_VALUE);
}

TEST(the_node_of_a_packed_frame_is_its_channel)
{
    static const uint8_t nodes[LM_BUS_NODE_BYTES] = {[2] = 1 << 1}; /* 17 */
    const struct lm_bus_row row = {
        .id = 0x1f80100,
        .field = LM_BUS_TRUE_ALTITUDE,
        .high = 1000,
        .packing = {.mask = 0x1ffff00, .bits = {0, 8}, .multiplier = 64}};
    struct lm_bus_profile profile = {
        .rows = &row, .row_count = 1, .framing = LM_BUS_PACKED, .channel_mask = 0xff};
    struct lm_bus b;
    struct lm_bus_event events[LM_BUS_EVENTS];
    lm_bus_init(&b, &profile);
    lm_bus_hear_only(&b, nodes);
    for (uint32_t source = 0; source < 256; source++) {
        const struct lm_can_frame frame = {
            .id = 0x1f80100 | source, .is_extended = true, .length = 8};
        assert_int_equal(lm_bus_take(&b, &frame, events), source == 17);
    }
    assert_int_equal(b.count.outcome[LM_BUS_NODE_REFUSED], 255);
}
