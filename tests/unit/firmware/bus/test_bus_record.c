/* The record of a bus table: what is written is read back, and what breaks a promise is refused. */
#include "check.h"
#include "fx/crc32c.h"
#include "lm/bus.h"
#include "lm/bus_filters.h"
#include "lm/bus_record.h"
#include "lm/status.h"

#include <string.h>

enum { AT_VERSION = 4, AT_BYTES = 6, AT_NAME = 8, AT_FRAMING = 28, AT_ROWS = 29, AT_RESERVED = 30 };

static uint8_t record[LM_BUS_RECORD_BYTES_MAX];
static struct lm_bus_table table;

static void seal(uint32_t bytes)
{
    const uint32_t crc = fx_crc32c(0, record + AT_VERSION, bytes - AT_VERSION);
    memcpy(record, &crc, sizeof crc);
}

static void assert_same_row(const struct lm_bus_row *a, const struct lm_bus_row *b)
{
    struct lm_bus_row named = *b;
    named.name = a->name;
    assert_string_equal(a->name, lm_bus_fields[a->field].name);
    assert_true(named.id == a->id && named.field == a->field && named.priority == a->priority);
    assert_true(named.stale_ms == a->stale_ms && named.dead_ms == a->dead_ms);
    assert_true(named.period_us == a->period_us && named.low == a->low && named.high == a->high);
    assert_true(named.types == a->types && named.per_unit == a->per_unit);
    const struct lm_bus_packing *p = &a->packing, *q = &b->packing;
    assert_true(p->mask == q->mask && p->bits.first == q->bits.first);
    assert_true(p->bits.count == q->bits.count && p->match.first == q->match.first);
    assert_true(p->match.count == q->match.count && p->match_value == q->match_value);
    assert_true(p->type == q->type && p->is_little_endian == q->is_little_endian);
    assert_true(p->has_none == q->has_none && p->none == q->none);
    assert_true(p->multiplier == q->multiplier && p->shift == q->shift);
    assert_true(p->frac_bits == q->frac_bits && p->bias == q->bias);
}

TEST(every_built_in_profile_is_read_back_as_it_was_written)
{
    for (const struct lm_bus_named_profile *n = lm_bus_profiles; n->name != NULL; n++) {
        const struct lm_bus_profile *p = n->profile;
        const uint32_t bytes = lm_bus_pack(p, record);
        assert_int_equal(bytes, LM_BUS_RECORD_HEAD_BYTES + p->row_count * LM_BUS_RECORD_ROW_BYTES);
        assert_int_equal(lm_bus_unpack(&table, record, bytes), LM_OK);
        assert_string_equal(table.profile.name, p->name);
        assert_int_equal(table.profile.row_count, p->row_count);
        assert_int_equal(table.profile.framing, p->framing);
        assert_int_equal(table.profile.are_types_assumed, p->are_types_assumed);
        assert_int_equal(table.profile.channel_mask, p->channel_mask);
        assert_int_equal(table.profile.invalid_mask, p->invalid_mask);
        for (uint32_t i = 0; i < p->row_count; i++) {
            assert_same_row(&table.profile.rows[i], &p->rows[i]);
        }
    }
}

/* Offsets of docs/FORMATS.md, read by hand. */
TEST(the_bytes_stand_where_the_format_says)
{
    (void)lm_bus_pack(&lm_bus_canas17, record);
    assert_int_equal(record[AT_VERSION], 1);
    assert_int_equal(record[AT_VERSION + 1], 0);
    assert_memory_equal(record + AT_NAME, "canas17", 8);
    assert_int_equal(record[AT_FRAMING], 0);
    assert_int_equal(record[AT_ROWS], lm_bus_canas17.row_count);
    const uint8_t *row = record + 40; /* GPS latitude */
    assert_memory_equal(row, "latitude\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0", 24);
    assert_int_equal(row[24] | row[25] << 8, 1036);
    assert_int_equal(row[32] | row[33] << 8 | row[34] << 16, 100000);
    assert_int_equal(row[36] | row[37] << 8, 300);
    assert_int_equal(row[38] | row[39] << 8, 2000);
    assert_int_equal((int8_t)row[40], -90);
    assert_int_equal(row[44], 90);
    (void)lm_bus_pack(&lm_bus_xcsoar, record);
    assert_int_equal(record[AT_FRAMING], 1);
    (void)lm_bus_pack(&lm_bus_generic, record);
    assert_int_equal(record[AT_FRAMING], 2);
}

TEST(every_field_is_named_in_the_room_that_a_record_has)
{
    for (int i = 0; i < LM_BUS_FIELDS; i++) {
        assert_in_range(strlen(lm_bus_fields[i].name), 1, 23);
    }
}

TEST(a_flipped_bit_and_a_lost_byte_are_noticed)
{
    const uint32_t bytes = lm_bus_pack(&lm_bus_generic, record);
    for (uint32_t bit = 0; bit < 8 * bytes; bit++) {
        record[bit / 8] ^= (uint8_t)(1u << bit % 8);
        assert_true(lm_bus_unpack(&table, record, bytes) < 0);
        record[bit / 8] ^= (uint8_t)(1u << bit % 8);
    }
    for (uint32_t less = 1; less <= bytes; less++) {
        assert_true(lm_bus_unpack(&table, record, bytes - less) < 0);
    }
    assert_int_equal(lm_bus_unpack(&table, record, bytes), LM_OK);
}

/* The status after one byte of a sealed record was set. */
static int status_with(uint32_t at, uint8_t value)
{
    const uint32_t bytes = lm_bus_pack(&lm_bus_canas17, record);
    record[at] = value;
    seal(bytes);
    return lm_bus_unpack(&table, record, bytes);
}

TEST(each_kind_of_foreign_record_has_its_own_answer)
{
    assert_int_equal(status_with(AT_VERSION, 2), LM_ERR_VERSION);
    assert_int_equal(status_with(AT_BYTES, 0), LM_ERR_CORRUPT);
    assert_int_equal(status_with(AT_ROWS, 1), LM_ERR_CORRUPT);
    assert_int_equal(status_with(AT_RESERVED, 1), LM_ERR_CORRUPT);
    assert_int_equal(status_with(AT_NAME + LM_BUS_PROFILE_NAME_SIZE - 1, 'x'), LM_ERR_CORRUPT);
    assert_int_equal(status_with(AT_FRAMING, 3), LM_ERR_TABLE);
    assert_int_equal(status_with(LM_BUS_RECORD_HEAD_BYTES, 'x'), LM_ERR_TABLE); /* "xatitude" */
    assert_int_equal(status_with(LM_BUS_RECORD_HEAD_BYTES + 23, 'x'), LM_ERR_TABLE);  /* its pad */
    assert_int_equal(status_with(LM_BUS_RECORD_HEAD_BYTES + 81, 0x80), LM_ERR_TABLE); /* flags */
    assert_int_equal(status_with(LM_BUS_RECORD_HEAD_BYTES + 84, 1), LM_ERR_CORRUPT);
    assert_int_equal(status_with(AT_NAME, 'C'), LM_OK);
}

TEST(a_record_of_more_rows_than_a_table_has_is_refused)
{
    enum { ROWS = LM_BUS_ROWS_MAX + 1 };
    static uint8_t many[LM_BUS_RECORD_HEAD_BYTES + (size_t)ROWS * LM_BUS_RECORD_ROW_BYTES];
    const uint16_t bytes = sizeof many;
    (void)lm_bus_pack(&lm_bus_canas17, record);
    memcpy(many, record, LM_BUS_RECORD_HEAD_BYTES);
    for (size_t i = 0; i < ROWS; i++) {
        memcpy(many + LM_BUS_RECORD_HEAD_BYTES + i * LM_BUS_RECORD_ROW_BYTES,
               record + LM_BUS_RECORD_HEAD_BYTES, LM_BUS_RECORD_ROW_BYTES);
    }
    many[AT_ROWS] = ROWS;
    memcpy(many + AT_BYTES, &bytes, sizeof bytes);
    const uint32_t crc = fx_crc32c(0, many + AT_VERSION, sizeof many - AT_VERSION);
    memcpy(many, &crc, sizeof crc);
    assert_int_equal(lm_bus_unpack(&table, many, sizeof many), LM_ERR_TABLE);
}

TEST(a_name_without_room_is_cut_and_ends)
{
    struct lm_bus_profile p = lm_bus_canas17;
    char name[LM_BUS_PROFILE_NAME_SIZE + 4];
    memset(name, 'n', sizeof name);
    name[sizeof name - 1] = '\0';
    p.name = name;
    assert_int_equal(lm_bus_unpack(&table, record, lm_bus_pack(&p, record)), LM_OK);
    assert_int_equal(strlen(table.profile.name), LM_BUS_PROFILE_NAME_SIZE - 1);
    assert_memory_equal(table.profile.name, name, LM_BUS_PROFILE_NAME_SIZE - 1);
}

/* ---- the check ---- */

static const struct lm_bus_row of_canas = {.name = "pitch",
                                           .id = 311,
                                           .field = LM_BUS_PITCH,
                                           .stale_ms = 100,
                                           .dead_ms = 1000,
                                           .period_us = 12500,
                                           .low = -90,
                                           .high = 90,
                                           .types = 1u << LM_CANAS_FLOAT,
                                           .per_unit = 1};
static const struct lm_bus_row of_packed = {
    .name = "altitude",
    .id = 0x100,
    .field = LM_BUS_TRUE_ALTITUDE,
    .stale_ms = 300,
    .dead_ms = 5000,
    .period_us = 100000,
    .low = 0,
    .high = 9000,
    .packing = {.mask = 0x1fffffff, .bits = {16, 16}, .multiplier = 1 << 29, .shift = 23}};

/* A row of each framing, and the same with one thing changed by `spoil`. */
static int check_spoilt(uint8_t framing, void (*spoil)(struct lm_bus_row *row), uint32_t *at)
{
    struct lm_bus_row rows[2];
    rows[0] = rows[1] = framing == LM_BUS_PACKED ? of_packed : of_canas;
    rows[1].priority = 1;
    rows[1].id++;
    spoil(&rows[1]);
    const struct lm_bus_profile p = {
        .name = "p", .rows = rows, .row_count = 2, .framing = framing, .are_types_assumed = true};
    return lm_bus_profile_check(&p, at);
}

#define SPOIL(name, change)                                                                        \
    static void name(struct lm_bus_row *row)                                                       \
    {                                                                                              \
        change;                                                                                    \
    }
SPOIL(nothing, (void)row)
SPOIL(unknown_field, row->field = LM_BUS_FIELDS)
SPOIL(empty_range, row->low = row->high)
SPOIL(low_range, row->low = -100001)
SPOIL(high_range, row->high = 100001)
SPOIL(past_the_pole, (row->field = LM_BUS_LATITUDE, row->dead_ms = 2000, row->high = 91))
SPOIL(past_the_south, (row->field = LM_BUS_STEERPOINT_LATITUDE, row->low = -91))
SPOIL(half_turn, (row->field = LM_BUS_YAW_RATE, row->low = -180))
SPOIL(widest_latitude, (row->field = LM_BUS_LATITUDE, row->dead_ms = 2000, row->high = 90))
SPOIL(widest_turn, (row->field = LM_BUS_YAW_RATE, row->low = -179, row->high = 179))
SPOIL(quick_period, row->period_us = 999)
SPOIL(slow_period, row->period_us = row->stale_ms * 1000u + 1)
SPOIL(dead_first, row->dead_ms = row->stale_ms)
SPOIL(dead_late, row->dead_ms = 60001)
SPOIL(coordinate_late, (row->field = LM_BUS_LATITUDE, row->dead_ms = 4001))
SPOIL(same_priority, row->priority = 0)
SPOIL(no_type, row->types = 0)
SPOIL(bits_type, row->types = 1u << LM_CANAS_BLONG)
SPOIL(two_types, row->types = 1u << LM_CANAS_FLOAT | 1u << LM_CANAS_SHORT2)
SPOIL(low_id, row->id = 199)
SPOIL(high_id, row->id = 2000)
SPOIL(same_id, row->id--)
SPOIL(no_unit, row->per_unit = 0)
SPOIL(many_units, row->per_unit = 1000000001)
SPOIL(no_mask, row->packing.mask = row->id = 0)
SPOIL(wide_mask, row->packing.mask = 0x3fffffff)
SPOIL(id_outside, row->packing.mask = 0x100)
SPOIL(no_bits, row->packing.bits.count = 0)
SPOIL(many_bits, (row->packing.bits = (struct lm_bus_bits){0, 33}))
SPOIL(late_bits, row->packing.bits.first = 49)
SPOIL(far_bits, row->packing.bits.first = 65535)
SPOIL(short_float, row->packing.type = LM_BUS_FLOAT)
SPOIL(unknown_type, row->packing.type = 3)
SPOIL(wide_match, row->packing.match.count = 9)
SPOIL(late_match, (row->packing.match = (struct lm_bus_bits){60, 5}))
SPOIL(large_match, row->packing.match_value = 1)
SPOIL(large_none, (row->packing.has_none = true, row->packing.none = 0x10000))
SPOIL(no_factor, row->packing.multiplier = 0)
SPOIL(large_factor, row->packing.multiplier = 1 << 30)
SPOIL(no_shift, row->packing.shift = 0)
SPOIL(large_shift, row->packing.shift = 61)
SPOIL(large_places, row->packing.frac_bits = 61)
SPOIL(large_bias, row->packing.bias = 1LL << 61)
SPOIL(low_bias, row->packing.bias = -(1LL << 61))
SPOIL(part_of_a_set, row->field = LM_BUS_RAIN_RATE)
SPOIL(part_of_a_target, (row->field = LM_BUS_LIVE_LATITUDE, row->high = 90))
SPOIL(sea_state, row->field = LM_BUS_SEA_STATE)
SPOIL(last_field, row->field = LM_BUS_FIELDS - 1)
SPOIL(crossed_bits, (row->packing.is_fast = true, row->packing.bits = (struct lm_bus_bits){7, 58}))
SPOIL(float_none, (row->packing.type = LM_BUS_FLOAT,
                   row->packing.bits = (struct lm_bus_bits){0, 32}, row->packing.has_none = true))
SPOIL(float_of_no_size,
      (row->packing.type = LM_BUS_FLOAT, row->packing.bits = (struct lm_bus_bits){0, 48}))
SPOIL(none_of_a_word, (row->packing.has_none = true, row->packing.none = 0xffff))
SPOIL(none_of_32_bits, (row->packing.has_none = true, row->packing.none = 0xffffffff,
                        row->packing.bits = (struct lm_bus_bits){0, 32}))
SPOIL(double_float,
      (row->packing.type = LM_BUS_FLOAT, row->packing.bits = (struct lm_bus_bits){0, 64}))

TEST(every_promise_of_a_row_is_checked)
{
    static void (*const common[])(struct lm_bus_row *) = {
        unknown_field, empty_range, low_range, high_range,      quick_period,
        slow_period,   dead_first,  dead_late, coordinate_late, same_priority};
    static void (*const canas[])(struct lm_bus_row *) = {no_type, bits_type, two_types, low_id,
                                                         high_id, same_id,   no_unit,   many_units};
    static void (*const packed[])(struct lm_bus_row *) = {
        no_mask,       wide_mask,        id_outside,   no_bits,      many_bits,
        late_bits,     far_bits,         short_float,  unknown_type, wide_match,
        late_match,    large_match,      large_none,   no_factor,    large_factor,
        no_shift,      large_shift,      large_places, large_bias,   low_bias,
        part_of_a_set, part_of_a_target, crossed_bits, float_none,   float_of_no_size};
    static void (*const sound[])(struct lm_bus_row *) = {sea_state, last_field, double_float,
                                                         none_of_a_word, none_of_32_bits};
    for (uint8_t framing = LM_BUS_CANAEROSPACE; framing <= LM_BUS_PACKED; framing++) {
        uint32_t at = 99;
        assert_int_equal(check_spoilt(framing, nothing, &at), LM_OK);
        assert_int_equal(at, 99);
        for (size_t i = 0; i < sizeof common / sizeof *common; i++) {
            assert_int_equal(check_spoilt(framing, common[i], &at), LM_ERR_TABLE);
            assert_int_equal(at, 2);
        }
    }
    for (size_t i = 0; i < sizeof canas / sizeof *canas; i++) {
        assert_int_equal(check_spoilt(LM_BUS_CANAEROSPACE, canas[i], NULL), LM_ERR_TABLE);
    }
    for (size_t i = 0; i < sizeof packed / sizeof *packed; i++) {
        assert_int_equal(check_spoilt(LM_BUS_PACKED, packed[i], NULL), LM_ERR_TABLE);
    }
    for (size_t i = 0; i < sizeof sound / sizeof *sound; i++) {
        assert_int_equal(check_spoilt(LM_BUS_PACKED, sound[i], NULL), LM_OK);
    }
}

/* 180 degrees a second would be -180 in the unit that is kept; a latitude has no sense past a pole.
 */
TEST(a_range_holds_nothing_that_would_wrap)
{
    static void (*const wide[])(struct lm_bus_row *) = {past_the_pole, past_the_south, half_turn};
    for (uint8_t framing = LM_BUS_CANAEROSPACE; framing <= LM_BUS_PACKED; framing++) {
        for (size_t i = 0; i < sizeof wide / sizeof *wide; i++) {
            assert_int_equal(check_spoilt(framing, wide[i], NULL), LM_ERR_TABLE);
        }
        assert_int_equal(check_spoilt(framing, widest_latitude, NULL), LM_OK);
        assert_int_equal(check_spoilt(framing, widest_turn, NULL), LM_OK);
    }
}

TEST(every_promise_of_a_profile_is_checked)
{
    struct lm_bus_profile p = {.rows = &of_packed, .row_count = 1, .framing = LM_BUS_PACKED};
    uint32_t at = 99;
    assert_int_equal(lm_bus_profile_check(&p, &at), LM_OK);
    p.row_count = 0;
    assert_int_equal(lm_bus_profile_check(&p, &at), LM_ERR_TABLE);
    assert_int_equal(at, 0);
    p.row_count = LM_BUS_ROWS_MAX + 1;
    assert_int_equal(lm_bus_profile_check(&p, NULL), LM_ERR_TABLE);
    p.row_count = 1;
    p.framing = LM_BUS_PACKED + 1;
    assert_int_equal(lm_bus_profile_check(&p, NULL), LM_ERR_TABLE);
    p.framing = LM_BUS_PACKED;
    p.channel_mask = 0x1ff;
    assert_int_equal(lm_bus_profile_check(&p, NULL), LM_ERR_TABLE);
    p.channel_mask = 0x20000000;
    assert_int_equal(lm_bus_profile_check(&p, NULL), LM_ERR_TABLE);
    p.channel_mask = 0xff;
    p.invalid_mask = 0x20000000;
    assert_int_equal(lm_bus_profile_check(&p, NULL), LM_ERR_TABLE);
    p.invalid_mask = 0x100000;
    assert_int_equal(lm_bus_profile_check(&p, NULL), LM_OK);
}

TEST(a_frame_has_at_most_eight_numbers_and_a_field_one_pair_of_halves)
{
    struct lm_bus_row rows[9];
    for (uint8_t i = 0; i < 9; i++) {
        rows[i] = of_packed;
        rows[i].priority = i;
    }
    const struct lm_bus_profile p = {.rows = rows, .row_count = 9, .framing = LM_BUS_PACKED};
    uint32_t at;
    assert_int_equal(lm_bus_profile_check(&p, &at), LM_ERR_TABLE);
    assert_int_equal(at, 9);
    const uint32_t halves = 1u << LM_CANAS_DOUBLEH | 1u << LM_CANAS_DOUBLEL;
    for (uint8_t i = 0; i < 2; i++) {
        rows[i] = of_canas;
        rows[i].field = LM_BUS_LATITUDE;
        rows[i].id += i;
        rows[i].priority = i;
        rows[i].types = halves;
    }
    const struct lm_bus_profile q = {.rows = rows, .row_count = 2};
    assert_int_equal(lm_bus_profile_check(&q, &at), LM_ERR_TABLE);
    assert_int_equal(at, 2);
}

TEST(the_rows_of_a_frame_are_all_of_single_frames_or_all_of_fast_packets)
{
    struct lm_bus_row rows[2] = {of_packed, of_packed};
    const struct lm_bus_profile p = {.rows = rows, .row_count = 2, .framing = LM_BUS_PACKED};
    rows[1].priority = 1;
    for (int is_fast = 0; is_fast < 4; is_fast++) {
        rows[0].packing.is_fast = (is_fast & 1) != 0;
        rows[1].packing.is_fast = (is_fast & 2) != 0;
        rows[1].id = rows[0].id;
        assert_int_equal(lm_bus_profile_check(&p, NULL),
                         is_fast == 0 || is_fast == 3 ? LM_OK : LM_ERR_TABLE);
        rows[1].id++; /* of another frame */
        assert_int_equal(lm_bus_profile_check(&p, NULL), LM_OK);
    }
}

TEST(every_built_in_profile_passes)
{
    for (const struct lm_bus_named_profile *n = lm_bus_profiles; n->name != NULL; n++) {
        assert_int_equal(lm_bus_profile_check(n->profile, NULL), LM_OK);
    }
}

/* ---- ends of what is allowed ---- */

SPOIL(lowest_range, row->low = -100000)
SPOIL(highest_range, row->high = 100000)
SPOIL(quickest_period, row->period_us = 1000)
SPOIL(slowest_period, row->period_us = row->stale_ms * 1000u)
SPOIL(stale_just_before, row->dead_ms = (uint16_t)(row->stale_ms + 1))
SPOIL(dead_latest, row->dead_ms = 60000)
SPOIL(coordinate_latest, (row->field = LM_BUS_LATITUDE, row->high = 90, row->dead_ms = 4000))
SPOIL(lowest_id, row->id = 200)
SPOIL(most_units, row->per_unit = 1000000000)
SPOIL(most_bits, row->packing.bits = ((struct lm_bus_bits){0, 32}))
SPOIL(latest_bits, row->packing.bits.first = 48)
SPOIL(largest_none, (row->packing.has_none = true, row->packing.none = 0xffff))
SPOIL(largest_factor, row->packing.multiplier = (1 << 30) - 1)
SPOIL(least_shift, row->packing.shift = 1)
SPOIL(largest_shift, row->packing.shift = 60)
SPOIL(largest_places, row->packing.frac_bits = 60)
SPOIL(largest_bias, row->packing.bias = (1LL << 61) - 1)
SPOIL(lowest_bias, row->packing.bias = 1 - (1LL << 61))

TEST(a_row_may_reach_each_end_of_what_is_promised)
{
    static void (*const common[])(struct lm_bus_row *) = {
        lowest_range,      highest_range, quickest_period,  slowest_period,
        stale_just_before, dead_latest,   coordinate_latest};
    static void (*const packed[])(struct lm_bus_row *) = {
        most_bits,     latest_bits,    largest_none, largest_factor, least_shift,
        largest_shift, largest_places, largest_bias, lowest_bias};
    for (size_t i = 0; i < sizeof common / sizeof *common; i++) {
        assert_int_equal(check_spoilt(LM_BUS_CANAEROSPACE, common[i], NULL), LM_OK);
        assert_int_equal(check_spoilt(LM_BUS_PACKED, common[i], NULL), LM_OK);
    }
    assert_int_equal(check_spoilt(LM_BUS_CANAEROSPACE, lowest_id, NULL), LM_OK);
    assert_int_equal(check_spoilt(LM_BUS_CANAEROSPACE, most_units, NULL), LM_OK);
    for (size_t i = 0; i < sizeof packed / sizeof *packed; i++) {
        assert_int_equal(check_spoilt(LM_BUS_PACKED, packed[i], NULL), LM_OK);
    }
}

TEST(a_head_alone_tells_its_version_and_what_is_shorter_nothing)
{
    memset(record, 0, sizeof record);
    record[AT_VERSION] = LM_BUS_RECORD_VERSION + 1;
    assert_int_equal(lm_bus_unpack(&table, record, LM_BUS_RECORD_HEAD_BYTES), LM_ERR_VERSION);
    assert_int_equal(lm_bus_unpack(&table, record, LM_BUS_RECORD_HEAD_BYTES - 1), LM_ERR_CORRUPT);
}

/* The redundancy channel stands from bit 16 on, and the bits above the greatest one are clear. */
TEST(filters_let_pass_each_channel_that_there_is_and_no_other)
{
    struct lm_can_filter filters[LM_BUS_FILTERS_MAX];
    const uint32_t count = lm_bus_filters(&lm_bus_canas17, filters);
    uint32_t most = 1;
    while (most < LM_BUS_CHANNELS) {
        most *= 2;
    }
    for (uint32_t channel = 0; channel < 1u << 13; channel++) {
        const uint32_t id = lm_bus_canas17.rows[0].id | channel << 16;
        bool passes = false;
        for (uint32_t i = 0; i < count; i++) {
            passes |= filters[i].is_extended && ((id ^ filters[i].id) & filters[i].mask) == 0;
        }
        assert_int_equal(passes, channel < most);
    }
}
