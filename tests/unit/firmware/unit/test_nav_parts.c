/* Navigation of which one part is missing: what the display then shows, refuses and tells. */
#include "check.h"
#include "lm/track.h"
#include "unit_rig.h"

#include <string.h>

/* A bus that keeps some identifiers to itself, once it is told to. */
struct sieve {
    int (*receive)(void *ctx, struct lm_can_frame *frame);
    void *ctx;
    uint32_t kept[2];
};

static struct sieve sieve;

static bool is_kept(const struct lm_can_frame *frame)
{
    return frame->id == sieve.kept[0] || frame->id == sieve.kept[1];
}

static int receive(void *ctx, struct lm_can_frame *frame)
{
    const struct sieve *s = ctx;
    int count;
    do {
        count = s->receive(s->ctx, frame);
    } while (count == 1 && is_kept(frame));
    return count;
}

static struct rig *fly_with_sieve(void)
{
    struct rig *r = make_rig();
    sieve = (struct sieve){.receive = r->board.can.receive, .ctx = r->board.can.ctx};
    r->board.can.receive = receive;
    r->board.can.ctx = &sieve;
    assert_int_equal(lm_unit_init(&r->unit, &r->board.lent), LM_OK);
    command(r, range_10);
    run(r, 1.5);
    return r;
}

static void keep(uint32_t id, uint32_t other)
{
    sieve.kept[0] = id;
    sieve.kept[1] = other;
}

/* What a part's loss does: whether it is a fault of the navigation when it is old, and when it is
 * gone. */
static const struct part {
    uint32_t id, other;
    uint32_t old_flag, lost_flag;
} parts[] = {
    {1036, 1037, LM_FLAG_NAV_STALE, LM_FLAG_NAV_DEAD}, /* position */
    {1038, 320, LM_FLAG_NAV_STALE, LM_FLAG_NAV_DEAD},  /* height */
    {1133, 321, LM_FLAG_NAV_STALE, LM_FLAG_NAV_DEAD},  /* heading */
    {1039, 1040, 0, LM_FLAG_NAV_STALE},                /* velocity, without which none moves on */
};
enum { PARTS = sizeof parts / sizeof *parts };

static const uint32_t nav_flags = LM_FLAG_NAV_STALE | LM_FLAG_NAV_DEAD;

TEST(each_part_of_the_navigation_is_a_fault_by_itself_and_is_none_when_it_is_back)
{
    for (int i = 0; i < PARTS; i++) {
        struct rig *r = fly_with_sieve();
        assert_int_equal(r->unit.flags & nav_flags, 0);
        keep(parts[i].id, parts[i].other);
        run(r, 0.6);
        assert_int_equal(r->unit.flags & nav_flags, parts[i].old_flag);
        run(r, 10);
        assert_int_equal(r->unit.flags & nav_flags, parts[i].lost_flag);
        keep(0, 0);
        run(r, 1.5);
        assert_int_equal(r->unit.flags & nav_flags, 0);
        assert_true(lit_pixels(r) > 1000);
        free_rig(r);
    }
}

TEST(a_patch_from_the_ownship_needs_each_part_of_the_navigation)
{
    for (int i = 0; i < PARTS; i++) {
        struct rig *r = fly_with_sieve();
        keep(parts[i].id, parts[i].other);
        run(r, 1);
        command(r, patch_here);
        run(r, 0.1);
        assert_int_equal(r->unit.refusal, LM_REFUSED_NAV);
        assert_int_equal(r->unit.page.picture, LM_PICTURE_SECTOR);
        keep(0, 0);
        run(r, 1);
        command(r, patch_here);
        run(r, 0.1);
        assert_int_equal(r->unit.page.picture, LM_PICTURE_PATCH);
        free_rig(r);
    }
}

TEST(a_lock_does_not_outlive_position_height_or_heading)
{
    for (int i = 0; i < 3; i++) {
        struct rig *r = fly_with_sieve();
        command(r, (struct lm_control){.kind = LM_CONTROL_CURSOR,
                                       .cursor = {FX_BAM_DEG(46), FX_BAM_DEG(221) / 20}});
        run(r, 0.3);
        command(r, (struct lm_control){.kind = LM_CONTROL_TRACK});
        run(r, 0.5);
        assert_int_equal(r->unit.track.state, LM_TRACK_HELD);
        keep(parts[i].id, parts[i].other);
        run(r, 12);
        assert_int_equal(r->unit.track.state, LM_TRACK_OFF);
        assert_int_equal(r->unit.track.loss, LM_TRACK_NO_NAV);
        free_rig(r);
    }
}

TEST(another_mode_ends_a_lock)
{
    struct rig *r = fly_with_sieve();
    command(r, (struct lm_control){.kind = LM_CONTROL_CURSOR,
                                   .cursor = {FX_BAM_DEG(46), FX_BAM_DEG(221) / 20}});
    run(r, 0.3);
    command(r, (struct lm_control){.kind = LM_CONTROL_TRACK});
    run(r, 0.5);
    assert_int_equal(r->unit.track.state, LM_TRACK_HELD);
    command(r, (struct lm_control){.kind = LM_CONTROL_SECTOR, .sector = {LM_SECTOR_SEA, 0}});
    run(r, 0.2);
    assert_int_equal(r->unit.track.state, LM_TRACK_OFF);
    assert_int_equal(r->unit.track.loss, LM_TRACK_SOUND);
    free_rig(r);
}

/* Lost height, below: the terrain is no fault of its own. */
TEST(an_aircraft_without_a_height_is_not_said_to_be_below_the_ground)
{
    struct rig *r = fly_with_sieve();
    r->bus.height_m = -300;
    run(r, 1);
    assert_true(r->unit.flags & LM_FLAG_BELOW);
    keep(1038, 320);
    run(r, 12);
    assert_false(r->unit.flags & LM_FLAG_BELOW);
    free_rig(r);
}

/* ---- other reasons ---- */

TEST(the_cursor_is_not_put_where_no_page_has_it)
{
    struct rig *r = fly_with_sieve();
    const struct lm_control put = {.kind = LM_CONTROL_CURSOR,
                                   .cursor = {FX_BAM_DEG(46), FX_BAM_DEG(11)}};
    static const int pages[] = {12, 14, 13}; /* BIT, TEST, FCR */
    for (int i = 0; i < 3; i++) {
        press(r, pages[i]);
        const uint32_t refused = r->unit.count.commands_refused;
        command(r, put);
        run(r, 0.1);
        assert_int_equal(r->unit.count.commands_refused - refused, i < 2);
        assert_true(i == 2 || r->unit.refusal == LM_REFUSED_PAGE);
    }
    free_rig(r);
}

TEST(old_weather_of_the_bus_is_said_and_weather_out_of_range_refused)
{
    struct rig *r = fly_with_sieve();
    assert_false(r->unit.flags & LM_FLAG_WEATHER);
    const struct lm_bus_event sea = {.field = LM_BUS_SEA_STATE,
                                     .value = 3,
                                     .time_us = r->now_us,
                                     .stale_ms = 1000,
                                     .dead_ms = 3000,
                                     .node = 20};
    lm_weather_bus_take(&r->unit.weather.bus, &sea);
    run(r, 1);
    assert_false(r->unit.flags & LM_FLAG_WEATHER);
    run(r, 1);
    assert_true(r->unit.flags & LM_FLAG_WEATHER);
    run(r, 2);
    assert_false(r->unit.flags & LM_FLAG_WEATHER);
    const struct lm_environment before = r->unit.weather.commanded;
    const struct lm_environment worse = {.sea_state = LM_SEA_STATE_MAX + 1};
    assert_int_equal(lm_unit_weather_command(&r->unit.weather, &worse, r->now_us), LM_ERR_RANGE);
    assert_memory_equal(&r->unit.weather.commanded, &before, sizeof before);
    free_rig(r);
}

TEST(weather_begins_fair_whatever_its_memory_held)
{
    static struct lm_unit_weather fair, other;
    lm_unit_weather_init(&fair);
    memset(&other, 0xA5, sizeof other);
    lm_unit_weather_init(&other);
    assert_memory_equal(&other, &fair, sizeof fair);
    assert_int_equal(other.now.sea_state, LM_SEA_STATE_OF_IMAGE);
}
