/* The gateway: who becomes a target, what is sent when, and how much of the bus it takes. */
#include "check.h"
#include "dis/gateway.h"
#include "make_pdu.h"

#include <math.h>
#include <string.h>

enum { SENT_MAX = 20000, SECOND_US = 1000000, STEP_US = 5000 };

static struct {
    struct lm_can_frame frame[SENT_MAX];
    int64_t time_us[SENT_MAX];
    int count;
} sent;

static struct dis_kinds kinds;
static struct dis_gateway *gateway;
static int64_t now_us;

static bool note(void *context, const struct lm_can_frame *frame, int64_t time_us)
{
    (void)context;
    assert_true(sent.count < SENT_MAX);
    assert_true(sent.count == 0 || time_us > sent.time_us[sent.count - 1]);
    sent.frame[sent.count] = *frame;
    sent.time_us[sent.count++] = time_us;
    return true;
}

static void begin(const struct dis_settings *settings)
{
    const struct dis_sink sink = {note, NULL};
    dis_gateway_free(gateway);
    assert_int_equal(dis_kinds_read_builtin(&kinds), 0);
    gateway = dis_gateway_new(settings, &kinds, &sink);
    assert_non_null(gateway);
    sent.count = 0;
    now_us = 100 * SECOND_US;
    dis_gateway_step(gateway, now_us);
}

static int end(void **state)
{
    (void)state;
    dis_gateway_free(gateway);
    gateway = NULL;
    return 0;
}

#define GATEWAY_TEST(name) TEST_WITH(name, NULL, end)

static void give(const struct made *m)
{
    dis_gateway_take(gateway, m->bytes, m->length, now_us);
    dis_gateway_step(gateway, now_us);
}

static void give_vehicle(const struct made_entity *e)
{
    struct made m = {.length = 0};
    made_entity_state(&m, e);
    give(&m);
}

static void wait_s(double seconds)
{
    const int64_t until_us = now_us + llround(seconds * 1e6);
    while (now_us < until_us) {
        now_us += STEP_US;
        dis_gateway_step(gateway, now_us);
    }
}

static int sent_of(uint32_t id)
{
    int n = 0;
    for (int i = 0; i < sent.count; i++) {
        n += sent.frame[i].id == id;
    }
    return n;
}

static const struct dis_counts *counts(void)
{
    return dis_gateway_counts(gateway);
}

GATEWAY_TEST(a_vehicle_is_told_at_once_then_once_a_second_and_removed_when_silent)
{
    const struct dis_settings s = dis_settings_usual();
    const struct made_entity e = made_vehicle(1);
    begin(&s);
    give_vehicle(&e);
    assert_int_equal(sent_of(1815), 1);
    assert_int_equal(sent.time_us[0], now_us);
    wait_s(11);
    assert_true(sent_of(1815) >= 11 && sent_of(1815) <= 12 && sent_of(1817) == 0);
    wait_s(2);
    assert_int_equal(sent_of(1817), 1);
    const int before = sent.count;
    wait_s(5);
    assert_int_equal(sent.count, before);
    assert_true(counts()->timed_out == 1 && counts()->targets == 0);
}

GATEWAY_TEST(frames_of_a_set_have_one_code_and_the_next_set_the_next)
{
    const struct dis_settings s = dis_settings_usual();
    const struct made_entity e = made_vehicle(1);
    begin(&s);
    give_vehicle(&e);
    wait_s(300e-3);
    const int first = sent.count;
    for (int i = 0; i < first; i++) {
        assert_true(sent.frame[i].data[3] == 0 && sent.frame[i].data[2] == 0);
    }
    wait_s(1);
    for (int i = first; i < sent.count; i++) {
        assert_int_equal(sent.frame[i].data[3], 1);
    }
    assert_int_equal(sent.count, 2 * first);
}

GATEWAY_TEST(a_state_that_the_display_foresaw_sends_nothing_and_a_surprise_is_sent_at_once)
{
    const struct dis_settings s = dis_settings_usual();
    struct made_entity e = made_vehicle(1);
    e.velocity[1] = 10;
    begin(&s);
    give_vehicle(&e);
    wait_s(0.5);
    const int before = sent.count;
    e.place[1] = 5; /* where 10 m/s lead in half a second */
    give_vehicle(&e);
    assert_int_equal(sent.count, before);
    e.place[1] = 8;
    give_vehicle(&e);
    assert_true(sent.count > before && counts()->changed_sets == 1);
}

GATEWAY_TEST(a_vehicle_that_turns_away_is_a_surprise_too)
{
    const struct dis_settings s = dis_settings_usual();
    struct made_entity e = made_vehicle(1);
    begin(&s);
    give_vehicle(&e);
    e.orientation[1] = -0.1F; /* 5.7 degrees towards the north */
    give_vehicle(&e);
    assert_int_equal(counts()->changed_sets, 1);
}

GATEWAY_TEST(an_update_moves_what_is_known_and_nothing_else)
{
    const struct dis_settings s = dis_settings_usual();
    struct made_entity e = made_vehicle(1);
    struct made m = {.length = 0};
    begin(&s);
    made_update(&m, &e);
    give(&m);
    assert_true(counts()->update_of_unknown == 1 && sent.count == 0);
    give_vehicle(&e);
    e.place[2] = 50;
    m.length = 0;
    made_update(&m, &e);
    give(&m);
    assert_int_equal(counts()->changed_sets, 1);
}

GATEWAY_TEST(filters_keep_out_other_exercises_sites_and_the_ownship)
{
    struct dis_settings s = dis_settings_usual();
    s.exercises = (struct dis_filter){{3, 4}, 2};
    s.sites = (struct dis_filter){{11}, 1};
    s.has_ownship = true;
    s.ownship = (struct dis_id){11, 22, 7};
    begin(&s);
    struct made_entity e = made_vehicle(1);
    give_vehicle(&e); /* exercise 1 */
    e.exercise = 4;
    e.id[0] = 12;
    give_vehicle(&e);
    e.id[0] = 11;
    e.id[2] = 7;
    give_vehicle(&e);
    assert_int_equal(sent.count, 0);
    assert_true(counts()->other_exercise == 1 && counts()->other_site == 1 &&
                counts()->ownship == 1 && counts()->entities == 0);
    e.id[2] = 8;
    give_vehicle(&e);
    assert_int_equal(sent_of(1815), 1);
}

GATEWAY_TEST(a_deactivated_entity_is_removed_at_once)
{
    const struct dis_settings s = dis_settings_usual();
    struct made_entity e = made_vehicle(1);
    begin(&s);
    give_vehicle(&e);
    e.appearance = 1U << 23;
    give_vehicle(&e);
    assert_true(sent_of(1817) == 1 && counts()->deactivated == 1);
    wait_s(2);
    assert_int_equal(sent_of(1815), 1);
}

GATEWAY_TEST(who_stays_is_still_known_when_others_leave)
{
    const struct dis_settings s = dis_settings_usual();
    struct made_entity e = made_vehicle(1);
    begin(&s);
    for (uint16_t i = 1; i <= 40; i++) {
        e.id[2] = i;
        give_vehicle(&e);
    }
    e.appearance = 1U << 23;
    for (uint16_t i = 1; i <= 40; i += 3) {
        e.id[2] = i;
        give_vehicle(&e);
    }
    e.appearance = 0;
    for (uint16_t i = 2; i <= 40; i += 3) {
        e.id[2] = i;
        give_vehicle(&e);
    }
    assert_true(counts()->entities == 40 && counts()->deactivated == 14);
    assert_int_equal(dis_gateway_entities(gateway), 26);
}

GATEWAY_TEST(what_the_table_skips_or_does_not_know_is_counted_once)
{
    const struct dis_settings s = dis_settings_usual();
    struct made_entity e = made_vehicle(1);
    e.domain = 4;
    begin(&s);
    give_vehicle(&e);
    give_vehicle(&e);
    assert_true(sent.count == 0 && counts()->skipped == 1);
    kinds.count = 1; /* tanks alone */
    e.id[2] = 2;
    give_vehicle(&e);
    struct dis_type strange[DIS_STRANGE_MAX];
    assert_true(counts()->without_rule == 1 && dis_gateway_strange(gateway, strange) == 1);
    assert_int_equal(strange[0].domain, 4);
}

/* A vehicle so many metres along the equator. */
static void give_at(uint16_t number, double east_m)
{
    struct made_entity e = made_vehicle(number);
    e.place[0] = 6378137 * cos(east_m / 6378137);
    e.place[1] = 6378137 * sin(east_m / 6378137);
    e.algorithm = 1;
    give_vehicle(&e);
}

static bool is_told(uint16_t number)
{
    for (int i = 0; i < dis_gateway_entities(gateway); i++) {
        const struct dis_listed e = dis_gateway_entity(gateway, i, now_us);
        if (e.id.entity == number) {
            return e.number >= 0;
        }
    }
    return false;
}

GATEWAY_TEST(of_more_than_256_the_first_are_told_and_the_others_counted)
{
    struct dis_settings s = dis_settings_usual();
    s.timeout_s = 60;
    begin(&s);
    for (uint16_t i = 1; i <= 300; i++) {
        give_at(i, i);
        now_us += 1000;
    }
    wait_s(3);
    assert_true(counts()->targets == 256 && counts()->left_out == 44);
    assert_true(is_told(1) && is_told(256) && !is_told(257));
    struct made_entity gone = made_vehicle(5);
    gone.appearance = 1U << 23;
    give_vehicle(&gone);
    wait_s(1.1);
    assert_true(is_told(257) && !is_told(258) && counts()->left_out == 43);
}

GATEWAY_TEST(with_a_centre_the_nearest_are_told_and_one_that_comes_near_takes_a_place)
{
    struct dis_settings s = dis_settings_usual();
    s.last_number = 9;
    s.has_centre = true; /* 0 N 0 E */
    s.timeout_s = 60;
    begin(&s);
    for (uint16_t i = 1; i <= 30; i++) {
        give_at(i, 31000 - 1000 * i);
    }
    wait_s(2.2);
    for (uint16_t i = 1; i <= 30; i++) {
        assert_int_equal(is_told(i), i > 20);
    }
    assert_true(counts()->left_out == 20 && sent_of(1817) > 0);
    give_at(1, 100);
    wait_s(2.2);
    assert_true(is_told(1) && !is_told(21));
    for (int i = 0; i < sent.count; i++) {
        assert_true(sent.frame[i].data[2] <= 9);
    }
}

GATEWAY_TEST(the_share_of_the_bus_is_never_exceeded_and_256_targets_need_less)
{
    struct dis_settings s = dis_settings_usual();
    s.timeout_s = 60;
    begin(&s);
    for (uint16_t i = 1; i <= 256; i++) {
        struct made_entity e = made_vehicle(i);
        e.velocity[1] = 10;
        struct made m = {.length = 0};
        made_entity_state(&m, &e);
        dis_gateway_take(gateway, m.bytes, m.length, now_us);
    }
    wait_s(10);
    const double frames_s = sent.count / 10.0;
    print_message("# 256 targets: %.0f frames/s, %.1f %% of 1 Mbit/s\n", frames_s,
                  frames_s * 135 / 1e4);
    assert_true(counts()->late == 0 && frames_s * 135 < 0.4e6);
    for (int i = 0; i + 400 < sent.count; i++) { /* 400 frames of 135 bits in 40 % of a Mbit/s */
        assert_true((double)(sent.time_us[i + 400] - sent.time_us[i]) > 0.9 * 400 * 135 / 0.4);
    }
}

GATEWAY_TEST(on_a_bus_that_is_too_slow_heartbeats_are_late_and_counted)
{
    struct dis_settings s = dis_settings_usual();
    s.bits_per_s = 125e3;
    s.timeout_s = 60;
    begin(&s);
    for (uint16_t i = 1; i <= 256; i++) {
        give_at(i, 10 * i);
    }
    wait_s(10);
    assert_true(sent.count < 10 * 125e3 * 0.4 / 135 + 20);
    assert_true(counts()->late > 0 && sent.count > 3000);
}

GATEWAY_TEST(a_frozen_exercise_stands_and_does_not_age)
{
    const struct dis_settings s = dis_settings_usual();
    struct made_entity e = made_vehicle(1);
    struct made stop = {.length = 0}, start = {.length = 0};
    e.velocity[1] = 100;
    begin(&s);
    give_vehicle(&e);
    wait_s(1);
    made_stop(&stop, 1, 2);
    give(&stop);
    const double there = dis_gateway_entity(gateway, 0, now_us).place.longitude_deg;
    wait_s(30);
    assert_true(dis_gateway_is_frozen(gateway) && counts()->timed_out == 0);
    assert_true(dis_gateway_entity(gateway, 0, now_us).place.longitude_deg == there);
    made_start(&start, 1, 0, 0);
    give(&start);
    assert_true(fabs(dis_gateway_entity(gateway, 0, now_us).place.longitude_deg - there) < 1e-9);
    wait_s(1);
    const double moved_m =
        (dis_gateway_entity(gateway, 0, now_us).place.longitude_deg - there) * 111319.5;
    assert_true(fabs(moved_m - 100) < 0.1);
}

/* Milliseconds that the last 1820 told, and whether the rate before it was 0. */
static int32_t told_ms(bool *is_standing)
{
    for (int i = sent.count - 1; i > 0; i--) {
        const uint8_t *d = sent.frame[i].data, *before = sent.frame[i - 1].data;
        if (sent.frame[i].id == 1820) {
            assert_true(d[1] == 3 && before[1] == 2 && sent.frame[i - 1].id == 1821);
            *is_standing = before[4] == 0;
            return (int32_t)((uint32_t)d[4] << 24 | (uint32_t)d[5] << 16 | (uint32_t)d[6] << 8 |
                             d[7]);
        }
    }
    return -1;
}

GATEWAY_TEST(the_exercise_clock_runs_with_the_exercise_and_stands_with_it)
{
    struct dis_settings s = dis_settings_usual();
    struct made stop = {.length = 0}, start = {.length = 0};
    bool is_standing;
    s.tells_clock = true;
    begin(&s);
    wait_s(10);
    assert_true(told_ms(&is_standing) == 10000 && !is_standing && sent_of(1820) == 11);
    made_stop(&stop, 1, 2);
    wait_s(0.25);
    give(&stop);
    assert_true(told_ms(&is_standing) == 10250 && is_standing);
    wait_s(5);
    assert_true(told_ms(&is_standing) == 10250 && is_standing);
    made_start(&start, 1, 0, 0);
    give(&start);
    assert_true(told_ms(&is_standing) == 10250 && !is_standing);
    wait_s(2);
    assert_int_equal(told_ms(&is_standing), 12250);
}

GATEWAY_TEST(an_absolute_timestamp_that_agrees_with_the_clock_gives_the_instant)
{
    const struct dis_settings s = dis_settings_usual();
    struct made_entity e = made_vehicle(1);
    e.velocity[1] = 100;
    begin(&s); /* 100 s after a full hour */
    e.timestamp = (uint32_t)llround((100 - 0.5) / 3600 * 2147483648.0) << 1 | 1;
    give_vehicle(&e);
    const double ahead_m = dis_gateway_entity(gateway, 0, now_us).place.longitude_deg * 111319.5;
    assert_true(fabs(ahead_m - 50) < 0.01);
    e.timestamp = (uint32_t)llround((100 - 30.0) / 3600 * 2147483648.0) << 1 | 1;
    give_vehicle(&e); /* half a minute off: no clock to go by */
    assert_true(fabs(dis_gateway_entity(gateway, 0, now_us).place.longitude_deg) < 1e-9);
}

GATEWAY_TEST(a_flood_of_entities_is_bounded_and_counted)
{
    const struct dis_settings s = dis_settings_usual();
    begin(&s);
    for (uint32_t i = 0; i < DIS_ENTITIES_MAX + 1000; i++) {
        struct made_entity e = made_vehicle((uint16_t)(i % 50000 + 1));
        struct made m = {.length = 0};
        e.id[1] = (uint16_t)(i / 50000);
        made_entity_state(&m, &e);
        dis_gateway_take(gateway, m.bytes, m.length, now_us);
    }
    assert_true(counts()->without_room == 1000 &&
                dis_gateway_entities(gateway) == DIS_ENTITIES_MAX);
    wait_s(13);
    assert_true(dis_gateway_entities(gateway) == 0 && counts()->timed_out == DIS_ENTITIES_MAX);
}

GATEWAY_TEST(the_end_of_the_run_removes_every_target)
{
    const struct dis_settings s = dis_settings_usual();
    begin(&s);
    for (uint16_t i = 1; i <= 20; i++) {
        give_at(i, 100 * i);
    }
    wait_s(2);
    dis_gateway_end(gateway, now_us);
    assert_int_equal(sent_of(1817), 20);
}

GATEWAY_TEST(a_bundle_with_a_bad_pdu_in_it_loses_that_pdu_alone)
{
    const struct dis_settings s = dis_settings_usual();
    struct made m = {.length = 0};
    struct made_entity e = made_vehicle(1), bad = made_vehicle(2);
    bad.place[0] = (double)NAN;
    begin(&s);
    made_entity_state(&m, &e);
    made_entity_state(&m, &bad);
    e.id[2] = 3;
    made_entity_state(&m, &e);
    give(&m);
    assert_true(counts()->entities == 2 && counts()->fault[DIS_FAULT_NUMBER] == 1);
}
