/* Rain and jammers that come over the bus: docs/bus.md, "Weather". */
#include "bus_frames.h"
#include "check.h"
#include "hs/angle.h"
#include "lm/status.h"
#include "lm/weather_bus.h"

#include <math.h>
#include <stdlib.h>

enum { S = 1000000 };

struct ear {
    struct lm_bus bus;
    struct lm_weather_bus weather;
    struct lm_environment e;
    bool is_stale;
};

static void open_ear(struct ear *ear)
{
    *ear = (struct ear){0};
    lm_bus_init(&ear->bus, &lm_bus_canas17);
}

static void hear_frame(struct ear *ear, const struct lm_can_frame *frame)
{
    struct lm_bus_event events[LM_BUS_EVENTS];
    const uint32_t count = lm_bus_take(&ear->bus, frame, events);
    for (uint32_t i = 0; i < count; i++) {
        lm_weather_bus_take(&ear->weather, &events[i]);
    }
}

struct from {
    uint8_t node, number, code;
    uint64_t time_us;
};

static void hear(struct ear *ear, struct from from, uint32_t id, double value)
{
    struct lm_can_frame f =
        bus_frame(id, LM_CANAS_FLOAT, from.code, bus_float_bits(value), from.time_us);
    f.data[0] = from.node;
    f.data[2] = from.number;
    hear_frame(ear, &f);
}

static void hear_rain(struct ear *ear, struct from from, double latitude, double mm_per_h)
{
    hear(ear, from, 1800, latitude);
    hear(ear, from, 1801, 11);
    hear(ear, from, 1802, 5000);
    hear(ear, from, 1803, mm_per_h);
}

static void hear_clear(struct ear *ear, uint8_t mask, uint64_t time_us)
{
    struct lm_can_frame f = bus_frame(1807, LM_CANAS_UCHAR, 0, (uint32_t)mask << 24, time_us);
    f.length = 5;
    hear_frame(ear, &f);
}

static void look(struct ear *ear, uint64_t now_us)
{
    ear->e = (struct lm_environment){0};
    ear->is_stale = lm_weather_bus_at(&ear->weather, now_us, &ear->e);
    assert_int_equal(lm_environment_check(&ear->e), LM_OK);
}

TEST(four_frames_make_a_circle_and_three_a_jammer)
{
    struct ear ear;
    open_ear(&ear);
    hear_rain(&ear, (struct from){20, 2, 7, S}, 46, 30.4);
    const struct from other = {20, 1, 3, S};
    hear(&ear, other, 1806, 24.5);
    hear(&ear, other, 1805, -170);
    hear(&ear, other, 1804, -46);
    look(&ear, S);
    assert_int_equal(ear.e.rain_count, 1);
    assert_int_equal(ear.e.jammer_count, 1);
    assert_int_equal(ear.e.rain[0].centre.latitude, hs_bam(46));
    assert_int_equal(ear.e.rain[0].centre.longitude, hs_bam(11));
    assert_int_equal(ear.e.rain[0].radius_m, 5000);
    assert_int_equal(ear.e.rain[0].mm_per_h, 30);
    assert_int_equal(ear.e.jammer[0].position.latitude, hs_bam(-46));
    assert_int_equal(ear.e.jammer[0].position.longitude, hs_bam(-170));
    assert_int_equal(ear.e.jammer[0].noise_ratio_db_q8, 24 * 256 + 128);
    assert_int_equal(ear.weather.count.sets, 2);
    assert_false(ear.is_stale);
}

/* In any order, and LONG of 1e-7 degree as well. */
TEST(places_come_as_long_too)
{
    struct ear ear;
    open_ear(&ear);
    const struct from from = {20, 0, 1, 0};
    struct lm_can_frame f = bus_frame(1801, LM_CANAS_LONG, 1, 110000000, 0);
    f.data[0] = 20;
    hear(&ear, from, 1803, 10);
    hear_frame(&ear, &f);
    hear(&ear, from, 1802, 100);
    hear(&ear, from, 1800, 46);
    look(&ear, 0);
    assert_int_equal(ear.e.rain_count, 1);
    assert_int_equal(ear.e.rain[0].centre.longitude, hs_bam(11));
}

/* Move a circle: with any of its frames lost, it stays where it was, whole. */
TEST(no_circle_is_ever_half_new)
{
    static const double before[] = {46, 11, 5000, 30}, after[] = {47, 12, 9000, 60};
    for (uint32_t lost = 0; lost < 4; lost++) {
        struct ear ear;
        open_ear(&ear);
        for (uint32_t i = 0; i < 4; i++) {
            hear(&ear, (struct from){20, 0, 1, 0}, 1800 + i, before[i]);
        }
        for (uint8_t set = 2; set < 4; set++) {
            for (uint32_t i = 0; i < 4; i++) {
                if (set == 3 || i != lost) {
                    hear(&ear, (struct from){20, 0, set, S * (set - 1ull)}, 1800 + i, after[i]);
                }
                look(&ear, 2 * S);
                const struct lm_rain *r = &ear.e.rain[0];
                const bool is_new = set == 3 && i == 3;
                assert_int_equal(ear.e.rain_count, 1);
                assert_int_equal(r->centre.latitude, hs_bam(is_new ? 47 : 46));
                assert_int_equal(r->centre.longitude, hs_bam(is_new ? 12 : 11));
                assert_int_equal(r->radius_m, is_new ? 9000 : 5000);
                assert_int_equal(r->mm_per_h, is_new ? 60 : 30);
            }
        }
        assert_int_equal(ear.weather.count.torn, 1);
    }
}

/* A sender that never counts: a value that comes twice begins a set. */
TEST(a_set_is_not_made_of_two)
{
    struct ear ear;
    open_ear(&ear);
    const struct from from = {20, 0, 0, 0};
    hear(&ear, from, 1800, 46);
    hear(&ear, from, 1801, 11);
    hear(&ear, from, 1800, 47);
    hear(&ear, from, 1802, 5000);
    hear(&ear, from, 1803, 30);
    look(&ear, 0);
    assert_int_equal(ear.e.rain_count, 0);
    hear(&ear, from, 1801, 12);
    look(&ear, 0);
    assert_int_equal(ear.e.rain_count, 1);
    assert_int_equal(ear.e.rain[0].centre.latitude, hs_bam(47));
    assert_int_equal(ear.weather.count.torn, 1);
    /* Nor of frames that are more than a second apart, */
    hear(&ear, (struct from){20, 1, 5, S}, 1800, 46);
    hear(&ear, (struct from){20, 1, 5, S}, 1801, 11);
    hear(&ear, (struct from){20, 1, 5, S}, 1802, 5000);
    hear(&ear, (struct from){20, 1, 5, 2 * S + 1}, 1803, 30);
    /* or of two senders, or of two numbers. */
    hear(&ear, (struct from){20, 2, 5, S}, 1800, 46);
    hear(&ear, (struct from){21, 2, 5, S}, 1801, 11);
    hear(&ear, (struct from){21, 2, 5, S}, 1802, 5000);
    hear(&ear, (struct from){21, 2, 5, S}, 1803, 30);
    hear(&ear, (struct from){22, 3, 5, S}, 1800, 46);
    hear(&ear, (struct from){22, 3, 5, S}, 1801, 11);
    hear(&ear, (struct from){22, 3, 5, S}, 1802, 5000);
    hear(&ear, (struct from){22, 2, 5, S}, 1803, 30);
    look(&ear, 2 * S);
    assert_int_equal(ear.e.rain_count, 1);
}

TEST(a_storm_that_is_not_told_anew_is_flagged_after_3_s_and_gone_after_10)
{
    struct ear ear;
    open_ear(&ear);
    hear_rain(&ear, (struct from){20, 0, 1, S}, 46, 30);
    look(&ear, 4 * S);
    assert_int_equal(ear.e.rain_count, 1);
    assert_false(ear.is_stale);
    look(&ear, 4 * S + 1);
    assert_int_equal(ear.e.rain_count, 1);
    assert_true(ear.is_stale);
    hear_rain(&ear, (struct from){20, 1, 1, 9 * S}, 47, 30);
    look(&ear, 11 * S);
    assert_int_equal(ear.e.rain_count, 2);
    look(&ear, 11 * S + 1);
    assert_int_equal(ear.e.rain_count, 1);
    assert_int_equal(ear.e.rain[0].centre.latitude, hs_bam(47));
    assert_false(ear.is_stale);
    hear_rain(&ear, (struct from){20, 0, 2, 12 * S}, 46, 30);
    look(&ear, 12 * S);
    assert_int_equal(ear.e.rain_count, 2);
    look(&ear, 1); /* the clock was set back */
    assert_int_equal(ear.e.rain_count, 0);
}

TEST(clearing_takes_what_its_bits_say)
{
    struct ear ear;
    open_ear(&ear);
    for (uint8_t n = 0; n < 4; n++) {
        hear_rain(&ear, (struct from){20, n, n, 0}, 40 + n, 30);
        hear(&ear, (struct from){20, n, n, 0}, 1804, 40);
        hear(&ear, (struct from){20, n, n, 0}, 1805, 40);
        hear(&ear, (struct from){20, n, n, 0}, 1806, n);
    }
    look(&ear, 0);
    assert_int_equal(ear.e.rain_count, 4);
    assert_int_equal(ear.e.jammer_count, 4);
    hear(&ear, (struct from){20, 0, 9, 0}, 1800, 45);
    hear_clear(&ear, 0x85, 0);
    hear(&ear, (struct from){20, 0, 9, 0}, 1801, 11); /* the rest of a set that was cleared */
    hear(&ear, (struct from){20, 0, 9, 0}, 1802, 5000);
    hear(&ear, (struct from){20, 0, 9, 0}, 1803, 30);
    look(&ear, 0);
    assert_int_equal(ear.e.rain_count, 2);
    assert_int_equal(ear.e.rain[0].centre.latitude, hs_bam(41));
    assert_int_equal(ear.e.rain[1].centre.latitude, hs_bam(43));
    assert_int_equal(ear.e.jammer_count, 3);
    assert_int_equal(ear.e.jammer[2].noise_ratio_db_q8, 2 * 256);
    hear_clear(&ear, 0xff, 0);
    look(&ear, 0);
    assert_int_equal(ear.e.rain_count + ear.e.jammer_count, 0);
}

TEST(what_is_out_of_range_is_refused_and_counted)
{
    static const struct {
        uint32_t id;
        double value;
    } bad[] = {{1800, 90.1}, {1801, 181}, {1802, 99},    {1802, 100001}, {1803, 0.9},
               {1803, 151},  {1803, NAN}, {1804, -90.1}, {1806, 80.1},   {1806, -21}};
    struct ear ear;
    open_ear(&ear);
    hear_rain(&ear, (struct from){20, 0, 1, 0}, 46, 30);
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        const struct from from = {20, 0, (uint8_t)(2 + i), 0};
        for (uint32_t id = 1800; id < 1804; id++) {
            static const double good[] = {47, 12, 9000, 60};
            hear(&ear, from, id, id == bad[i].id ? bad[i].value : good[id - 1800]);
        }
        if (bad[i].id >= 1804) {
            open_ear(&ear);
            hear(&ear, from, 1804, bad[i].id == 1804 ? bad[i].value : 0);
            hear(&ear, from, 1805, 0);
            hear(&ear, from, 1806, bad[i].id == 1806 ? bad[i].value : 0);
        }
        look(&ear, 0);
        assert_int_equal(ear.e.jammer_count, 0);
        assert_true(ear.e.rain_count == 0 || ear.e.rain[0].mm_per_h == 30);
        assert_true(ear.bus.count.outcome[LM_BUS_OUT_OF_RANGE] +
                        ear.bus.count.outcome[LM_BUS_NOT_A_NUMBER] >
                    0);
    }
    open_ear(&ear);
    hear_rain(&ear, (struct from){20, 4, 1, 0}, 46, 30);
    hear(&ear, (struct from){20, 255, 1, 0}, 1804, 0);
    assert_int_equal(ear.weather.count.numbers, 5);
}

/* A table of the user's own may believe more than the display can show. */
TEST(a_wider_table_is_held_to_the_displays_limits)
{
    static const uint8_t fields[] = {LM_BUS_JAMMER_LATITUDE, LM_BUS_JAMMER_LONGITUDE,
                                     LM_BUS_JAMMER_RATIO};
    struct lm_weather_bus w = {0};
    for (uint8_t i = 0; i < 3; i++) {
        const struct lm_bus_event event = {.field = fields[i],
                                           .value = i == 2 ? 65536 + 20 * 256 : 0};
        lm_weather_bus_take(&w, &event);
    }
    struct lm_environment e = {0};
    lm_weather_bus_at(&w, 0, &e);
    assert_int_equal(e.jammer_count, 0);
    assert_int_equal(w.count.refused, 1);
}

TEST(a_second_sender_is_heard_when_the_first_is_stale)
{
    struct ear ear;
    open_ear(&ear);
    hear_rain(&ear, (struct from){20, 0, 1, 0}, 46, 30);
    hear_rain(&ear, (struct from){21, 0, 1, S}, 47, 30);
    look(&ear, S);
    assert_int_equal(ear.e.rain[0].centre.latitude, hs_bam(46));
    assert_int_equal(ear.weather.count.rivals, 4);
    hear_rain(&ear, (struct from){21, 0, 2, 4 * S}, 47, 30);
    look(&ear, 4 * S);
    assert_int_equal(ear.e.rain[0].centre.latitude, hs_bam(47));
}

TEST(a_redundant_channel_tears_no_set)
{
    struct ear ear;
    open_ear(&ear);
    static const double values[] = {46, 11, 5000, 30};
    for (uint32_t i = 0; i < 4; i++) {
        const struct from from = {20, 0, 1, 0};
        struct lm_can_frame twin =
            bus_frame(65536 + 1800 + i, LM_CANAS_FLOAT, 1, bus_float_bits(values[i]), 0);
        twin.is_extended = true;
        twin.data[0] = 20;
        hear(&ear, from, 1800 + i, values[i]);
        hear_frame(&ear, &twin);
    }
    look(&ear, 0);
    assert_int_equal(ear.bus.count.outcome[LM_BUS_VALUE], 8);
    assert_int_equal(ear.e.rain_count, 1);
    assert_int_equal(ear.weather.count.torn, 0);
}

TEST(what_is_there_already_stands_before_the_buss)
{
    struct ear ear;
    open_ear(&ear);
    hear_rain(&ear, (struct from){20, 0, 1, 0}, 46, 30);
    hear_rain(&ear, (struct from){20, 1, 1, 0}, 47, 30);
    struct lm_environment e = {.rain_count = 3, .rain = {{.mm_per_h = 1}}, .sea_state = 5};
    lm_weather_bus_at(&ear.weather, 0, &e);
    assert_int_equal(e.rain_count, 4);
    assert_int_equal(e.rain[0].mm_per_h, 1);
    assert_int_equal(e.rain[3].centre.latitude, hs_bam(46));
    assert_int_equal(e.sea_state, 5);
}

/* ---- the sea ---- */

static void hear_state(struct ear *ear, uint8_t node, uint8_t state, uint64_t time_us)
{
    struct lm_can_frame f = bus_frame(1808, LM_CANAS_UCHAR, 0, (uint32_t)state << 24, time_us);
    f.length = 5;
    f.data[0] = node;
    hear_frame(ear, &f);
}

TEST(the_sea_state_and_the_wind_come_by_themselves)
{
    struct ear ear;
    open_ear(&ear);
    look(&ear, 0);
    assert_int_equal(ear.e.sea_state, 0);
    assert_false(ear.e.has_wind);
    hear_state(&ear, 20, 6, S);
    look(&ear, S);
    assert_int_equal(ear.e.sea_state, 6);
    assert_false(ear.e.has_wind);
    hear(&ear, (struct from){20, 0, 0, S}, 1809, 270);
    look(&ear, S);
    assert_true(ear.e.has_wind);
    assert_int_equal(ear.e.wind_from, hs_bam(270));
    hear(&ear, (struct from){20, 0, 0, S}, 1809, -45);
    look(&ear, S);
    assert_int_equal(ear.e.wind_from, hs_bam(315));
    hear_state(&ear, 20, 9, S); /* out of the row's range */
    look(&ear, S);
    assert_int_equal(ear.e.sea_state, 6);
    hear_clear(&ear, 0x7f, S);
    look(&ear, S);
    assert_int_equal(ear.e.sea_state, 6);
    hear_clear(&ear, 0xff, S);
    look(&ear, S);
    assert_int_equal(ear.e.sea_state, 0);
    assert_false(ear.e.has_wind);
}

TEST(the_aircrafts_own_wind_counts_where_nobody_tells_that_of_the_sea)
{
    struct ear ear;
    open_ear(&ear);
    hear(&ear, (struct from){2, 0, 0, S}, 334, 90);
    look(&ear, S);
    assert_int_equal(ear.e.wind_from, hs_bam(90));
    hear(&ear, (struct from){20, 0, 0, S}, 1809, 180);
    hear(&ear, (struct from){2, 0, 1, 2 * S}, 334, 95);
    look(&ear, 2 * S);
    assert_int_equal(ear.e.wind_from, hs_bam(180));
    assert_int_equal(ear.weather.count.rivals, 0);
    hear(&ear, (struct from){21, 0, 0, 2 * S}, 1809, 10);
    assert_int_equal(ear.weather.count.rivals, 1);
    hear(&ear, (struct from){2, 0, 2, 4 * S + 1}, 334, 100); /* the exercise's is stale */
    look(&ear, 4 * S + 1);
    assert_int_equal(ear.e.wind_from, hs_bam(100));
}

TEST(a_sea_that_is_not_told_anew_is_flagged_after_3_s_and_gone_after_10)
{
    struct ear ear;
    open_ear(&ear);
    hear_state(&ear, 20, 5, S);
    look(&ear, 4 * S);
    assert_false(ear.is_stale);
    look(&ear, 4 * S + 1);
    assert_int_equal(ear.e.sea_state, 5);
    assert_true(ear.is_stale);
    look(&ear, 11 * S + 1);
    assert_int_equal(ear.e.sea_state, 0);
    assert_false(ear.is_stale);
}

TEST(a_commanded_sea_stands_before_the_buss)
{
    struct ear ear;
    open_ear(&ear);
    hear_state(&ear, 20, 5, 0);
    hear(&ear, (struct from){20, 0, 0, 0}, 1809, 180);
    struct lm_environment e = {.sea_state = 2, .is_sea_commanded = true};
    lm_weather_bus_at(&ear.weather, 0, &e);
    assert_int_equal(e.sea_state, 2);
    assert_int_equal(e.wind_from, hs_bam(180)); /* the command has none */
    e = (struct lm_environment){
        .sea_state = 2, .is_sea_commanded = true, .has_wind = true, .wind_from = 7};
    assert_false(lm_weather_bus_at(&ear.weather, 9 * S, &e)); /* stale, and not used */
    assert_int_equal(e.wind_from, 7);
}

TEST(a_state_that_a_wider_table_believes_is_refused)
{
    struct lm_weather_bus w = {0};
    const int32_t bad[] = {-1, 9, INT32_MAX, INT32_MIN};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        const struct lm_bus_event event = {
            .field = LM_BUS_SEA_STATE, .value = bad[i], .stale_ms = 1000, .dead_ms = 1000};
        struct lm_environment e = {.sea_state = 3};
        lm_weather_bus_take(&w, &event);
        lm_weather_bus_at(&w, 0, &e);
        assert_int_equal(e.sea_state, 3);
    }
    assert_int_equal(w.count.refused, 4);
}

/* ---- sets and ages, value by value ---- */

static void tell(struct lm_weather_bus *w, struct from from, uint8_t field, int32_t value)
{
    const struct lm_bus_event event = {.field = field,
                                       .value = value,
                                       .time_us = from.time_us,
                                       .stale_ms = 3000,
                                       .dead_ms = 10000,
                                       .node = from.node,
                                       .service = from.number,
                                       .code = from.code};
    lm_weather_bus_take(w, &event);
}

TEST(a_set_is_of_one_node_one_code_and_a_fifth_of_a_second)
{
    static const struct {
        struct from from;
        bool is_whole;
    } next[] = {{{20, 0, 1, S}, true},
                {{21, 0, 1, S}, false},
                {{20, 0, 2, S}, false},
                {{20, 0, 1, S - 1}, false},
                {{20, 0, 1, S + LM_WEATHER_SET_US}, true},
                {{20, 0, 1, S + LM_WEATHER_SET_US + 1}, false}};
    for (size_t i = 0; i < sizeof next / sizeof *next; i++) {
        struct lm_weather_bus w = {0};
        tell(&w, (struct from){20, 0, 1, S}, LM_BUS_JAMMER_LATITUDE, 1000);
        tell(&w, (struct from){20, 0, 1, S}, LM_BUS_JAMMER_LONGITUDE, 1000);
        tell(&w, next[i].from, LM_BUS_JAMMER_RATIO, 20 * 256);
        assert_int_equal(w.count.sets, next[i].is_whole);
        assert_int_equal(w.count.torn, !next[i].is_whole);
    }
}

TEST(a_wind_or_storm_that_is_old_is_flagged_and_a_commanded_one_is_not)
{
    for (int is_wind = 0; is_wind < 2; is_wind++) {
        struct lm_weather_bus w = {0};
        tell(&w, (struct from){20, 0, 1, S}, is_wind ? LM_BUS_WIND_DIRECTION : LM_BUS_SEA_STATE, 3);
        struct lm_environment e = {0};
        assert_false(lm_weather_bus_at(&w, 4 * S, &e));
        e = (struct lm_environment){0};
        assert_true(lm_weather_bus_at(&w, 4 * S + 1, &e));
        assert_int_equal(e.has_wind, is_wind);
        e = (struct lm_environment){.is_sea_commanded = true, .has_wind = true};
        assert_false(lm_weather_bus_at(&w, 4 * S + 1, &e));
        e = (struct lm_environment){0};
        assert_false(lm_weather_bus_at(&w, 11 * S + 1, &e));
        assert_false(e.has_wind);
        /* A clock that is a little behind the frames, and one that was set back. */
        tell(&w, (struct from){20, 0, 1, 20 * S},
             is_wind ? LM_BUS_WIND_DIRECTION : LM_BUS_SEA_STATE, 3);
        e = (struct lm_environment){0};
        lm_weather_bus_at(&w, 17 * S, &e);
        assert_int_equal(e.has_wind ? 3 : e.sea_state, 3);
        e = (struct lm_environment){0};
        lm_weather_bus_at(&w, 17 * S - 1, &e);
        assert_int_equal(e.has_wind ? 3 : e.sea_state, 0);
    }
}

TEST(there_are_no_more_jammers_than_an_environment_holds)
{
    struct lm_weather_bus w = {0};
    for (uint8_t n = 0; n < LM_JAMMERS_MAX; n++) {
        tell(&w, (struct from){20, n, 1, S}, LM_BUS_JAMMER_LATITUDE, 1000);
        tell(&w, (struct from){20, n, 1, S}, LM_BUS_JAMMER_LONGITUDE, 1000);
        tell(&w, (struct from){20, n, 1, S}, LM_BUS_JAMMER_RATIO, 20 * 256);
    }
    struct lm_environment e = {.jammer_count = 1, .jammer = {{.noise_ratio_db_q8 = 77}}};
    lm_weather_bus_at(&w, S, &e);
    assert_int_equal(e.jammer_count, LM_JAMMERS_MAX);
    assert_int_equal(e.jammer[0].noise_ratio_db_q8, 77);
    assert_int_equal(lm_environment_check(&e), LM_OK);
}
