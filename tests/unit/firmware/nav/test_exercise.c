/* The exercise clock that comes over the bus: docs/bus.md, "Exercise clock". */
#include "bus_frames.h"
#include "check.h"
#include "lm/exercise.h"

#include <math.h>

enum { S = 1000000 };

struct ear {
    struct lm_bus bus;
    struct lm_exercise exercise;
};

static struct ear open_ear(void)
{
    struct ear ear = {0};
    lm_bus_init(&ear.bus, &lm_bus_canas17);
    lm_exercise_init(&ear.exercise, 77);
    return ear;
}

static void hear_frame(struct ear *ear, const struct lm_can_frame *frame)
{
    struct lm_bus_event events[LM_BUS_EVENTS];
    const uint32_t count = lm_bus_take(&ear->bus, frame, events);
    for (uint32_t i = 0; i < count; i++) {
        lm_exercise_take(&ear->exercise, &events[i]);
    }
}

static void hear(struct ear *ear, uint8_t node, uint32_t id, double value, uint64_t time_us)
{
    const bool is_rate = id == 1821;
    struct lm_can_frame f =
        bus_frame(id, is_rate ? LM_CANAS_FLOAT : LM_CANAS_LONG, 0,
                  is_rate ? bus_float_bits(value) : (uint32_t)(int32_t)value, time_us);
    f.data[0] = node;
    hear_frame(ear, &f);
}

static uint64_t time_at(struct ear *ear, uint64_t now_us)
{
    lm_exercise_at(&ear->exercise, now_us);
    return ear->exercise.time_us;
}

TEST(without_a_clock_it_is_the_time_since_the_start_and_the_boards_seed)
{
    struct ear ear = open_ear();
    assert_int_equal(time_at(&ear, 0), 0);
    assert_int_equal(time_at(&ear, 123456789), 123456789);
    assert_int_equal(time_at(&ear, 5), 5);
    assert_int_equal(ear.exercise.seed, 77);
    assert_false(ear.exercise.is_told || ear.exercise.is_stale);
}

TEST(between_two_frames_it_runs_by_the_units_clock_at_the_told_rate)
{
    struct ear ear = open_ear();
    hear(&ear, 30, 1820, 3600000, 5 * S);
    assert_int_equal(time_at(&ear, 5 * S), 3600ull * S);
    assert_int_equal(time_at(&ear, 5 * S + 700001), 3600ull * S + 700001);
    hear(&ear, 30, 1821, 0.5, 6 * S);
    assert_int_equal(time_at(&ear, 6 * S), 3601ull * S);
    assert_int_equal(time_at(&ear, 7 * S), 3601ull * S + S / 2);
    hear(&ear, 30, 1821, 16, 7 * S);
    assert_int_equal(time_at(&ear, 8 * S), 3601ull * S + S / 2 + 16 * S);
}

/* However long ago the last time was told, a rate of 0 keeps it, to the microsecond. */
TEST(a_clock_that_stands_shows_the_told_time_whichever_it_was_before)
{
    struct ear ear = open_ear();
    hear(&ear, 30, 1820, 10000, S);
    hear(&ear, 30, 1821, 0, 2 * S + 3000); /* late by 3 ms */
    assert_int_equal(time_at(&ear, 2 * S + 5000), 11 * S + 3000);
    hear(&ear, 30, 1820, 11000, 3 * S);
    assert_int_equal(time_at(&ear, 3 * S), 11 * S);
    assert_int_equal(time_at(&ear, 5 * S), 11 * S);
}

TEST(a_step_is_taken_at_once_either_way_and_counted)
{
    struct ear ear = open_ear();
    hear(&ear, 30, 1820, 10000, S);
    assert_int_equal(ear.exercise.count.steps, 0); /* the first is none */
    hear(&ear, 30, 1820, 500000, 2 * S);
    assert_int_equal(time_at(&ear, 2 * S), 500ull * S);
    hear(&ear, 30, 1820, 0, 3 * S);
    assert_int_equal(time_at(&ear, 3 * S), 0);
    assert_int_equal(ear.exercise.count.steps, 2);
}

/* 40 ms back by a late frame: the clock stands until its time has come. Forward it goes at once. */
TEST(jitter_never_turns_the_clock_back)
{
    struct ear ear = open_ear();
    hear(&ear, 30, 1820, 10000, S);
    uint64_t last_us = time_at(&ear, S);
    for (uint64_t now_us = S; now_us < 5 * S; now_us += 4000) {
        if (now_us % S == 40000) {
            hear(&ear, 30, 1820, 10000 + (double)(now_us - 40000 - S) / 1000, now_us);
        }
        const uint64_t is_us = time_at(&ear, now_us);
        assert_true(is_us >= last_us);
        assert_in_range(is_us + 40000 - (9 * S + now_us), 0, 40000);
        last_us = is_us;
    }
    hear(&ear, 30, 1820, 14000, 5 * S - 40000);
    assert_int_equal(time_at(&ear, 5 * S), 14 * S + 40000);
    assert_int_equal(ear.exercise.count.steps, 0);
}

TEST(a_silent_clock_is_flagged_and_runs_on)
{
    struct ear ear = open_ear();
    hear(&ear, 30, 1820, 0, S);
    time_at(&ear, 4 * S);
    assert_false(ear.exercise.is_stale);
    hear(&ear, 30, 1821, 1, 4 * S); /* a rate tells no time */
    assert_int_equal(time_at(&ear, 4 * S + 1), 3 * S + 1);
    assert_true(ear.exercise.is_stale);
    assert_int_equal(time_at(&ear, 400ull * S), 399ull * S);
    hear(&ear, 30, 1820, 399000, 400ull * S);
    time_at(&ear, 400ull * S);
    assert_false(ear.exercise.is_stale);
}

TEST(a_second_clock_is_heard_only_when_the_first_is_silent)
{
    struct ear ear = open_ear();
    hear(&ear, 30, 1820, 10000, S);
    hear(&ear, 31, 1820, 90000, S + 1);
    hear(&ear, 31, 1821, 0, S + 2);
    hear(&ear, 31, 1822, 5, S + 3);
    assert_int_equal(time_at(&ear, 2 * S), 11 * S);
    assert_int_equal(ear.exercise.seed, 77);
    assert_int_equal(ear.exercise.count.rivals, 3);
    hear(&ear, 31, 1820, 90000, 4 * S + 1);
    hear(&ear, 30, 1822, 6, 4 * S + 2);
    hear(&ear, 31, 1822, 5, 4 * S + 2);
    assert_int_equal(time_at(&ear, 4 * S + 1), 90 * S);
    assert_int_equal(ear.exercise.seed, 5);
}

TEST(what_is_out_of_range_or_from_another_channel_changes_nothing)
{
    struct ear ear = open_ear();
    hear(&ear, 30, 1820, -1, S);
    hear(&ear, 30, 1821, 16.1, S);
    hear(&ear, 30, 1821, -0.1, S);
    hear(&ear, 30, 1821, NAN, S);
    hear(&ear, 30, 1822, -1, S);
    struct lm_can_frame f = bus_frame(1820, LM_CANAS_LONG, 0, 1000, S);
    f.is_extended = true;
    f.id += 65536;
    hear_frame(&ear, &f);
    assert_int_equal(time_at(&ear, S), S);
    const struct lm_bus_event wild = {.field = LM_BUS_EXERCISE_RATE, .value = 16 * 256 + 1};
    lm_exercise_take(&ear.exercise, &wild); /* from a table of a user's own */
    assert_int_equal(ear.exercise.rate_q8, 256);
    assert_false(ear.exercise.is_told);
}

TEST(a_clock_of_the_frames_that_is_set_back_stands_and_does_not_wrap)
{
    struct ear ear = open_ear();
    hear(&ear, 30, 1820, 10000, 1000ull * S);
    assert_int_equal(time_at(&ear, S), 10 * S);
    assert_false(ear.exercise.is_stale);
}
