/* The log of tracks, fed with tracks that begin, break and end. */
#include "check.h"
#include "sim/track_log.h"

#include <math.h>
#include <stdlib.h>

static struct track_log log_of;
static struct lm_track track;
static uint64_t now_us;

static void stand(enum lm_track_state state, enum lm_track_loss loss)
{
    track.state = (uint8_t)state;
    track.loss = (uint8_t)loss;
    track_log_step(&log_of, &track, now_us);
    now_us += 1000000;
}

static void begin(enum lm_track_kind kind)
{
    track.kind = (uint8_t)kind;
    track.number++;
}

static void start(void)
{
    log_of = (struct track_log){0};
    track = (struct lm_track){0};
    now_us = 0;
    stand(LM_TRACK_OFF, LM_TRACK_SOUND);
}

TEST(a_track_is_taken_down_from_its_beginning_to_its_end)
{
    start();
    assert_int_equal(log_of.count, 0);
    begin(LM_TRACK_MOVER);
    track.seen.slant_m_q8 = 12345 * 256;
    track.seen.range_rate_mm_s = -98765;
    track.seen.speed_mm_s = 15500;
    stand(LM_TRACK_SEARCHING, LM_TRACK_NOTHING); /* 1 s */
    stand(LM_TRACK_HELD, LM_TRACK_SOUND);        /* 2 s */
    stand(LM_TRACK_COASTING, LM_TRACK_NOTCH);    /* 3 s */
    stand(LM_TRACK_COASTING, LM_TRACK_SHADOW);   /* the same gap */
    stand(LM_TRACK_HELD, LM_TRACK_SOUND);        /* 5 s */
    track.seen.slant_m_q8 = 1;                   /* not measured any more */
    stand(LM_TRACK_COASTING, LM_TRACK_LIMITS);   /* 6 s */
    stand(LM_TRACK_OFF, LM_TRACK_LIMITS);        /* 7 s */
    stand(LM_TRACK_OFF, LM_TRACK_LIMITS);
    const struct track_log_item *t = &log_of.item[0];
    assert_int_equal(log_of.count, 1);
    assert_int_equal(t->kind, LM_TRACK_MOVER);
    assert_int_equal(t->state, LM_TRACK_OFF);
    assert_int_equal(t->loss, LM_TRACK_LIMITS);
    assert_true(t->begun_s == 1 && t->held_s == 2 && t->ended_s == 7);
    assert_true(t->slant_range_m == 12345 && t->range_rate_m_s == -98.765 && t->speed_m_s == 15.5);
    assert_int_equal(t->gaps, 2);
    assert_true(t->gap[0].at_s == 3 && t->gap[0].loss == LM_TRACK_NOTCH);
    assert_true(t->gap[1].at_s == 6 && t->gap[1].loss == LM_TRACK_LIMITS);
}

TEST(a_track_that_another_replaces_is_over)
{
    start();
    begin(LM_TRACK_FIXED);
    stand(LM_TRACK_HELD, LM_TRACK_SOUND);
    begin(LM_TRACK_RANGING);
    stand(LM_TRACK_SEARCHING, LM_TRACK_NOTHING);
    assert_int_equal(log_of.count, 2);
    assert_true(log_of.item[0].state == LM_TRACK_OFF && log_of.item[0].ended_s == 2);
    assert_true(isnan(log_of.item[1].held_s) && isnan(log_of.item[1].ended_s));
    assert_true(isnan(log_of.item[1].slant_range_m));
}

TEST(what_has_no_room_is_counted)
{
    start();
    for (int i = 0; i < TRACK_LOG_MAX + 300; i++) {
        begin(LM_TRACK_FIXED);
        stand(LM_TRACK_HELD, LM_TRACK_SOUND);
        for (int k = 0; i == TRACK_LOG_MAX - 1 && k < TRACK_LOG_GAPS + 5; k++) {
            stand(LM_TRACK_COASTING, LM_TRACK_WEAK);
            stand(LM_TRACK_HELD, LM_TRACK_SOUND);
        }
    }
    const struct track_log_item *last = &log_of.item[TRACK_LOG_MAX - 1];
    assert_int_equal(log_of.count, TRACK_LOG_MAX);
    assert_int_equal(log_of.left_out, 300);
    assert_int_equal(last->gaps, TRACK_LOG_GAPS + 5);
    assert_int_equal(last->state, LM_TRACK_OFF);
    assert_true(last->ended_s == (double)(now_us / 1000000 - 300));
}
