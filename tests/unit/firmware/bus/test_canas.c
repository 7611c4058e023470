/* The decoder of the avionics bus: what an independent library sent is read to the last digit, and
 * what nobody should have sent changes nothing but a counter. */
#include "bus_frames.h"
#include "check.h"
#include "drv/can_log.h"
#include "hs/rng.h"
#include "support.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <zlib.h>

static enum lm_bus_outcome take(struct lm_bus *c, struct lm_can_frame frame,
                                struct lm_bus_event *event)
{
    return bus_take(c, &frame, event);
}

/* ---- against the other library ---- */

enum { PEER_VALUES = 8000 };

struct peer_value {
    uint64_t time_us;
    uint8_t row, channel;
    int32_t value;
};

struct peer_log {
    struct lm_bus bus;
    struct peer_value value[PEER_VALUES];
    size_t count;
};

static void decode_peer_frames(struct peer_log *log, const char *path)
{
    gzFile file = gzopen(path, "rb");
    assert_non_null(file);
    char line[256];
    while (gzgets(file, line, sizeof line) != NULL) {
        struct lm_can_frame frame;
        struct lm_bus_event event = {0};
        assert_null(drv_can_log_parse(strtok(line, "\n"), &frame));
        if (bus_take(&log->bus, &frame, &event) == LM_BUS_VALUE) {
            assert_true(log->count < PEER_VALUES);
            log->value[log->count++] =
                (struct peer_value){frame.time_us, event.row, event.channel, event.value};
        }
    }
    gzclose(file);
}

static int row_of(unsigned id)
{
    for (int i = 0; i < lm_bus_canas17.row_count; i++) {
        if (lm_bus_canas17.rows[i].id == id) {
            return i;
        }
    }
    return -1;
}

static const struct peer_value *find_value(const struct peer_log *log, uint64_t time_us, int row,
                                           unsigned channel)
{
    for (size_t i = 0; i < log->count; i++) {
        const struct peer_value *v = &log->value[i];
        if (v->time_us == time_us && v->row == row && v->channel == channel) {
            return v;
        }
    }
    return NULL;
}

/* The file prints 12 digits, 10 of them behind the point for a longitude; the fixed point rounds to
 * half a count. */
static void compare_peer_line(const struct peer_log *log, const char *line,
                              unsigned compared[LM_BUS_ROWS_MAX][2])
{
    char name[32], unit[32], type[32];
    unsigned long seconds, micros;
    double value, tolerance;
    unsigned id, node, service, code, redundancy;
    if (sscanf(line, "%lu.%6lu,%31[^,],%lf,%31[^,],%31[^,],%u,%u,%u,%u,%u,%lf", &seconds, &micros,
               name, &value, unit, type, &id, &node, &service, &code, &redundancy,
               &tolerance) != 12) {
        return; /* the header, and frames without a value */
    }
    const int row = row_of(id & 0xffff); /* channel n adds 65536 * n */
    if (row < 0) {
        return;
    }
    assert_in_range(redundancy, 0, 1);
    const struct peer_value *found =
        find_value(log, seconds * 1000000ull + micros, row, redundancy);
    if (found == NULL) {
        fail_msg("not decoded: %s", line);
        return;
    }
    const enum lm_bus_field field = (enum lm_bus_field)lm_bus_canas17.rows[row].field;
    const double error = fabs(bus_unit_of(field, found->value) - value);
    if (error > tolerance + 5e-11 + 0.503 / bus_counts_per_unit(field)) {
        fail_msg("wrong by %g: %s", error, line);
    }
    compared[row][redundancy]++;
}

TEST(every_value_that_another_library_sent_is_decoded_within_its_tolerance)
{
    char frames[512], expected[512];
    if (!support_data_path("can_peer/peer_frames_3s.log.gz", frames, sizeof frames) ||
        !support_data_path("can_peer/peer_expected_3s.csv.gz", expected, sizeof expected)) {
        skip();
    }
    struct peer_log *log = calloc(1, sizeof *log);
    lm_bus_init(&log->bus, &lm_bus_canas17);
    decode_peer_frames(log, frames);
    unsigned compared[LM_BUS_ROWS_MAX][2] = {{0}};
    gzFile file = gzopen(expected, "rb");
    assert_non_null(file);
    char line[256];
    while (gzgets(file, line, sizeof line) != NULL) {
        compare_peer_line(log, line, compared);
    }
    gzclose(file);
    unsigned total = 0;
    for (int i = 0; i < lm_bus_canas17.row_count; i++) {
        const struct lm_bus_row *row = &lm_bus_canas17.rows[i];
        const bool is_ins = row->id >= 1049 && row->id <= 1053;
        const bool is_sent = row->id != 1000 && row->id != 1001; /* no steerpoint there */
        if ((row->priority == 0 && is_sent && row->field < LM_BUS_NAV_FIELDS) || is_ins) {
            assert_int_equal(compared[i][0], 3000000 / row->period_us);
        }
        assert_int_equal(compared[i][1], row->id >= 1036 && row->id <= 1038 ? 30 : 0);
        total += compared[i][0] + compared[i][1];
    }
    assert_int_equal(total, log->count); /* nothing was decoded that was not sent */
    assert_int_equal(log->bus.count.frames, 3192);
    assert_int_equal(log->bus.count.outcome[LM_BUS_HALF], 60);
    assert_int_equal(log->bus.count.outcome[LM_BUS_SERVICE], 4);
    assert_int_equal(log->bus.canas.count.torn_pairs, 0);
    assert_int_equal(log->bus.canas.count.sequence_breaks, 0);
    for (int i = LM_BUS_BAD_LENGTH; i < LM_BUS_OUTCOMES; i++) {
        assert_int_equal(log->bus.count.outcome[i], i == LM_BUS_NO_DATA ? 1 : 0);
    }
    free(log);
}

/* ---- the table ---- */

TEST(the_table_agrees_with_the_specifications_identifiers)
{
    char path[512];
    if (!support_data_path("can_peer/canas_ids.csv", path, sizeof path)) {
        skip();
    }
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    char line[256];
    int found = 0;
    while (fgets(line, sizeof line, file) != NULL) {
        char name[64] = "", unit[16] = "", types[64] = "";
        unsigned id;
        const int i = sscanf(line, "%u,", &id) == 1 ? row_of(id) : -1;
        if (i < 0) {
            continue;
        }
        const struct lm_bus_row *row = &lm_bus_canas17.rows[i];
        found++;
        if (row->field == LM_BUS_UTC) {
            assert_non_null(strstr(line, ",$4B0,UTC,,CHAR4,"));
            continue;
        }
        assert_int_equal(sscanf(line, "%*u,$%*x,%63[^,],%15[^,],%63[^,]", name, unit, types), 3);
        assert_string_equal(name, row->name);
        assert_string_equal(unit, lm_bus_scale_of((enum lm_bus_field)row->field)->bus_unit);
        assert_true((strstr(types, "DOUBLEH") != NULL) ==
                    ((row->types >> LM_CANAS_DOUBLEH & 1) != 0));
        const double interval_ms = strtod(strrchr(line, ',') + 1, NULL);
        assert_true(interval_ms == 0.0 || interval_ms * 1000.0 == row->period_us);
    }
    fclose(file);
    /* The others are in a range that it leaves to its users (section 2.1). */
    for (int i = 0; i < lm_bus_canas17.row_count; i++) {
        const uint32_t id = lm_bus_canas17.rows[i].id;
        found += id >= 1800 && id < 1900;
    }
    assert_int_equal(found, lm_bus_canas17.row_count);
}

/* What the decoder and the ownship take for granted of a profile. */
static void assert_sound(const struct lm_bus_profile *p)
{
    assert_in_range(p->row_count, 1, LM_BUS_ROWS_MAX);
    int doubles[LM_BUS_FIELDS] = {0};
    for (int i = 0; i < p->row_count; i++) {
        const struct lm_bus_row *row = &p->rows[i];
        const bool is_coordinate = row->field <= LM_BUS_LONGITUDE;
        assert_true(row->field < LM_BUS_FIELDS && row->low < row->high);
        assert_in_range(row->dead_ms, row->stale_ms + 1, is_coordinate ? 4000 : 60000);
        assert_in_range(row->period_us, 1000, row->stale_ms * 1000);
        assert_true(row->id >= 200 && row->id < 2000 && row->types != 0 && row->per_unit > 0);
        assert_true(!p->are_types_assumed || (row->types & (row->types - 1)) == 0);
        for (uint8_t type = 0; type < 32; type++) {
            assert_true((row->types >> type & 1) == 0 ||
                        lm_canas_fits((enum lm_bus_field)row->field, type));
        }
        doubles[row->field] += (row->types >> LM_CANAS_DOUBLEH & 3) != 0;
        for (int j = 0; j < i; j++) {
            assert_int_not_equal(p->rows[j].id, row->id);
            assert_true(p->rows[j].field != row->field || p->rows[j].priority != row->priority);
        }
        /* An angle fits 64 bits before it wraps, everything else 32. */
        const int64_t low = lm_bus_counts((enum lm_bus_field)row->field, row->low);
        const int64_t high = lm_bus_counts((enum lm_bus_field)row->field, row->high);
        assert_true(lm_bus_fields[row->field].unit == LM_BUS_BAM ||
                    (low >= INT32_MIN && high <= INT32_MAX));
    }
    for (int field = 0; field < LM_BUS_FIELDS; field++) {
        assert_true(doubles[field] <= 1); /* a field has one store for a half, on each channel */
    }
}

TEST(a_board_may_have_a_list_of_its_own)
{
    static const struct lm_bus_profile mine = {.name = "mine"};
    static const struct lm_bus_named_profile list[] = {
        {"canas17", &lm_bus_canas17}, {"mine", &mine}, {NULL, NULL}};
    assert_ptr_equal(lm_bus_profile_named(list, "mine"), &mine);
    assert_ptr_equal(lm_bus_profile_named(list, "canas17"), &lm_bus_canas17);
    assert_null(lm_bus_profile_named(list, "xcsoar"));
}

TEST(a_profile_is_found_by_its_name_only)
{
    assert_ptr_equal(lm_bus_profile_named(lm_bus_profiles, "canas17"), &lm_bus_canas17);
    assert_ptr_equal(lm_bus_profile_named(lm_bus_profiles, "xcsoar"), &lm_bus_xcsoar);
    assert_ptr_equal(lm_bus_profile_named(lm_bus_profiles, "generic"), &lm_bus_generic);
    assert_null(lm_bus_profile_named(lm_bus_profiles, "canas"));
    assert_null(lm_bus_profile_named(lm_bus_profiles, "canas178"));
    assert_null(lm_bus_profile_named(lm_bus_profiles, ""));
}

TEST(every_table_of_canaerospace_is_sound)
{
    for (const struct lm_bus_named_profile *p = lm_bus_profiles; p->name != NULL; p++) {
        if (p->profile->framing == LM_BUS_CANAEROSPACE) {
            assert_sound(p->profile);
        }
    }
}

/* ---- numbers ---- */

TEST(any_float_in_range_is_within_half_a_count_of_double_arithmetic)
{
    struct hs_rng rng;
    hs_rng_seed(&rng, 11);
    struct lm_bus c;
    lm_bus_init(&c, &lm_bus_canas17);
    for (int i = 0; i < 200000; i++) {
        const enum lm_bus_field field = (enum lm_bus_field)(i % LM_BUS_UTC);
        const struct lm_bus_row *row = &lm_bus_canas17.rows[field];
        const double span = (double)row->high - row->low;
        const float value = (float)(row->low + span * hs_rng_uniform(&rng));
        struct lm_bus_event event = {0};
        assert_int_equal(take(&c, bus_float(field, value, 0), &event), LM_BUS_VALUE);
        assert_int_equal(bus_field(&event), field);
        const double exact = (double)value * bus_counts_per_unit(field);
        const double wrapped = lm_bus_fields[row->field].unit == LM_BUS_BAM
                                   ? remainder(event.value - exact, 0x1p32)
                                   : event.value - exact;
        assert_true(fabs(wrapped) <= 0.503);
    }
}

TEST(a_double_keeps_the_last_count)
{
    struct hs_rng rng;
    hs_rng_seed(&rng, 12);
    struct lm_bus c;
    lm_bus_init(&c, &lm_bus_canas17);
    for (int i = 0; i < 100000; i++) {
        const double degrees = -180.0 + 360.0 * hs_rng_uniform(&rng);
        const uint64_t bits = bus_double_bits(degrees), time_us = (uint64_t)i * 100000u;
        const uint8_t code = (uint8_t)(2 * i);
        struct lm_bus_event event = {0};
        assert_int_equal(
            take(&c, bus_frame(1037, 30, code, (uint32_t)(bits >> 32), time_us), &event),
            LM_BUS_HALF);
        assert_int_equal(
            take(&c, bus_frame(1037, 31, (uint8_t)(code + 1), (uint32_t)bits, time_us + 125),
                 &event),
            LM_BUS_VALUE);
        /* Half a count, and half of the 1/180 count that the decoder rounds to on the way. */
        assert_true(fabs(event.value - degrees * 0x1p32 / 360.0) <= 0.503);
        assert_true(event.time_us == time_us);
    }
}

TEST(a_short2_is_value_times_scale_over_32767)
{
    struct lm_bus c;
    struct lm_bus_event event = {0};
    lm_bus_init(&c, &lm_bus_canas17);
    /* The specification's example: $4000 of scale $05DC is 750.0229. */
    assert_int_equal(take(&c, bus_frame(320, 12, 0, 0x400005dcu, 0), &event), LM_BUS_VALUE);
    assert_int_equal(event.value, lround(16384.0 * 1500 / 32767 * 64));
    assert_in_range(event.step, 1, UINT32_MAX);
    assert_int_equal(take(&c, bus_frame(312, 12, 0, 0xc00000b4u, 0), &event), LM_BUS_VALUE);
    assert_int_equal(event.value, lround(-16384.0 * 180 / 32767 * 0x1p32 / 360));
    assert_int_equal(take(&c, bus_frame(312, 12, 0, 0x80000000u | 179, 0), &event), LM_BUS_VALUE);
    assert_int_equal(event.value, lround(-32768.0 * 179 / 32767 * 0x1p32 / 360));
}

TEST(a_long_position_counts_ten_millionths_of_a_degree)
{
    struct lm_bus c;
    struct lm_bus_event event = {0};
    lm_bus_init(&c, &lm_bus_canas17);
    const int32_t tests[] = {0, 1, -1, 472500445, -899999999, 900000000};
    for (size_t i = 0; i < sizeof tests / sizeof *tests; i++) {
        assert_int_equal(take(&c, bus_frame(1036, 3, 0, (uint32_t)tests[i], 0), &event),
                         LM_BUS_VALUE);
        assert_int_equal(event.value, lround(tests[i] * 1e-7 * 0x1p32 / 360));
    }
    assert_int_equal(take(&c, bus_frame(1036, 3, 0, 0x80000000u, 0), &event), LM_BUS_OUT_OF_RANGE);
    assert_int_equal(take(&c, bus_frame(1037, 3, 0, 0x7fffffffu, 0), &event), LM_BUS_OUT_OF_RANGE);
}

TEST(both_ends_of_every_range_are_taken_and_the_next_float_is_not)
{
    struct lm_bus c;
    struct lm_bus_event event = {0};
    lm_bus_init(&c, &lm_bus_canas17);
    for (int i = 0; i < LM_BUS_UTC; i++) {
        const enum lm_bus_field field = (enum lm_bus_field)i;
        const struct lm_bus_row *row = &lm_bus_canas17.rows[i];
        const float low = (float)row->low, high = (float)row->high;
        /* The resolution of the metres inside is 1/64: a float beside the end may round onto it. */
        const float above =
            lm_bus_fields[row->field].unit == LM_BUS_M_Q6 ? high + 1 : nextafterf(high, INFINITY);
        const float below = low == 0 ? -0.001f
                            : lm_bus_fields[row->field].unit == LM_BUS_M_Q6
                                ? low - 1
                                : nextafterf(low, -INFINITY);
        assert_int_equal(take(&c, bus_float(field, low, 0), &event), LM_BUS_VALUE);
        assert_int_equal(take(&c, bus_float(field, high, 0), &event), LM_BUS_VALUE);
        assert_int_equal(take(&c, bus_float(field, above, 0), &event), LM_BUS_OUT_OF_RANGE);
        assert_int_equal(take(&c, bus_float(field, below, 0), &event), LM_BUS_OUT_OF_RANGE);
    }
}

/* ---- data types ---- */

/* The specification's list, section 2.2: code, name, bytes. */
static const struct {
    const char *name;
    uint8_t bytes;
} specified[LM_CANAS_TYPES] = {
    {"NODATA", 0},  {"ERROR", 4},   {"FLOAT", 4},   {"LONG", 4},   {"ULONG", 4},  {"BLONG", 4},
    {"SHORT", 2},   {"USHORT", 2},  {"BSHORT", 2},  {"CHAR", 1},   {"UCHAR", 1},  {"BCHAR", 1},
    {"SHORT2", 4},  {"USHORT2", 4}, {"BSHORT2", 4}, {"CHAR4", 4},  {"UCHAR4", 4}, {"BCHAR4", 4},
    {"CHAR2", 2},   {"UCHAR2", 2},  {"BCHAR2", 2},  {"MEMID", 4},  {"CHKSUM", 4}, {"ACHAR", 1},
    {"ACHAR2", 2},  {"ACHAR4", 4},  {"CHAR3", 3},   {"UCHAR3", 3}, {"BCHAR3", 3}, {"ACHAR3", 3},
    {"DOUBLEH", 4}, {"DOUBLEL", 4},
};

TEST(every_data_type_has_the_specifications_code_name_and_length)
{
    for (int i = 0; i < LM_CANAS_TYPES; i++) {
        const struct lm_canas_type *t = &lm_canas_types[i];
        assert_string_equal(t->name, specified[i].name);
        assert_int_equal(t->element_bytes * t->elements, specified[i].bytes);
    }
}

/* A bus of somebody's own: an altitude in tenths of a metre and a clock, in every type that can
 * carry them. */
static const struct lm_bus_row own_rows[] = {
    {.name = "altitude",
     .id = 700,
     .field = LM_BUS_TRUE_ALTITUDE,
     .types = 1u << 2 | 1u << 3 | 1u << 4 | 1u << 6 | 1u << 7 | 1u << 9 | 1u << 10 | 1u << 12,
     .per_unit = 10,
     .low = -1000,
     .high = 30000},
    {.name = "clock",
     .id = 701,
     .field = LM_BUS_UTC,
     .types = 1u << 15 | 1u << 16 | 1u << 26 | 1u << 27,
     .per_unit = 1,
     .low = 0,
     .high = 86400},
};
static const struct lm_bus_profile own_bus = {.name = "own", .rows = own_rows, .row_count = 2};

TEST(a_number_of_every_type_that_can_carry_it_is_read)
{
    const struct {
        uint8_t type, length;
        uint32_t word; /* left-justified, as it lies in the frame */
        double metres; /* NAN: out of range */
    } tests[] = {
        {2, 8, 0x449a5000, 1234.5},
        {3, 8, 12345, 1234.5},
        {3, 8, (uint32_t)-9999, -999.9},
        {3, 8, 0x80000000, NAN},
        {4, 8, 12345, 1234.5},
        {4, 8, 0xffffffff, NAN},
        {4, 8, 0x80000000, NAN},
        {6, 6, 12345u << 16, 1234.5},
        {6, 6, 0xd8f0u << 16, -1000},
        {6, 6, 0x8000u << 16, NAN},
        {7, 6, 0xd8f0u << 16, 5553.6},
        {9, 5, 0x80u << 24, -12.8},
        {9, 5, 0x7fu << 24, 12.7},
        {10, 5, 0x80u << 24, 12.8},
        {12, 8, 0x400005dcu, 16384.0 * 1500 / 32767},
    };
    for (size_t i = 0; i < sizeof tests / sizeof *tests; i++) {
        struct lm_bus c;
        struct lm_bus_event event = {0};
        lm_bus_init(&c, &own_bus);
        struct lm_can_frame frame = bus_frame(700, tests[i].type, 0, tests[i].word, 0);
        for (uint8_t length = 0; length <= 8; length++) {
            frame.length = length;
            const enum lm_bus_outcome outcome = take(&c, frame, &event);
            const enum lm_bus_outcome right =
                isnan(tests[i].metres) ? LM_BUS_OUT_OF_RANGE : LM_BUS_VALUE;
            assert_int_equal(outcome, length == tests[i].length ? right : LM_BUS_BAD_LENGTH);
        }
        if (!isnan(tests[i].metres)) {
            assert_int_equal(event.value, lround(tests[i].metres * 64));
        }
    }
}

TEST(a_clock_of_every_type_that_can_carry_it_is_read)
{
    const uint8_t types[] = {15, 16, 26, 27};
    for (size_t i = 0; i < sizeof types; i++) {
        struct lm_bus c;
        struct lm_bus_event event = {0};
        lm_bus_init(&c, &own_bus);
        struct lm_can_frame frame = bus_frame(701, types[i], 0, 0x0d2b1600, 0);
        frame.length = types[i] >= 26 ? 7 : 8;
        assert_int_equal(take(&c, frame, &event), LM_BUS_VALUE);
        assert_int_equal(event.value, 13 * 3600 + 43 * 60 + 22);
    }
}

/* How coarse a value is tells the ownship what to make of it: neighbouring values of the type. */
TEST(the_step_of_a_value_is_that_of_its_type)
{
    struct lm_bus c;
    struct lm_bus_event event = {0};
    lm_bus_init(&c, &lm_bus_canas17);
    const double counts = 0x1p32 / 360;
    const double degrees[] = {0.3, 10, 47, 100, 179};
    for (size_t i = 0; i < sizeof degrees / sizeof *degrees; i++) {
        const float f = (float)degrees[i];
        take(&c, bus_float(LM_BUS_LONGITUDE, f, 0), &event);
        assert_true(fabs(event.step - (nextafterf(f, 360) - f) * counts) <= 1);
    }
    take(&c, bus_frame(1037, LM_CANAS_SHORT2, 0, 0x10000000u | 180, 0), &event);
    assert_true(fabs(event.step - 180.0 / 32767 * counts) <= 2);
    take(&c, bus_frame(1037, LM_CANAS_LONG, 0, 1, 0), &event);
    assert_int_equal(event.step, 1);
    take(&c, bus_frame(1037, LM_CANAS_DOUBLEH, 0, 0x40400000, 0), &event);
    assert_int_equal(take(&c, bus_frame(1037, LM_CANAS_DOUBLEL, 1, 0, 1), &event), LM_BUS_VALUE);
    assert_int_equal(event.step, 0);
}

TEST(xcsoars_frames_are_read_whatever_byte_1_says)
{
    for (int type = 0; type < 256; type++) {
        struct lm_bus c;
        struct lm_bus_event event = {0};
        lm_bus_init(&c, &lm_bus_xcsoar);
        const uint8_t t = (uint8_t)type;
        assert_int_equal(take(&c, bus_frame(1036, t, 0, 472500445, 0), &event), LM_BUS_VALUE);
        assert_int_equal(event.value, lround(47.2500445 * 0x1p32 / 360));
        assert_int_equal(take(&c, bus_frame(1039, t, 0, bus_float_bits(50.5), 0), &event),
                         LM_BUS_VALUE);
        assert_int_equal(event.value, 50500);
        struct lm_can_frame clock = bus_frame(1200, t, 0, 0x0d2b1600, 0);
        assert_int_equal(take(&c, clock, &event), LM_BUS_VALUE);
        assert_int_equal(event.value, 13 * 3600 + 43 * 60 + 22);
        clock.length = 7;
        assert_int_equal(take(&c, clock, &event), LM_BUS_BAD_LENGTH);
        assert_int_equal(take(&c, bus_frame(1049, t, 0, 0, 0), &event), LM_BUS_UNUSED);
    }
}

/* ---- frames that must not be believed ---- */

static struct lm_can_frame with_length(struct lm_can_frame frame, uint8_t length)
{
    frame.length = length;
    return frame;
}

static struct lm_can_frame with_node(struct lm_can_frame frame, uint8_t node)
{
    frame.data[0] = node;
    return frame;
}

static struct lm_can_frame with_extended_id(struct lm_can_frame frame, uint32_t id)
{
    frame.is_extended = true;
    frame.id = id;
    return frame;
}

TEST(every_malformed_frame_is_refused_for_its_own_reason)
{
    const struct lm_can_frame good = bus_float(LM_BUS_LATITUDE, 47.25, 0);
    struct lm_can_frame remote = good, error = good, wide = good;
    remote.is_remote = true;
    error.is_error = true;
    wide.id = 0x10040c;
    const struct {
        const char *what;
        struct lm_can_frame frame;
        enum lm_bus_outcome outcome;
    } tests[] = {
        {"a remote frame", remote, LM_BUS_NOT_DATA},
        {"the controller's error frame", error, LM_BUS_NOT_DATA},
        {"bits 11 to 15 set", with_extended_id(good, 0x1f40c), LM_BUS_FOREIGN},
        {"bit 11 set", with_extended_id(good, 0x10c0c), LM_BUS_FOREIGN},
        {"29 bits on channel 0", with_extended_id(good, 0x40c), LM_BUS_FOREIGN},
        {"30 bits", with_extended_id(good, 0x2001040c), LM_BUS_FOREIGN},
        {"11 bits with 21", wide, LM_BUS_FOREIGN},
        {"channel 4", with_extended_id(good, 0x4040c), LM_BUS_OTHER_CHANNEL},
        {"channel 8191", with_extended_id(good, 0x1fff040c), LM_BUS_OTHER_CHANNEL},
        {"magnetic track", bus_frame(1041, 2, 0, 0, 0), LM_BUS_UNUSED},
        {"no bytes", with_length(good, 0), LM_BUS_BAD_LENGTH},
        {"three bytes", with_length(good, 3), LM_BUS_BAD_LENGTH},
        {"a FLOAT of three bytes", with_length(good, 7), LM_BUS_BAD_LENGTH},
        {"a FLOAT without data", with_length(good, 4), LM_BUS_BAD_LENGTH},
        {"more than CAN carries", with_length(good, 9), LM_BUS_BAD_LENGTH},
        {"more than the array", with_length(good, 255), LM_BUS_BAD_LENGTH},
        {"NODATA with data", bus_frame(1036, 0, 0, 0, 0), LM_BUS_BAD_LENGTH},
        {"NODATA", with_length(bus_frame(1036, 0, 0, 0, 0), 4), LM_BUS_NO_DATA},
        {"ERROR", bus_frame(1036, 1, 0, 0x07ff0000, 0), LM_BUS_NO_DATA},
        {"a broadcast as the sender", with_node(good, 0), LM_BUS_BAD_NODE},
        {"a ULONG latitude", bus_frame(1036, 4, 0, 0, 0), LM_BUS_BAD_TYPE},
        {"a LONG pitch", bus_frame(311, 3, 0, 0, 0), LM_BUS_BAD_TYPE},
        {"a DOUBLEH pitch", bus_frame(311, 30, 0, 0, 0), LM_BUS_BAD_TYPE},
        {"a FLOAT clock", bus_frame(1200, 2, 0, 0, 0), LM_BUS_BAD_TYPE},
        {"a reserved type", bus_frame(1036, 34, 0, 0, 0), LM_BUS_BAD_TYPE},
        {"a user's type", bus_frame(1036, 255, 0, 0, 0), LM_BUS_BAD_TYPE},
        {"NaN", bus_frame(1036, 2, 0, 0x7fc00000, 0), LM_BUS_NOT_A_NUMBER},
        {"a signalling NaN", bus_frame(1036, 2, 0, 0xff800001, 0), LM_BUS_NOT_A_NUMBER},
        {"infinity", bus_frame(1036, 2, 0, 0x7f800000, 0), LM_BUS_NOT_A_NUMBER},
        {"minus infinity", bus_frame(1036, 2, 0, 0xff800000, 0), LM_BUS_NOT_A_NUMBER},
        {"latitude 180", bus_float(LM_BUS_LATITUDE, 180, 0), LM_BUS_OUT_OF_RANGE},
        {"longitude 200", bus_float(LM_BUS_LONGITUDE, 200, 0), LM_BUS_OUT_OF_RANGE},
        {"the largest float", bus_frame(1036, 2, 0, 0x7f7fffff, 0), LM_BUS_OUT_OF_RANGE},
        {"SHORT2 without a scale", bus_frame(320, 12, 0, 0x40000000, 0), LM_BUS_NOT_A_NUMBER},
        {"SHORT2 of scale -1", bus_frame(320, 12, 0, 0x4000ffff, 0), LM_BUS_NOT_A_NUMBER},
        {"24:00:00", bus_frame(1200, 15, 0, 0x18000000, 0), LM_BUS_OUT_OF_RANGE},
        {"12:60:00", bus_frame(1200, 15, 0, 0x0c3c0000, 0), LM_BUS_OUT_OF_RANGE},
        {"12:30:60", bus_frame(1200, 15, 0, 0x0c1e3c00, 0), LM_BUS_OUT_OF_RANGE},
        {"23:58:60", bus_frame(1200, 15, 0, 0x173a3c00, 0), LM_BUS_OUT_OF_RANGE},
        {"22:59:60", bus_frame(1200, 15, 0, 0x163b3c00, 0), LM_BUS_OUT_OF_RANGE},
        {"23:59:61", bus_frame(1200, 15, 0, 0x173b3d00, 0), LM_BUS_OUT_OF_RANGE},
        {"24:60:60", bus_frame(1200, 15, 0, 0x183c3c00, 0), LM_BUS_OUT_OF_RANGE},
    };
    for (size_t i = 0; i < sizeof tests / sizeof *tests; i++) {
        struct lm_bus c;
        lm_bus_init(&c, &lm_bus_canas17);
        struct lm_bus_event event = {.value = 90, .node = 91, .time_us = 92};
        const enum lm_bus_outcome outcome = take(&c, tests[i].frame, &event);
        if (outcome != tests[i].outcome || event.value != 90 || event.node != 91 ||
            event.time_us != 92) {
            fail_msg("%s: outcome %d instead of %d", tests[i].what, (int)outcome,
                     (int)tests[i].outcome);
        }
        assert_int_equal(c.count.outcome[outcome], 1);
        assert_int_equal(c.count.frames, 1);
    }
}

TEST(an_assumed_type_excuses_neither_the_length_nor_the_sender)
{
    const struct lm_can_frame good = bus_frame(1036, 0, 0, 472500445, 0);
    const struct {
        struct lm_can_frame frame;
        enum lm_bus_outcome outcome;
    } tests[] = {{good, LM_BUS_VALUE},
                 {with_length(good, 7), LM_BUS_BAD_LENGTH},
                 {with_length(good, 9), LM_BUS_BAD_LENGTH},
                 {with_node(good, 0), LM_BUS_BAD_NODE},
                 {with_extended_id(good, 0x1f40c), LM_BUS_FOREIGN}};
    for (size_t i = 0; i < sizeof tests / sizeof *tests; i++) {
        struct lm_bus c;
        struct lm_bus_event event;
        lm_bus_init(&c, &lm_bus_xcsoar);
        assert_int_equal(take(&c, tests[i].frame, &event), tests[i].outcome);
    }
}

TEST(services_of_both_ranges_are_told_from_values)
{
    static const struct {
        uint32_t id;
        enum lm_bus_outcome outcome;
    } cases[] = {{127, LM_BUS_UNUSED},   {128, LM_BUS_SERVICE}, {199, LM_BUS_SERVICE},
                 {200, LM_BUS_UNUSED},   {1999, LM_BUS_UNUSED}, {2000, LM_BUS_SERVICE},
                 {2031, LM_BUS_SERVICE}, {2032, LM_BUS_UNUSED}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct lm_bus c;
        struct lm_bus_event event;
        lm_bus_init(&c, &lm_bus_canas17);
        assert_int_equal(take(&c, bus_frame(cases[i].id, 0, 0, 0, 0), &event), cases[i].outcome);
    }
}

static bool is_among(const char *name, const char *names)
{
    char padded[16];
    (void)snprintf(padded, sizeof padded, " %s ", name);
    return strstr(names, padded) != NULL;
}

TEST(words_and_clocks_have_types_of_their_own)
{
    static const char words[] = " SHORT2 USHORT2 BSHORT2 CHAR4 UCHAR4 BCHAR4 ACHAR4 ";
    static const char clocks[] = " CHAR4 UCHAR4 CHAR3 UCHAR3 ";
    for (uint8_t type = 0; type < LM_CANAS_TYPES; type++) {
        const char *name = lm_canas_types[type].name;
        assert_int_equal(lm_canas_fits(LM_BUS_LIVE_VELOCITY, type), is_among(name, words));
        assert_int_equal(lm_canas_fits(LM_BUS_UTC, type), is_among(name, clocks));
    }
}

TEST(no_field_fits_a_type_that_does_not_exist)
{
    for (uint32_t field = 0; field < LM_BUS_FIELDS; field++) {
        assert_false(lm_canas_fits((enum lm_bus_field)field, LM_CANAS_TYPES));
        assert_false(lm_canas_fits((enum lm_bus_field)field, 255));
    }
}

TEST(a_leap_second_is_a_time)
{
    struct lm_bus c;
    struct lm_bus_event event = {0};
    lm_bus_init(&c, &lm_bus_canas17);
    assert_int_equal(take(&c, bus_frame(1200, 15, 0, 0x0d2b1600, 0), &event), LM_BUS_VALUE);
    assert_int_equal(event.value, 13 * 3600 + 43 * 60 + 22); /* the specification's example */
    assert_int_equal(take(&c, bus_frame(1200, 15, 0, 0x173b3c00, 0), &event), LM_BUS_VALUE);
    assert_int_equal(event.value, 86400);
}

TEST(no_message_is_lost_when_a_sender_restarts_repeats_or_jumps)
{
    struct lm_bus c;
    lm_bus_init(&c, &lm_bus_canas17);
    const uint8_t codes[] = {200, 201, 0, 1, 2, 2, 2, 130, 131, 3, 255, 0, 1};
    for (size_t i = 0; i < sizeof codes; i++) {
        struct lm_bus_event event = {0};
        const struct lm_can_frame frame =
            bus_frame(311, LM_CANAS_FLOAT, codes[i], bus_float_bits((double)i), i * 12500);
        assert_int_equal(take(&c, frame, &event), LM_BUS_VALUE);
        assert_int_equal(lround(bus_unit_of(LM_BUS_PITCH, event.value)), i);
    }
    assert_int_equal(c.canas.count.sequence_breaks, 6);
}

/* ---- halves of doubles ---- */

enum { PAIRS = 5, HALVES = 2 * PAIRS };

struct sender {
    bool is_low_first; /* DOUBLEL carries the first code */
    bool is_uncounted; /* every value starts with first_code again */
    bool is_swapped;   /* of two halves, the one with the second code arrives first */
    uint8_t first_code;
    uint64_t period_us, gap_us;
};

/* Values whose every mixture is none of them. */
static uint64_t pair_bits(int pair)
{
    const uint32_t number = (uint32_t)pair;
    return (uint64_t)(0x40479001u + number) << 32 | 0x11111111u * (number + 1);
}

static int32_t pair_value(int pair)
{
    const uint64_t bits = pair_bits(pair);
    double degrees;
    memcpy(&degrees, &bits, sizeof degrees);
    return (int32_t)lround(degrees * 0x1p32 / 360);
}

/* Half number i in order of arrival. */
static struct lm_can_frame half_of(const struct sender *s, int i)
{
    const int pair = i / 2, place = i % 2;
    const int code_place = s->is_swapped ? 1 - place : place;
    const bool is_low = (code_place == 0) == s->is_low_first;
    const uint64_t bits = pair_bits(pair);
    return bus_frame(1036, is_low ? LM_CANAS_DOUBLEL : LM_CANAS_DOUBLEH,
                     (uint8_t)(s->first_code + (s->is_uncounted ? 0 : 2 * pair) + code_place),
                     (uint32_t)(is_low ? bits : bits >> 32),
                     (uint64_t)pair * s->period_us + (uint64_t)place * s->gap_us);
}

struct tally {
    int whole, mixed, mixed_after_whole;
    struct lm_bus bus;
};

/* Send the halves of which `mask` has the bit. */
static struct tally send_halves(const struct sender *s, unsigned mask)
{
    struct tally t = {0};
    lm_bus_init(&t.bus, &lm_bus_canas17);
    for (int i = 0; i < HALVES; i++) {
        struct lm_bus_event event = {0};
        if ((mask >> i & 1) == 0 || take(&t.bus, half_of(s, i), &event) != LM_BUS_VALUE) {
            continue;
        }
        const bool is_whole = event.value == pair_value(i / 2);
        t.mixed_after_whole += !is_whole && t.whole > 0;
        t.whole += is_whole;
        t.mixed += !is_whole;
    }
    return t;
}

static int complete_pairs(unsigned mask)
{
    int complete = 0;
    for (int pair = 0; pair < PAIRS; pair++) {
        complete += (mask >> 2 * pair & 3) == 3;
    }
    return complete;
}

TEST(whatever_halves_are_lost_exactly_the_whole_pairs_give_a_value)
{
    for (unsigned variant = 0; variant < 32; variant++) {
        const struct sender s = {
            .is_low_first = (variant & 1) != 0,
            .is_swapped = (variant & 2) != 0,
            .first_code = variant & 4 ? 251 : 0, /* wraps within, and between the halves */
            .period_us = 100000,
            .gap_us = variant & 8 ? 12500 : 125,
            .is_uncounted = (variant & 16) != 0,
        };
        for (unsigned mask = 0; mask < 1u << HALVES; mask++) {
            const struct tally t = send_halves(&s, mask);
            assert_int_equal(t.whole, complete_pairs(mask));
            assert_int_equal(t.mixed, 0);
            const uint32_t waiting = t.bus.canas.pair[0][0].state == LM_CANAS_WAITING;
            assert_int_equal(t.bus.count.frames,
                             2 * (uint32_t)t.whole + t.bus.canas.count.torn_pairs + waiting);
        }
    }
}

TEST(a_sender_five_times_too_fast_is_misread_at_most_before_its_first_whole_pair)
{
    for (unsigned variant = 0; variant < 4; variant++) {
        const struct sender s = {
            .is_low_first = (variant & 1) != 0,
            .is_swapped = (variant & 2) != 0,
            .first_code = 7,
            .period_us = 20000,
            .gap_us = 125,
        };
        for (unsigned mask = 0; mask < 1u << HALVES; mask++) {
            const struct tally t = send_halves(&s, mask);
            assert_int_equal(t.whole, complete_pairs(mask));
            assert_int_equal(t.mixed_after_whole, 0);
            assert_true((mask & 3) != 3 || t.mixed == 0);
        }
    }
}

/* Send a first half, something, and the second half; what becomes of the last? */
static enum lm_bus_outcome half_something_half(const struct lm_can_frame *something,
                                               uint64_t gap_us, uint8_t code, uint32_t *torn)
{
    const struct sender s = {.period_us = 100000, .gap_us = gap_us};
    struct lm_bus c;
    struct lm_bus_event event = {0};
    lm_bus_init(&c, &lm_bus_canas17);
    assert_int_equal(take(&c, half_of(&s, 0), &event), LM_BUS_HALF);
    if (something != NULL) {
        bus_take(&c, something, &event);
    }
    struct lm_can_frame second = half_of(&s, 1);
    second.data[3] = code;
    const enum lm_bus_outcome outcome = take(&c, second, &event);
    *torn = c.canas.count.torn_pairs;
    return outcome;
}

TEST(anything_else_of_that_identifier_between_the_halves_tears_them)
{
    struct lm_can_frame other_node = bus_frame(1036, LM_CANAS_DOUBLEL, 1, 0, 50);
    other_node.data[0] = 10;
    const struct lm_can_frame tearing[] = {
        bus_float(LM_BUS_LATITUDE, 47, 50),
        with_length(bus_frame(1036, LM_CANAS_NODATA, 1, 0, 50), 4),
        bus_frame(1036, 77, 1, 0, 50),
        with_length(bus_frame(1036, LM_CANAS_DOUBLEL, 1, 0, 50), 7),
        bus_frame(1036, LM_CANAS_DOUBLEH, 0, 0, 50),
        other_node,
    };
    uint32_t torn;
    for (size_t i = 0; i < sizeof tearing / sizeof *tearing; i++) {
        if (i == 4) {
            continue; /* another DOUBLEH takes the first one's place: below */
        }
        assert_int_equal(half_something_half(&tearing[i], 125, 1, &torn), LM_BUS_HALF);
        assert_true(torn >= 1);
    }
    half_something_half(&tearing[4], 125, 1, &torn);
    assert_int_equal(torn, 1);
}

TEST(other_identifiers_and_channels_between_the_halves_do_not_matter)
{
    const struct lm_can_frame half = bus_frame(1036, LM_CANAS_DOUBLEL, 1, 0, 50);
    struct lm_can_frame error = half, remote = half;
    error.is_error = true;
    remote.is_remote = true;
    const struct lm_can_frame harmless[] = {
        bus_frame(1037, LM_CANAS_DOUBLEH, 0, 0, 50),
        bus_float(LM_BUS_PITCH, 3, 50),
        with_extended_id(half, 0x1040c),
        with_extended_id(half, 0x1f40c),
        error,
        remote,
    };
    uint32_t torn;
    for (size_t i = 0; i < sizeof harmless / sizeof *harmless; i++) {
        assert_int_equal(half_something_half(&harmless[i], 125, 1, &torn), LM_BUS_VALUE);
        assert_int_equal(torn, 0);
    }
}

TEST(halves_of_two_channels_are_joined_each_on_its_own)
{
    struct lm_bus c;
    struct lm_bus_event event = {0};
    lm_bus_init(&c, &lm_bus_canas17);
    const struct sender s = {.period_us = 100000, .gap_us = 250};
    for (int i = 0; i < HALVES; i++) {
        struct lm_can_frame first = half_of(&s, i);
        struct lm_can_frame other = with_extended_id(half_of(&s, HALVES - 1 - (i ^ 1)), 0x3040c);
        other.data[3] = first.data[3];
        other.time_us = first.time_us + 10;
        assert_int_equal(take(&c, first, &event), i % 2 ? LM_BUS_VALUE : LM_BUS_HALF);
        assert_true(i % 2 == 0 || (event.channel == 0 && event.value == pair_value(i / 2)));
        assert_int_equal(take(&c, other, &event), i % 2 ? LM_BUS_VALUE : LM_BUS_HALF);
        assert_true(i % 2 == 0 ||
                    (event.channel == 3 && event.value == pair_value(PAIRS - 1 - i / 2)));
    }
    assert_int_equal(c.canas.count.torn_pairs, 0);
}

TEST(a_code_gap_or_age_tears_the_halves)
{
    uint32_t torn;
    assert_int_equal(half_something_half(NULL, 125, 1, &torn), LM_BUS_VALUE);
    assert_int_equal(half_something_half(NULL, 125, 2, &torn), LM_BUS_HALF);
    assert_int_equal(torn, 1);
    assert_int_equal(half_something_half(NULL, 125, 0, &torn), LM_BUS_HALF);
    assert_int_equal(half_something_half(NULL, 50000, 1, &torn), LM_BUS_VALUE);
    assert_int_equal(half_something_half(NULL, 50001, 1, &torn), LM_BUS_HALF);
    assert_int_equal(half_something_half(NULL, 100001, 1, &torn), LM_BUS_HALF);
    /* Once the order is known, a whole period is allowed. */
    for (uint64_t late_us = 100000; late_us <= 100001; late_us++) {
        const struct sender s = {.period_us = 1000000, .gap_us = 125};
        struct lm_bus c;
        struct lm_bus_event event = {0};
        lm_bus_init(&c, &lm_bus_canas17);
        for (int i = 0; i < 3; i++) {
            take(&c, half_of(&s, i), &event);
        }
        struct lm_can_frame last = half_of(&s, 3);
        last.time_us = 1000000 + late_us;
        assert_int_equal(take(&c, last, &event), late_us == 100000 ? LM_BUS_VALUE : LM_BUS_HALF);
    }
}

TEST(a_sender_that_changes_its_habit_is_understood_again)
{
    struct lm_bus c;
    lm_bus_init(&c, &lm_bus_canas17);
    int whole = 0;
    for (int round = 0; round < 4; round++) {
        const struct sender s = {
            .is_low_first = round % 2 == 1, .period_us = 100000, .gap_us = 5000};
        for (int i = 0; i < HALVES; i++) {
            struct lm_can_frame half = half_of(&s, i);
            struct lm_bus_event event = {0};
            half.time_us += (uint64_t)round * 3000000u;
            half.data[0] = (uint8_t)(9 + round / 2); /* a new node twice as rarely */
            whole += take(&c, half, &event) == LM_BUS_VALUE && event.value == pair_value(i / 2);
        }
    }
    assert_true(whole >= 4 * PAIRS - 4);
}

TEST(a_double_that_is_no_position_is_refused_whole)
{
    const struct {
        uint64_t bits;
        enum lm_bus_outcome outcome;
    } tests[] = {
        {0x7ff8000000000000u, LM_BUS_NOT_A_NUMBER},
        {0xfff0000000000000u, LM_BUS_NOT_A_NUMBER},
        {0x7ff0000000000001u, LM_BUS_NOT_A_NUMBER}, /* only the low half tells */
        {bus_double_bits(90.0001), LM_BUS_OUT_OF_RANGE},
        {bus_double_bits(-1e300), LM_BUS_OUT_OF_RANGE},
        {bus_double_bits(-90.0), LM_BUS_VALUE},
        {bus_double_bits(1e-300), LM_BUS_VALUE},
    };
    struct lm_bus c;
    struct lm_bus_event event = {0};
    lm_bus_init(&c, &lm_bus_canas17);
    for (size_t i = 0; i < sizeof tests / sizeof *tests; i++) {
        const uint8_t code = (uint8_t)(2 * i);
        const uint64_t bits = tests[i].bits;
        take(&c, bus_frame(1036, 30, code, (uint32_t)(bits >> 32), i * 100000), &event);
        const struct lm_can_frame low =
            bus_frame(1036, 31, (uint8_t)(code + 1), (uint32_t)bits, i * 100000 + 125);
        assert_int_equal(take(&c, low, &event), tests[i].outcome);
    }
}
