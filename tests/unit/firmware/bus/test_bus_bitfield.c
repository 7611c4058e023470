/* Packed frames: a frame that ends before its field, and the bits that tell senders apart. What a
 * text table makes of itself is tested in tests/unit/host-sim/bus. */
#include "check.h"
#include "lm/bus.h"
#include "lm/bus_bitfield.h"

enum { ID = 0x100, ID_BITS = 29, ALL_ID_BITS = 0x1fffffff };

/* An unsigned altitude, metres. */
static struct lm_bus_row altitude(struct lm_bus_bits bits, bool is_little_endian)
{
    return (struct lm_bus_row){.name = "altitude",
                               .id = ID,
                               .field = LM_BUS_TRUE_ALTITUDE,
                               .stale_ms = 300,
                               .dead_ms = 5000,
                               .period_us = 100000,
                               .low = 0,
                               .high = 70000,
                               .packing = {.mask = ALL_ID_BITS,
                                           .bits = bits,
                                           .is_little_endian = is_little_endian,
                                           .multiplier = 64}};
}

TEST(a_frame_that_ends_within_its_field_has_a_bad_length)
{
    static const struct {
        struct lm_bus_bits bits;
        uint8_t length_least;
    } fields[] = {{{0, 8}, 1}, {{0, 9}, 2}, {{7, 1}, 1}, {{8, 16}, 3}, {{20, 12}, 4}, {{57, 7}, 8}};
    for (size_t i = 0; i < 2 * sizeof fields / sizeof *fields; i++) {
        const struct lm_bus_row row = altitude(fields[i / 2].bits, i % 2 == 0);
        for (uint8_t length = 0; length <= 8; length++) {
            const struct lm_can_frame frame = {.id = ID, .is_extended = true, .length = length};
            const bool is_whole = length >= fields[i / 2].length_least;
            const struct lm_bus_payload payload = {frame.data, length, 0};
            struct lm_bus_event event = {.value = 1234};
            assert_int_equal(lm_bus_bitfield_read(&row, &payload, &event),
                             is_whole ? LM_BUS_VALUE : LM_BUS_BAD_LENGTH);
            assert_int_equal(event.value, is_whole ? 0 : 1234);
        }
    }
}

/* The channel of a frame with this identifier, its senders told apart by the bits of `mask`. */
static unsigned channel_of(uint32_t id, uint32_t mask)
{
    struct lm_bus_row row = altitude((struct lm_bus_bits){0, 8}, false);
    row.packing.mask = ALL_ID_BITS & ~mask;
    row.id = id & row.packing.mask;
    const struct lm_bus_profile profile = {
        .rows = &row, .row_count = 1, .framing = LM_BUS_PACKED, .channel_mask = mask};
    const struct lm_can_frame frame = {.id = id, .is_extended = true, .length = 8};
    struct lm_bus bus;
    struct lm_bus_event events[LM_BUS_EVENTS];
    lm_bus_init(&bus, &profile);
    assert_int_equal(lm_bus_take(&bus, &frame, events), 1);
    return events[0].channel;
}

TEST(every_bit_of_an_identifier_can_tell_senders_apart)
{
    for (uint32_t bit = 0; bit < ID_BITS; bit++) {
        const uint32_t mask = (uint32_t)1 << bit, others = ALL_ID_BITS & ~mask;
        assert_int_equal(channel_of(0, mask), 0);
        assert_int_equal(channel_of(others, mask), 0);
        assert_int_equal(channel_of(mask, mask), 1);
    }
    /* The lowest bit of the mask counts 1, whatever lies between it and the next. */
    const uint32_t mask = 1u << 28 | 1u << 9 | 1u << 3;
    assert_int_equal(channel_of(1u << 3, mask), 1);
    assert_int_equal(channel_of(1u << 9, mask), 2);
    assert_int_equal(channel_of(1u << 28, mask), 4);
    assert_int_equal(channel_of(ALL_ID_BITS, mask), 7);
}
