/* Packed frames: a frame that ends before its field, and the bits that tell senders apart. What a
 * text table makes of itself is tested in tests/unit/host-sim/bus. */
#include "check.h"
#include "lm/bus.h"
#include "lm/bus_bitfield.h"
#include "lm/bus_filters.h"

#include <math.h>
#include <string.h>

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

/* ---- floats ---- */

/* An altitude in metres as a float of 32 or 64 bits with so many fraction bits. */
static struct lm_bus_row float_altitude(uint8_t count, uint8_t frac_bits)
{
    struct lm_bus_row row = altitude((struct lm_bus_bits){0, count}, true);
    row.packing.type = LM_BUS_FLOAT;
    row.packing.frac_bits = frac_bits;
    row.packing.multiplier = 1;
    row.packing.shift = (uint8_t)(frac_bits - 6);
    return row;
}

static enum lm_bus_outcome read_word(const struct lm_bus_row *row, uint64_t word,
                                     struct lm_bus_event *event)
{
    uint8_t data[8];
    memcpy(data, &word, sizeof data);
    const struct lm_bus_payload payload = {data, sizeof data, 0};
    return lm_bus_bitfield_read(row, &payload, event);
}

static enum lm_bus_outcome read_single(uint8_t frac_bits, float value, struct lm_bus_event *event)
{
    const struct lm_bus_row row = float_altitude(32, frac_bits);
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return read_word(&row, bits, event);
}

static enum lm_bus_outcome read_double(uint8_t frac_bits, double value, struct lm_bus_event *event)
{
    const struct lm_bus_row row = float_altitude(64, frac_bits);
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    return read_word(&row, bits, event);
}

TEST(a_float_that_is_no_number_or_too_large_is_refused)
{
    static const struct {
        double value;
        enum lm_bus_outcome outcome;
    } cases[] = {
        {NAN, LM_BUS_NOT_A_NUMBER},
        {INFINITY, LM_BUS_NOT_A_NUMBER},
        {-INFINITY, LM_BUS_NOT_A_NUMBER},
        {1e30, LM_BUS_OUT_OF_RANGE},
        {-1e30, LM_BUS_OUT_OF_RANGE},
        {4194304, LM_BUS_OUT_OF_RANGE}, /* 2^32 counts */
        {-4194304, LM_BUS_OUT_OF_RANGE},
        {70001, LM_BUS_OUT_OF_RANGE},
        {-1, LM_BUS_OUT_OF_RANGE},
        {70000, LM_BUS_VALUE},
        {0, LM_BUS_VALUE},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const int32_t expected =
            cases[i].outcome == LM_BUS_VALUE ? (int32_t)cases[i].value * 64 : 5;
        struct lm_bus_event event = {.value = 5};
        assert_int_equal(read_single(10, (float)cases[i].value, &event), cases[i].outcome);
        assert_int_equal(event.value, expected);
        event.value = 5;
        assert_int_equal(read_double(10, cases[i].value, &event), cases[i].outcome);
        assert_int_equal(event.value, expected);
    }
}

TEST(the_step_of_a_single_float_is_its_last_place)
{
    struct lm_bus_event event;
    assert_int_equal(read_single(10, 65536, &event), LM_BUS_VALUE);
    assert_int_equal(event.step, 0); /* 2^-7 m is half a count of altitude, rounded down */
    assert_int_equal(read_double(20, 3000, &event), LM_BUS_VALUE);
    assert_int_equal(event.step, 0); /* finer than any count */
    /* Degrees in counts of 2^-32 turn: the last place of 45 is 2^-18 degree. */
    struct lm_bus_row row = float_altitude(32, 20);
    row.field = LM_BUS_LATITUDE;
    row.low = -90;
    row.high = 90;
    row.packing.multiplier = 11930465; /* 2^32 / 360 */
    row.packing.shift = 20;
    assert_int_equal(read_word(&row, 0x42340000, &event), LM_BUS_VALUE);
    assert_in_range(event.value, (1u << 29) - 100, (1u << 29) + 100);
    assert_int_equal(event.step, 45);
}

/* Rows of a database's own table, whose factors nobody has chosen well. */
TEST(the_step_of_a_float_of_large_places_is_its_last_place_and_never_more_than_a_word)
{
    struct lm_bus_row row = float_altitude(32, 20);
    struct lm_bus_event event;
    row.field = LM_BUS_LATITUDE;
    row.low = -90;
    row.high = 90;
    row.packing.shift = 1;
    assert_int_equal(read_word(&row, 0x44800000, &event), LM_BUS_VALUE); /* 2^10, 2^30 counts */
    assert_int_equal(event.value, 1 << 29);
    assert_int_equal(event.step, 1 << (30 - 23 - 1)); /* of 24 places the last, halved */
    row.packing.multiplier = 1 << 29;
    row.packing.bias = -(1LL << 59); /* takes most of the number away */
    assert_int_equal(read_word(&row, 0x44800000, &event), LM_BUS_VALUE);
    assert_int_equal(event.value, 0);
    assert_int_equal(event.step, UINT32_MAX);
}

TEST(the_step_of_an_integer_is_its_resolution_and_never_more_than_a_word)
{
    static const struct {
        int32_t multiplier;
        uint8_t shift;
        uint32_t step;
    } cases[] = {{64, 0, 64},      {64, 1, 32}, {64, 7, 0},      {3, 1, 1},
                 {1 << 29, 30, 0}, {1, 31, 0},  {1 << 29, 40, 0}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct lm_bus_row row = altitude((struct lm_bus_bits){0, 8}, true);
        row.packing.multiplier = cases[i].multiplier;
        row.packing.shift = cases[i].shift;
        struct lm_bus_event event;
        assert_int_equal(read_word(&row, 1, &event), LM_BUS_VALUE);
        assert_int_equal(event.step, cases[i].step);
    }
}

TEST(the_integer_for_no_data_is_no_value_where_the_row_has_one)
{
    struct lm_bus_row row = altitude((struct lm_bus_bits){0, 8}, true);
    struct lm_bus_event event;
    row.packing.none = 0xff;
    assert_int_equal(read_word(&row, 0xff, &event), LM_BUS_VALUE);
    row.packing.has_none = true;
    assert_int_equal(read_word(&row, 0xff, &event), LM_BUS_NO_DATA);
    assert_int_equal(read_word(&row, 0xfe, &event), LM_BUS_VALUE);
}

TEST(a_signed_number_below_half_its_span_is_positive)
{
    struct lm_bus_row row = altitude((struct lm_bus_bits){0, 8}, true);
    row.packing.type = LM_BUS_SIGNED;
    row.low = -200;
    struct lm_bus_event event;
    assert_int_equal(read_word(&row, 0x7f, &event), LM_BUS_VALUE);
    assert_int_equal(event.value, 127 * 64);
    assert_int_equal(read_word(&row, 0x80, &event), LM_BUS_VALUE);
    assert_int_equal(event.value, -128 * 64);
}

/* ---- what no controller would hand over ---- */

static uint32_t outcome_of(struct lm_can_frame frame, enum lm_bus_outcome outcome)
{
    const struct lm_bus_row row = altitude((struct lm_bus_bits){0, 8}, false);
    const struct lm_bus_profile profile = {
        .rows = &row, .row_count = 1, .framing = LM_BUS_PACKED, .invalid_mask = 1u << 20};
    struct lm_bus bus;
    struct lm_bus_event events[LM_BUS_EVENTS];
    lm_bus_init(&bus, &profile);
    lm_bus_take(&bus, &frame, events);
    return bus.count.outcome[outcome];
}

TEST(a_frame_is_refused_for_its_form_and_counted)
{
    const struct lm_can_frame good = {.id = ID, .is_extended = true, .length = 8};
    struct lm_can_frame f = good;
    assert_int_equal(outcome_of(f, LM_BUS_VALUE), 1);
    f.length = 9;
    assert_int_equal(outcome_of(f, LM_BUS_BAD_LENGTH), 1);
    f = good, f.is_extended = false;
    assert_int_equal(outcome_of(f, LM_BUS_FOREIGN), 1);
    f = good, f.id = 1u << 29 | ID;
    assert_int_equal(outcome_of(f, LM_BUS_FOREIGN), 1);
    f = good, f.is_error = true;
    assert_int_equal(outcome_of(f, LM_BUS_NOT_DATA), 1);
    f = good, f.is_remote = true;
    assert_int_equal(outcome_of(f, LM_BUS_NOT_DATA), 1);
    f = good, f.id = ID + 1;
    assert_int_equal(outcome_of(f, LM_BUS_UNUSED), 1);
}

TEST(a_row_is_of_no_frame_with_a_short_identifier)
{
    const struct lm_bus_row row = altitude((struct lm_bus_bits){0, 8}, false);
    struct lm_can_frame frame = {.id = ID, .is_extended = true, .length = 8};
    assert_true(lm_bus_bitfield_is_row(&row, &frame));
    frame.is_extended = false;
    assert_false(lm_bus_bitfield_is_row(&row, &frame));
}

TEST(a_frame_gives_no_more_events_than_there_is_room_for)
{
    struct lm_bus_row rows[LM_BUS_EVENTS + 1];
    for (size_t i = 0; i < LM_BUS_EVENTS + 1; i++) {
        rows[i] = altitude((struct lm_bus_bits){(uint8_t)(4 * i), 4}, false);
    }
    const struct lm_bus_profile profile = {/* that lm_bus_profile_check would refuse */
                                           .rows = rows,
                                           .row_count = LM_BUS_EVENTS + 1,
                                           .framing = LM_BUS_PACKED};
    const struct lm_can_frame frame = {.id = ID, .is_extended = true, .length = 8};
    struct lm_bus bus;
    struct lm_bus_event events[LM_BUS_EVENTS + 1] = {[LM_BUS_EVENTS] = {.value = 1234}};
    lm_bus_init(&bus, &profile);
    assert_int_equal(lm_bus_take(&bus, &frame, events), LM_BUS_EVENTS);
    assert_int_equal(events[LM_BUS_EVENTS - 1].row, LM_BUS_EVENTS - 1);
    assert_int_equal(events[LM_BUS_EVENTS].value, 1234);
}

TEST(a_controllers_filters_let_pass_what_the_rows_read_and_each_once)
{
    struct lm_bus_row rows[3];
    for (int i = 0; i < 3; i++) {
        rows[i] = altitude((struct lm_bus_bits){(uint8_t)(8 * i), 8}, false);
    }
    rows[2].packing.mask = ALL_ID_BITS & ~3u; /* the same identifier, less of it */
    const struct lm_bus_profile profile = {.rows = rows, .row_count = 3, .framing = LM_BUS_PACKED};
    struct lm_can_filter filters[LM_BUS_FILTERS_MAX];
    assert_int_equal(lm_bus_filters(&profile, filters), 2);
    for (int i = 0; i < 2; i++) {
        assert_true(filters[i].is_extended && filters[i].id == ID);
    }
    assert_int_equal(filters[0].mask, ALL_ID_BITS);
    assert_int_equal(filters[1].mask, ALL_ID_BITS & ~3u);
}
