/* Live targets that come over the bus: docs/bus.md, "Live targets". */
#include "bus_frames.h"
#include "check.h"
#include "hs/angle.h"
#include "lm/live_bus.h"

#include <stdlib.h>

enum { S = 1000000, MS = 1000 };

struct ear {
    struct lm_bus bus;
    struct lm_live_bus live;
};

static struct ear *open_ear(void)
{
    struct ear *ear = calloc(1, sizeof *ear);
    lm_bus_init(&ear->bus, &lm_bus_canas17);
    return ear;
}

struct from {
    uint8_t node, number, code;
    uint64_t time_us;
};

static uint32_t hear(struct ear *ear, struct from from, uint32_t id, uint8_t type, uint32_t word)
{
    struct lm_bus_event events[LM_BUS_EVENTS];
    struct lm_can_frame f = bus_frame(id, type, from.code, word, from.time_us);
    f.data[0] = from.node;
    f.data[2] = from.number;
    f.length = type == LM_CANAS_UCHAR ? 5 : 8;
    const uint32_t count = lm_bus_take(&ear->bus, &f, events);
    for (uint32_t i = 0; i < count; i++) {
        lm_live_bus_take(&ear->live, &events[i], events[i].time_us + 77);
    }
    return count;
}

/* As docs/bus.md has it: two numbers of 16 bits. */
static uint32_t pair(int first, int second)
{
    return (uint32_t)(uint16_t)first << 16 | (uint16_t)second;
}

/* The frames of a set of everything, in the order of the table. */
static void hear_part(struct ear *ear, struct from from, int part, double latitude)
{
    switch (part) {
    case 0:
        hear(ear, from, 1810, LM_CANAS_LONG, (uint32_t)(int32_t)(latitude * 1e7));
        break;
    case 1:
        hear(ear, from, 1811, LM_CANAS_LONG, (uint32_t)-1700000000);
        break;
    case 2:
        hear(ear, from, 1812, LM_CANAS_FLOAT, bus_float_bits(1234.5));
        break;
    case 3:
        hear(ear, from, 1813, LM_CANAS_SHORT2, pair(400, -200));
        break;
    case 4:
        hear(ear, from, 1814, LM_CANAS_SHORT2, pair(-16384, 300));
        break;
    case 5:
        hear(ear, from, 1815, LM_CANAS_UCHAR4, 0x0407031fu);
        break;
    case 6:
        hear(ear, from, 1816, LM_CANAS_FLOAT, bus_float_bits(12.5));
        break;
    case 7:
        hear(ear, from, 1819, LM_CANAS_SHORT2, pair(-50, 100));
        break;
    default:
        fail();
    }
}

static void hear_set(struct ear *ear, struct from from, double latitude)
{
    for (int part = 0; part < 8; part++) {
        hear_part(ear, from, part, latitude);
    }
}

static void hear_small(struct ear *ear, struct from from, int32_t latitude_e7)
{
    hear(ear, from, 1810, LM_CANAS_LONG, (uint32_t)latitude_e7);
    hear(ear, from, 1811, LM_CANAS_LONG, 110000000);
    hear(ear, from, 1815, LM_CANAS_UCHAR4, 0x0d010000u);
}

static const struct lm_live_target *target(const struct ear *ear, uint32_t number)
{
    return &ear->live.live.target[number];
}

TEST(eight_frames_make_a_target_in_any_order)
{
    for (int turn = 0; turn < 8; turn++) {
        struct ear *ear = open_ear();
        for (int part = 0; part < 8; part++) {
            assert_int_equal(ear->live.live.count, 0);
            hear_part(ear, (struct from){20, 255, 7, S}, (part + turn) % 8, -46);
        }
        const struct lm_live_target *t = target(ear, 255);
        assert_int_equal(ear->live.live.count, 1);
        assert_true(t->is_there && t->has_height);
        assert_int_equal(t->position.latitude, hs_bam(-46));
        assert_int_equal(t->position.longitude, hs_bam(-170));
        assert_int_equal(t->height_m_q6, 1234.5 * 64);
        assert_int_equal(t->velocity[0], 400);
        assert_int_equal(t->velocity[1], -200);
        assert_int_equal(t->heading, hs_bam(-90));
        assert_int_equal(t->turn, 300);
        assert_int_equal(t->kind, LM_LIVE_ARMOUR);
        assert_int_equal(t->reckoning, LM_LIVE_RPB);
        assert_int_equal(t->signature, 3);
        assert_int_equal(t->rcs_dbsm_q8, 12.5 * 256);
        assert_int_equal(t->acceleration[0], -50);
        assert_int_equal(t->acceleration[1], 100);
        assert_int_equal(t->heard_us, S);
        assert_int_equal(t->motion_us, S + 77);
        assert_int_equal(ear->live.count.sets, 1);
        assert_int_equal(ear->live.count.torn + ear->live.count.refused, 0);
        assert_int_equal(ear->bus.canas.count.sequence_breaks, 0);
        free(ear);
    }
}

TEST(three_frames_make_a_ship_that_stands_on_the_ground)
{
    struct ear *ear = open_ear();
    hear_set(ear, (struct from){20, 0, 1, 0}, 46);
    hear_small(ear, (struct from){20, 0, 2, S}, 470000000);
    const struct lm_live_target *t = target(ear, 0);
    assert_int_equal(t->position.latitude, hs_bam(47));
    assert_false(t->has_height);
    assert_int_equal(t->velocity[0] | t->velocity[1] | t->turn | t->acceleration[0], 0);
    assert_int_equal(t->heading, 0);
    assert_int_equal(t->rcs_dbsm_q8, 33 * 256); /* 2,000 t, as square metres */
    assert_int_equal(ear->live.count.sets, 2);
    free(ear);
}

TEST(without_a_heading_the_body_lies_along_its_velocity)
{
    struct ear *ear = open_ear();
    const struct from from = {20, 9, 1, 0};
    hear(ear, from, 1815, LM_CANAS_UCHAR4, 0x02020002u);
    hear(ear, from, 1810, LM_CANAS_LONG, 460000000);
    hear(ear, from, 1811, LM_CANAS_LONG, 110000000);
    assert_int_equal(ear->live.live.count, 0);
    hear(ear, from, 1813, LM_CANAS_SHORT2, pair(-300, 0));
    assert_int_equal(target(ear, 9)->heading, hs_bam(-90));
    free(ear);
}

TEST(no_target_is_ever_half_new)
{
    for (int lost = 0; lost < 8; lost++) {
        struct ear *ear = open_ear();
        hear_set(ear, (struct from){20, 5, 1, 0}, 46);
        for (int part = 0; part < 8; part++) {
            if (part != lost) {
                hear_part(ear, (struct from){20, 5, 2, S}, part, 47);
            }
            assert_int_equal(target(ear, 5)->position.latitude, hs_bam(46));
            assert_int_equal(target(ear, 5)->heard_us, 0);
        }
        hear_set(ear, (struct from){20, 5, 3, 2 * S}, 48);
        assert_int_equal(target(ear, 5)->position.latitude, hs_bam(48));
        assert_int_equal(ear->live.count.torn, 1);
        assert_int_equal(ear->live.count.sets, 2);
        free(ear);
    }
}

/* 256 targets a second bring each number its old message code again. */
TEST(frames_of_two_seconds_are_never_joined)
{
    struct ear *ear = open_ear();
    for (int part = 0; part < 8; part++) {
        if (part != 3) {
            hear_part(ear, (struct from){20, 5, 9, 0}, part, 46);
        }
    }
    hear_part(ear, (struct from){20, 5, 9, S}, 3, 46);
    assert_int_equal(ear->live.live.count, 0);
    assert_int_equal(ear->live.count.torn, 1);
    free(ear);
}

TEST(sets_of_several_targets_may_be_mixed)
{
    struct ear *ear = open_ear();
    for (int part = 0; part < 8; part++) {
        for (uint8_t number = 0; number < 50; number++) {
            hear_part(ear, (struct from){20, number, number, 150 * MS}, part, 10 + number);
        }
    }
    assert_int_equal(ear->live.live.count, 50);
    for (uint8_t number = 0; number < 50; number++) {
        assert_int_equal(target(ear, number)->position.latitude, hs_bam(10 + number));
    }
    free(ear);
}

TEST(what_is_out_of_range_is_refused_whole_and_counted)
{
    static const struct {
        uint32_t id;
        uint8_t type;
        uint32_t word;
        bool is_frame; /* refused with its frame: the set stays torn */
    } bad[] = {{1810, LM_CANAS_LONG, 900000001, true},
               {1811, LM_CANAS_LONG, 1800000001, true},
               {1811, LM_CANAS_FLOAT, 0, true},
               {1812, LM_CANAS_FLOAT, 0x7fc00000, true},
               {1816, LM_CANAS_FLOAT, 0x42800000, true},   /* 64 dBsm */
               {1813, LM_CANAS_SHORT2, 0x4E210000, false}, /* 1000.05 m/s */
               {1813, LM_CANAS_SHORT2, 0x80008000, false},
               {1814, LM_CANAS_SHORT2, 6001, false},
               {1815, LM_CANAS_UCHAR4, 0x040a001f, false},  /* algorithm 10 */
               {1815, LM_CANAS_UCHAR4, 0x0402003f, false},  /* a part that is none */
               {1815, LM_CANAS_UCHAR4, 0x0402001d, false}}; /* velocity is not named */
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        struct ear *ear = open_ear();
        static const uint32_t ids[] = {1810, 1811, 1812, 1813, 1814, 1815, 1816, 1819};
        const struct from from = {20, 5, 1, S};
        for (int part = 0; part < 8; part++) {
            if (ids[part] != bad[i].id) {
                hear_part(ear, from, part, 46);
            }
        }
        assert_int_equal(hear(ear, from, bad[i].id, bad[i].type, bad[i].word), !bad[i].is_frame);
        assert_int_equal(ear->live.live.count, 0);
        assert_int_equal(ear->live.count.refused, !bad[i].is_frame);
        free(ear);
    }
}

TEST(a_kind_of_tomorrow_is_an_unknown_one)
{
    struct ear *ear = open_ear();
    const struct from from = {20, 5, 1, S};
    hear(ear, from, 1810, LM_CANAS_LONG, 460000000);
    hear(ear, from, 1811, LM_CANAS_LONG, 110000000);
    hear(ear, from, 1815, LM_CANAS_UCHAR4, 0xc8010000u);
    assert_int_equal(target(ear, 5)->kind, LM_LIVE_UNKNOWN);
    assert_int_equal(target(ear, 5)->rcs_dbsm_q8, 10 * 256);
    free(ear);
}

TEST(a_rival_is_not_heard_until_the_first_is_stale)
{
    struct ear *ear = open_ear();
    hear_small(ear, (struct from){20, 5, 1, 0}, 460000000);
    hear_small(ear, (struct from){21, 5, 1, 3 * S}, 470000000);
    assert_int_equal(target(ear, 5)->position.latitude, hs_bam(46));
    assert_int_equal(ear->live.count.rivals, 3);
    hear_small(ear, (struct from){21, 5, 2, 3 * S + 1}, 470000000);
    assert_int_equal(target(ear, 5)->position.latitude, hs_bam(47));
    hear_small(ear, (struct from){20, 6, 2, 3 * S + 1}, 460000000); /* another number is free */
    assert_int_equal(ear->live.live.count, 2);
    free(ear);
}

static void age(struct ear *ear, uint64_t now_us)
{
    for (int i = 0; i < LM_LIVE_MAX / LM_LIVE_AGED_A_STEP; i++) {
        lm_live_bus_age(&ear->live, now_us);
    }
}

TEST(a_target_that_is_not_told_anew_is_gone_after_10_s)
{
    struct ear *ear = open_ear();
    for (int number = 0; number < LM_LIVE_MAX; number++) {
        hear_small(ear, (struct from){20, (uint8_t)number, (uint8_t)number, 5 * S}, 460000000);
    }
    assert_int_equal(ear->live.live.count, LM_LIVE_MAX);
    hear_small(ear, (struct from){20, 7, 1, 6 * S}, 460000000);
    age(ear, 15 * S);
    assert_int_equal(ear->live.live.count, LM_LIVE_MAX);
    age(ear, 15 * S + 1);
    assert_int_equal(ear->live.live.count, 1);
    assert_true(target(ear, 7)->is_there);
    assert_int_equal(ear->live.count.aged, LM_LIVE_MAX - 1);
    age(ear, 0); /* the clock was set back by more than the stale age */
    assert_int_equal(ear->live.live.count, 0);
    free(ear);
}

/* One of several targets may be late: the node is heard as long as it tells any. */
TEST(a_node_is_silent_when_it_told_none_of_its_targets_for_3_s)
{
    struct ear *ear = open_ear();
    age(ear, 5 * S);
    assert_false(ear->live.is_silent);
    for (uint8_t number = 0; number < 10; number++) {
        hear_small(ear, (struct from){20, number, number, 5 * S}, 460000000);
        hear_small(ear, (struct from){21, (uint8_t)(100 + number), number, 5 * S}, 460000000);
    }
    hear_small(ear, (struct from){20, 9, 1, 8 * S}, 460000000);
    hear_small(ear, (struct from){21, 109, 1, 8 * S}, 460000000);
    age(ear, 11 * S);
    assert_false(ear->live.is_silent);
    hear_small(ear, (struct from){20, 9, 2, 11 * S}, 460000000);
    age(ear, 11 * S + 1); /* node 21 */
    assert_true(ear->live.is_silent);
    hear_small(ear, (struct from){21, 109, 2, 11 * S + 1}, 460000000);
    age(ear, 11 * S + 2);
    assert_false(ear->live.is_silent);
    age(ear, 14 * S + 1); /* node 20 */
    assert_true(ear->live.is_silent);
    hear(ear, (struct from){20, 0, 0, 14 * S + 1}, 1818, LM_CANAS_UCHAR, 0);
    age(ear, 14 * S + 1); /* what has no targets is not missed */
    assert_false(ear->live.is_silent);
    free(ear);
}

TEST(frames_remove_one_or_all)
{
    struct ear *ear = open_ear();
    for (uint8_t number = 0; number < 10; number++) {
        hear_small(ear, (struct from){20, number, number, 0}, 460000000);
    }
    hear(ear, (struct from){20, 3, 0, 0}, 1817, LM_CANAS_UCHAR, 0);
    assert_false(target(ear, 3)->is_there);
    assert_int_equal(ear->live.live.count, 9);
    hear(ear, (struct from){20, 3, 0, 0}, 1817, LM_CANAS_UCHAR, 0); /* twice does no harm */
    assert_int_equal(ear->live.count.removed, 1);
    hear(ear, (struct from){20, 0, 0, 0}, 1818, LM_CANAS_UCHAR, 0);
    assert_int_equal(ear->live.live.count, 0);
    assert_int_equal(ear->live.count.removed, 10);
    free(ear);
}

TEST(only_channel_0_is_heard)
{
    struct ear *ear = open_ear();
    struct lm_bus_event events[LM_BUS_EVENTS];
    struct lm_can_frame f = bus_frame(1815 + 65536, LM_CANAS_UCHAR4, 0, 0x0d010000u, 0);
    f.is_extended = true;
    assert_int_equal(lm_bus_take(&ear->bus, &f, events), 1);
    lm_live_bus_take(&ear->live, &events[0], 0);
    assert_int_equal(ear->live.set[0].parts, 0);
    free(ear);
}

/* ---- tables of the user's own ---- */

/* A value as any table may tell it, past the ranges of the built-in one. */
static void tell(struct ear *ear, struct from from, uint8_t field, int32_t value)
{
    const struct lm_bus_event event = {.field = field,
                                       .value = value,
                                       .time_us = from.time_us,
                                       .stale_ms = 3000,
                                       .dead_ms = 10000,
                                       .node = from.node,
                                       .service = from.number,
                                       .code = from.code};
    lm_live_bus_take(&ear->live, &event, from.time_us);
}

/* A ship with a height, a heading and a cross section, the number of one part as told. */
static uint32_t told_with(uint8_t field, int32_t value)
{
    static const struct {
        uint8_t field;
        int32_t value;
    } parts[] = {{LM_BUS_LIVE_LATITUDE, 1000},
                 {LM_BUS_LIVE_LONGITUDE, 2000},
                 {LM_BUS_LIVE_HEIGHT, 64},
                 {LM_BUS_LIVE_HEADING, 100},
                 {LM_BUS_LIVE_RCS, 256},
                 {LM_BUS_LIVE_KIND,
                  0x0d010000 | LM_LIVE_HAS_HEIGHT | LM_LIVE_HAS_HEADING | LM_LIVE_HAS_RCS}};
    struct ear *ear = open_ear();
    for (size_t i = 0; i < sizeof parts / sizeof *parts; i++) {
        tell(ear, (struct from){20, 5, 1, S}, parts[i].field,
             parts[i].field == field ? value : parts[i].value);
    }
    const uint32_t count = ear->live.live.count;
    assert_int_equal(ear->live.count.refused, !count);
    assert_int_equal(ear->live.count.torn, 0);
    free(ear);
    return count;
}

TEST(a_wider_table_is_held_to_the_displays_limits)
{
    static const struct {
        uint8_t field;
        int32_t last, beyond;
    } limits[] = {{LM_BUS_LIVE_LATITUDE, 1 << 30, (1 << 30) + 1},
                  {LM_BUS_LIVE_LATITUDE, -(1 << 30), -(1 << 30) - 1},
                  {LM_BUS_LIVE_HEIGHT, LM_LIVE_HEIGHT_MAX_Q6, LM_LIVE_HEIGHT_MAX_Q6 + 1},
                  {LM_BUS_LIVE_HEIGHT, -LM_LIVE_HEIGHT_MAX_Q6, INT32_MIN},
                  {LM_BUS_LIVE_HEADING, LM_LIVE_TURN_MAX, LM_LIVE_TURN_MAX + 1},
                  {LM_BUS_LIVE_RCS, 100 * 256, 100 * 256 + 1},
                  {LM_BUS_LIVE_RCS, -100 * 256, INT32_MIN},
                  {LM_BUS_LIVE_RCS, 0, 65536}};
    for (size_t i = 0; i < sizeof limits / sizeof *limits; i++) {
        assert_int_equal(told_with(limits[i].field, limits[i].last), 1);
        assert_int_equal(told_with(limits[i].field, limits[i].beyond), 0);
    }
}

/* A set that goes on with another node, code or an earlier time, or tells a part twice, begins
 * anew; one that goes on within a fifth of a second does not. */
TEST(a_set_is_of_one_node_one_code_and_a_fifth_of_a_second)
{
    static const struct {
        struct from from;
        bool is_whole;
    } next[] = {{{20, 5, 1, S}, true},          {{21, 5, 1, S}, false},
                {{20, 5, 2, S}, false},         {{20, 5, 1, S - 1}, false},
                {{20, 5, 1, S + 200000}, true}, {{20, 5, 1, S + 200001}, false}};
    for (size_t i = 0; i < sizeof next / sizeof *next; i++) {
        struct ear *ear = open_ear();
        tell(ear, (struct from){20, 5, 1, S}, LM_BUS_LIVE_LATITUDE, 1000);
        tell(ear, (struct from){20, 5, 1, S}, LM_BUS_LIVE_LONGITUDE, 1000);
        tell(ear, next[i].from, LM_BUS_LIVE_KIND, 0x0d010000);
        assert_int_equal(ear->live.live.count, next[i].is_whole);
        assert_int_equal(ear->live.count.torn, !next[i].is_whole);
        free(ear);
    }
    struct ear *ear = open_ear();
    tell(ear, (struct from){20, 5, 1, S}, LM_BUS_LIVE_LATITUDE, 1000);
    tell(ear, (struct from){20, 5, 1, S}, LM_BUS_LIVE_LATITUDE, 2000);
    tell(ear, (struct from){20, 5, 1, S}, LM_BUS_LIVE_LONGITUDE, 1000);
    tell(ear, (struct from){20, 5, 1, S}, LM_BUS_LIVE_KIND, 0x0d010000);
    assert_int_equal(ear->live.count.torn, 1);
    assert_int_equal(target(ear, 5)->position.latitude, 2000);
    free(ear);
}

/* Frames are taken by their own time, which may be a little ahead of the unit's. */
TEST(a_target_heard_a_little_ahead_of_the_clock_stays)
{
    struct ear *ear = open_ear();
    hear_small(ear, (struct from){20, 5, 1, 5 * S}, 460000000);
    age(ear, 2 * S);
    assert_int_equal(ear->live.live.count, 1);
    age(ear, 2 * S - 1);
    assert_int_equal(ear->live.live.count, 0);
    free(ear);
}

TEST(a_target_ahead_of_a_clock_that_steps_stays_as_far_ahead)
{
    struct ear *ear = open_ear();
    hear_small(ear, (struct from){20, 5, 1, 5 * S}, 460000000);
    const uint64_t ahead_us = target(ear, 5)->motion_us - 5 * S;
    assert_int_equal(ahead_us, 77);
    lm_live_bus_step_clock(&ear->live, 5 * S, 100 * S);
    assert_int_equal(target(ear, 5)->motion_us, 100 * S + ahead_us);
    free(ear);
}

TEST(what_is_of_no_live_target_is_not_taken)
{
    struct ear *ear = open_ear();
    for (int field = 0; field < LM_BUS_FIELDS; field++) {
        if (field < LM_BUS_LIVE_LATITUDE || field > LM_BUS_LIVE_CLEAR) {
            tell(ear, (struct from){20, 5, 1, S}, (uint8_t)field, 0x0d010000);
        }
    }
    assert_int_equal(ear->live.set[5].parts, 0);
    assert_int_equal(ear->live.count.removed + ear->live.count.torn, 0);
    free(ear);
}

TEST(a_part_that_comes_again_begins_its_set_anew)
{
    for (int again = 0; again < 8; again++) {
        struct ear *ear = open_ear();
        for (int part = 0; part <= again && part < 7; part++) {
            hear_part(ear, (struct from){20, 5, 1, S}, part, 46);
        }
        const int repeated = again < 7 ? again : 6;
        hear_part(ear, (struct from){20, 5, 1, S}, repeated, 47);
        assert_int_equal(ear->live.count.torn, 1);
        for (int part = repeated + 1; part < 8; part++) {
            hear_part(ear, (struct from){20, 5, 1, S}, part, 47);
        }
        assert_int_equal(ear->live.count.sets, repeated == 0);
        free(ear);
    }
}
