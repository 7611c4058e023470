/* A control that the unit refuses: the reason on the glass and to the control's source. */
#include "check.h"
#include "glass_text.h"
#include "hs/angle.h"
#include "unit_rig.h"

#include <string.h>

static enum lm_refusal told;
static int times_told;

static void listen(void *ctx, enum lm_refusal reason)
{
    (void)ctx;
    told = reason;
    times_told++;
}

static struct rig *listened_rig(void)
{
    struct rig *r = make_rig();
    r->board.controls.refused = listen;
    told = LM_REFUSED_NOT, times_told = 0;
    assert_int_equal(lm_unit_init(&r->unit, &r->board.lent), LM_OK);
    return r;
}

/* Command, and expect this reason, once. It is on the glass, below UNABLE, for patches. */
static void expect(struct rig *r, struct lm_control c, enum lm_refusal reason, bool is_on_glass)
{
    const int before = times_told;
    const uint32_t refused = r->unit.count.commands_refused;
    const struct lm_surface s = glass_of(r);
    command(r, c);
    run(r, 0.1);
    assert_int_equal(times_told, before + (reason != LM_REFUSED_NOT));
    assert_int_equal(r->unit.count.commands_refused, refused + (reason != LM_REFUSED_NOT));
    if (reason == LM_REFUSED_NOT) {
        return;
    }
    assert_int_equal(told, reason);
    assert_int_equal(r->unit.refusal, reason);
    const uint32_t amber = r->unit.palette.warning, ink = r->unit.palette.ink;
    assert_int_equal(glass_find(&s, "UNABLE", amber, ink, NULL), is_on_glass);
    assert_int_equal(glass_find(&s, lm_refusal_word(reason), amber, ink, NULL), is_on_glass);
    run(r, 2);
    assert_false(glass_find(&s, "UNABLE", amber, ink, NULL));
    assert_false(glass_find(&s, lm_refusal_word(reason), amber, ink, NULL));
}

static struct lm_control patch_at(double azimuth_deg, double metres, uint32_t cell_mm)
{
    struct lm_geo_origin origin;
    lm_geo_set_origin(&origin, (struct lm_position){hs_bam(45.951), hs_bam(11)});
    const struct lm_position centre =
        lm_geo_direct(&origin, hs_bam(azimuth_deg), (uint32_t)(metres * 256));
    return (struct lm_control){
        .kind = LM_CONTROL_SAR,
        .sar = {.centre = centre, .cell_mm = cell_mm, .is_from_ownship = true}};
}

TEST(a_patch_is_refused_with_the_limit_that_it_breaks)
{
    struct rig *r = listened_rig();
    r->bus.speed_m_s = 100;
    run(r, 1);
    expect(r, patch_at(40, 15000, 100), LM_REFUSED_CELL, true);
    expect(r, patch_at(40, 260000, 5000), LM_REFUSED_FAR, true);
    expect(r, patch_at(40, 800, 2000), LM_REFUSED_NEAR, true);
    expect(r, patch_at(40, 1500, 20000), LM_REFUSED_NEAR, true);
    expect(r, patch_at(5, 15000, 5000), LM_REFUSED_SQUINT, true);
    expect(r, patch_at(180, 15000, 5000), LM_REFUSED_SQUINT, true);
    expect(r, patch_at(80, 15000, 5000), LM_REFUSED_GIMBAL, true);
    expect(r, patch_at(20, 200000, 500), LM_REFUSED_DWELL, true);
    struct lm_control high = patch_at(40, 15000, 5000);
    high.sar.is_from_ownship = false;
    high.sar.range_m = 15000;
    high.sar.height_m_q6 = 31000 * 64;
    expect(r, high, LM_REFUSED_HEIGHT, true);
    expect(r, patch_at(40, 15000, 5000), LM_REFUSED_NOT, true);
    free_rig(r);
}

TEST(designating_is_refused_without_cursor_navigation_or_transmitter)
{
    struct rig *r = listened_rig();
    r->bus.is_down = 1;
    run(r, 0.1);
    expect(r, lm_control_designate(), LM_REFUSED_CURSOR, true);
    r->bus.is_down = 0;
    run(r, 3);
    command(r, lm_control_slew(1000, 0));
    run(r, 0.3);
    command(r, lm_control_slew(0, 0));
    press(r, 4);
    expect(r, lm_control_designate(), LM_REFUSED_SILENT, true);
    press(r, 4);
    press(r, 12);
    expect(r, lm_control_designate(), LM_REFUSED_PAGE, false);
    press(r, 13);
    r->bus.is_down = 1;
    run(r, 1);
    expect(r, lm_control_designate(), LM_REFUSED_NAV, true);
    free_rig(r);
}

/* The track key and the ranging one alike. */
static void expect_of_tracks(struct rig *r, enum lm_refusal reason, bool is_on_glass)
{
    expect(r, (struct lm_control){.kind = LM_CONTROL_TRACK}, reason, is_on_glass);
    expect(r, (struct lm_control){.kind = LM_CONTROL_RANGING}, reason, is_on_glass);
    assert_int_equal(r->unit.track.state, LM_TRACK_OFF);
}

TEST(a_track_is_refused_for_what_it_lacks)
{
    struct rig *r = listened_rig();
    r->bus.is_down = 1;
    run(r, 0.1);
    expect_of_tracks(r, LM_REFUSED_NAV, true);
    r->bus.is_down = 0;
    run(r, 3);
    press(r, 4);
    expect_of_tracks(r, LM_REFUSED_SILENT, true);
    press(r, 4);
    press(r, 12);
    expect_of_tracks(r, LM_REFUSED_PAGE, false);
    press(r, 14);
    expect_of_tracks(r, LM_REFUSED_PAGE, false);
    press(r, 13);
    r->unit.map.is_usable = false;
    expect_of_tracks(r, LM_REFUSED_MAP, true);
    free_rig(r);
}

/* Sent home, it has no place before the next step. Ranging looks ahead, and needs none. */
TEST(a_cursor_that_was_just_sent_home_is_not_tracked)
{
    struct rig *r = listened_rig();
    run(r, 2);
    command(r, lm_control_button(true, 9));
    command(r, lm_control_button(false, 9));
    expect(r, (struct lm_control){.kind = LM_CONTROL_TRACK}, LM_REFUSED_CURSOR, true);
    assert_int_equal(r->unit.track.state, LM_TRACK_OFF);
    command(r, lm_control_button(true, 9));
    command(r, lm_control_button(false, 9));
    expect(r, (struct lm_control){.kind = LM_CONTROL_RANGING}, LM_REFUSED_NOT, true);
    assert_int_not_equal(r->unit.track.state, LM_TRACK_OFF);
    free_rig(r);
}

TEST(a_patch_without_a_map_is_refused_for_that)
{
    struct rig *r = listened_rig();
    r->unit.map.is_usable = false;
    run(r, 1);
    expect(r, patch_at(40, 15000, 5000), LM_REFUSED_MAP, true);
    free_rig(r);
}

TEST(a_value_out_of_range_is_told_to_its_source_and_not_on_the_glass)
{
    struct rig *r = listened_rig();
    run(r, 1);
    expect(r, (struct lm_control){.kind = LM_CONTROL_RANGE, .range_nm = 11}, LM_REFUSED_VALUE,
           false);
    expect(r,
           (struct lm_control){.kind = LM_CONTROL_SECTOR, .sector = {LM_SECTOR_SEA, LM_FOV_DBS1}},
           LM_REFUSED_VALUE, false);
    expect(r, lm_control_button(true, 99), LM_REFUSED_VALUE, false);
    expect(r, lm_control_knob(1001), LM_REFUSED_VALUE, false);
    expect(r, lm_control_slew(LM_FULL_DEFLECTION + 1, 0), LM_REFUSED_VALUE, false);
    expect(r, lm_control_slew(0, -LM_FULL_DEFLECTION - 1), LM_REFUSED_VALUE, false);
    assert_true(r->unit.cursor.slew_x == 0 && r->unit.cursor.slew_y == 0);
    const int32_t places[] = {INT32_MIN, 0, LM_IMAGES_MAX + 1};
    for (size_t i = 0; i < sizeof places / sizeof *places; i++) {
        expect(r, (struct lm_control){.kind = LM_CONTROL_IMAGE, .image = {.place = places[i]}},
               LM_REFUSED_VALUE, false);
    }
    expect(r, (struct lm_control){.kind = LM_CONTROL_IMAGE, .image = {.place = 1}}, LM_REFUSED_MAP,
           false); /* it is the only one */
    free_rig(r);
}

/* Each number a step beyond its range, below and above; the others are good. */
TEST(a_state_of_slots_out_of_range_is_refused_and_the_one_before_stays)
{
    const struct lm_slots_state good = {2, 3, 3, LM_LOADS - 1, 100};
    const struct lm_slots_state wrong[] = {
        {3, 0, 0, 0, 0},   {-1, 0, 0, 0, 0}, {0, 4, 0, 0, 0},        {0, -1, 0, 0, 0},
        {0, 0, 4, 0, 0},   {0, 0, -1, 0, 0}, {0, 0, 0, LM_LOADS, 0}, {0, 0, 0, -1, 0},
        {0, 0, 0, 0, 101}, {0, 0, 0, 0, -1}};
    struct rig *r = listened_rig();
    run(r, 1);
    expect(r, (struct lm_control){.kind = LM_CONTROL_SLOTS, .slots = good}, LM_REFUSED_NOT, false);
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        expect(r, (struct lm_control){.kind = LM_CONTROL_SLOTS, .slots = wrong[i]},
               LM_REFUSED_VALUE, false);
        assert_memory_equal(&r->unit.slots, &good, sizeof good);
    }
    free_rig(r);
}

TEST(a_key_that_asks_for_a_patch_that_cannot_be_made_is_refused_like_a_command)
{
    struct rig *r = listened_rig();
    run(r, 1);
    expect(r, patch_at(40, 5000, 5000), LM_REFUSED_NOT, true);
    press(r, 16); /* cells of 10 m: the patch would reach behind the aircraft */
    press(r, 16);
    run(r, 0.05);
    assert_int_equal(told, LM_REFUSED_NEAR);
    assert_true(r->unit.flags & LM_FLAG_UNABLE);
    free_rig(r);
}

TEST(each_reason_has_a_word_of_its_own)
{
    assert_string_equal(lm_refusal_word(LM_REFUSED_NOT), "");
    assert_string_equal(lm_refusal_word(LM_REFUSALS), "");
    for (int i = 1; i < LM_REFUSALS; i++) {
        const char *word = lm_refusal_word((enum lm_refusal)i);
        assert_in_range(strlen(word), 1, 8);
        for (int k = 0; k < i; k++) {
            assert_string_not_equal(word, lm_refusal_word((enum lm_refusal)k));
        }
    }
}
