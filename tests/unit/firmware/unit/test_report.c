/* What the unit tells the other avionics, held against PROJ's geodesics, the hills of the tiny
 * country, and the glass. */
#include "check.h"
#include "hs/angle.h"
#include "lm/canas_report.h"
#include "target_support.h"
#include "unit_rig.h"
#include "wgs84.h"

#include <math.h>

enum { NODE = 20, STALE = 1 };

/* The frame of each item that came last, and the state word's. */
struct listener {
    struct lm_can_frame last[LM_REPORT_ITEMS], state;
    uint32_t frames, states;
    int (*receive)(void *ctx, struct lm_can_frame *frame);
    void *ctx;
    uint32_t kept[2]; /* identifiers that do not come any more */
};

static int hear(void *ctx, struct lm_can_frame *frame)
{
    struct listener *l = ctx;
    int status;
    do {
        status = l->receive(l->ctx, frame);
    } while (status == 1 && (frame->id == l->kept[0] || frame->id == l->kept[1]));
    return status;
}

static int listen(void *ctx, const struct lm_can_frame *frame)
{
    struct listener *l = ctx;
    for (uint32_t i = 0; i < LM_REPORT_ITEMS; i++) {
        if (frame->id == lm_report_rows[i].id) {
            l->last[i] = *frame;
            l->frames++;
        }
    }
    if (frame->id == 1500) {
        l->state = *frame;
        l->states++;
    }
    return LM_OK;
}

static struct rig *rig_that_tells(struct listener *l, uint8_t node)
{
    struct rig *r = make_rig();
    *l = (struct listener){.receive = r->board.can.receive, .ctx = r->board.can.ctx};
    r->board.can = (struct lm_can){.ctx = l, .receive = hear, .send = listen};
    r->board.lent.bus_node = node;
    r->board.lent.tells_reports = true;
    assert_int_equal(lm_unit_init(&r->unit, &r->board.lent), LM_OK);
    command(r, range_10);
    return r;
}

static bool is_told(const struct listener *l, enum lm_report_item item)
{
    return l->last[item].length > 4;
}

static double told(const struct listener *l, enum lm_report_item item)
{
    const uint8_t *d = l->last[item].data + 4;
    assert_true(l->last[item].length == 8 && l->last[item].data[1] == 3);
    const uint32_t word = (uint32_t)d[0] << 24 | (uint32_t)d[1] << 16 | (uint32_t)d[2] << 8 | d[3];
    return (double)(int32_t)word / lm_report_rows[item].per_unit;
}

/* The hills of the rig's country: 100 m + 50 m sin(east / 900 m). */
static double hill_m(double latitude, double longitude)
{
    return 100 + 50 * sin(remainder(longitude - 11, 360) * 111412.84 *
                          cos(latitude * 0.017453292519943) / 900);
}

/* Where the aircraft is, by the bus that the rig sends. */
static void ownship_at(const struct rig *r, double *latitude, double *longitude)
{
    *latitude = 45.95 + 150 * (double)r->now_us / 1e6 / 111132.0;
    *longitude = 11;
}

TEST(the_cursor_is_told_with_bearing_ranges_and_elevation)
{
    static struct listener l;
    struct rig *r = rig_that_tells(&l, NODE);
    run(r, 2);
    command(r, (struct lm_control){.kind = LM_CONTROL_CURSOR,
                                   .cursor = {FX_BAM_DEG(46), FX_BAM_DEG(221) / 20}});
    run(r, 1);
    assert_float_equal(told(&l, LM_REPORT_CURSOR_LATITUDE), 46, 2e-7);
    assert_float_equal(told(&l, LM_REPORT_CURSOR_LONGITUDE), 11.05, 2e-7);
    const struct geod_geodesic earth = wgs84();
    double latitude, longitude, metres, bearing;
    ownship_at(r, &latitude, &longitude);
    geod_inverse(&earth, latitude, longitude, 46, 11.05, &metres, &bearing, NULL);
    /* The aircraft flies 15 m between two sets, and FLOAT positions are coarse. */
    assert_float_equal(told(&l, LM_REPORT_CURSOR_RANGE), metres, 25);
    assert_float_equal(told(&l, LM_REPORT_CURSOR_BEARING), bearing, 0.3);
    const double elevation = told(&l, LM_REPORT_CURSOR_ELEVATION);
    assert_float_equal(elevation, hill_m(46, 11.05), 4);
    assert_float_equal(told(&l, LM_REPORT_CURSOR_SLANT), hypot(metres, 2000 - elevation), 25);
    assert_false(is_told(&l, LM_REPORT_PLACE_LATITUDE));
    free_rig(r);
}

TEST(west_and_south_are_negative_and_far_places_have_no_range)
{
    static struct listener l;
    struct rig *r = rig_that_tells(&l, NODE);
    run(r, 2);
    command(r, (struct lm_control){.kind = LM_CONTROL_CURSOR,
                                   .cursor = {0u - FX_BAM_DEG(45), 0u - FX_BAM_DEG(170)}});
    run(r, 1);
    assert_float_equal(told(&l, LM_REPORT_CURSOR_LATITUDE), -45, 2e-7);
    assert_float_equal(told(&l, LM_REPORT_CURSOR_LONGITUDE), -170, 2e-7);
    assert_false(is_told(&l, LM_REPORT_CURSOR_RANGE) || is_told(&l, LM_REPORT_CURSOR_SLANT) ||
                 is_told(&l, LM_REPORT_CURSOR_ELEVATION));
    free_rig(r);
}

TEST(mode_settings_and_a_patch_are_told_as_the_glass_shows_them)
{
    static struct listener l;
    struct rig *r = rig_that_tells(&l, NODE);
    command(r, (struct lm_control){.kind = LM_CONTROL_GAIN, .gain_db = -6});
    command(r, (struct lm_control){.kind = LM_CONTROL_AZIMUTH, .azimuth_index = 1});
    run(r, 1.5);
    const uint8_t sector[4] = {LM_PICTURE_SECTOR, r->unit.page.mode, r->unit.page.fov,
                               r->unit.page.format};
    assert_memory_equal(l.last[LM_REPORT_PICTURE].data + 4, sector, 4);
    assert_true(told(&l, LM_REPORT_RANGE_SCALE) == 10);
    assert_memory_equal(l.last[LM_REPORT_SETTINGS].data + 4, "\x1e\0", 2); /* A3: 30 degrees */
    assert_int_equal((int8_t)l.last[LM_REPORT_GAIN].data[4], -6);
    assert_memory_equal(l.last[LM_REPORT_PATCH].data + 4, "\0\0\0", 3);
    assert_false(is_told(&l, LM_REPORT_PATCH_CELL));

    command(r, patch_here);
    run(r, 0.21);
    assert_int_equal(l.last[LM_REPORT_PICTURE].data[4], LM_PICTURE_PATCH);
    assert_true(told(&l, LM_REPORT_PATCH_CELL) == 5);
    assert_in_range(l.last[LM_REPORT_PATCH].data[4], LM_REPORT_READING, LM_REPORT_DRAWING);
    assert_in_range(l.last[LM_REPORT_PATCH].data[5], 0, 99);
    run(r, 6);
    assert_memory_equal(l.last[LM_REPORT_PATCH].data + 4, "\x03\x64\0", 3); /* drawn, 100 % */
    assert_float_equal(told(&l, LM_REPORT_PLACE_LATITUDE), 46, 2e-7);
    assert_float_equal(told(&l, LM_REPORT_PLACE_ELEVATION), hill_m(46, 11.05), 4);

    command(r, (struct lm_control){.kind = LM_CONTROL_FREEZE, .is_frozen = true});
    struct lm_control nonsense = patch_here;
    nonsense.sar.cell_mm = 1;
    command(r, nonsense);
    run(r, 0.5);
    assert_int_equal(l.last[LM_REPORT_SETTINGS].data[5], LM_REPORT_FROZEN);
    assert_int_equal(l.last[LM_REPORT_PATCH].data[6], LM_REFUSED_CELL);
    run(r, 2.5);
    assert_int_equal(l.last[LM_REPORT_PATCH].data[6], LM_REFUSED_NOT);
    free_rig(r);
}

TEST(each_switch_has_its_own_bit)
{
    static struct listener l;
    struct rig *r = rig_that_tells(&l, NODE);
    struct lm_page *page = &r->unit.page;
    const struct {
        bool *is_on;
        uint8_t bit;
    } switches[] = {{&page->is_frozen, 1 << 0},      {&page->is_override, 1 << 1},
                    {&page->is_snowplow, 1 << 2},    {&page->is_auto_range, 1 << 3},
                    {&page->is_tilt_manual, 1 << 4}, {&page->is_pencil, 1 << 5},
                    {&page->is_plan, 1 << 6}};
    run(r, 1.5);
    for (size_t i = 0; i < sizeof switches / sizeof *switches; i++) {
        *switches[i].is_on = true;
        run(r, 0.6);
        assert_int_equal(l.last[LM_REPORT_SETTINGS].data[5], switches[i].bit); /* docs/bus.md */
        *switches[i].is_on = false;
        run(r, 0.6);
        assert_int_equal(l.last[LM_REPORT_SETTINGS].data[5], 0);
    }
    free_rig(r);
}

TEST(a_fixed_track_is_told_with_what_the_geodesic_says)
{
    static struct listener l;
    struct rig *r = rig_that_tells(&l, NODE);
    run(r, 1.5);
    assert_false(is_told(&l, LM_REPORT_TRACK_LATITUDE));
    command(r, (struct lm_control){.kind = LM_CONTROL_CURSOR,
                                   .cursor = {FX_BAM_DEG(46), FX_BAM_DEG(221) / 20}});
    run(r, 0.3);
    command(r, (struct lm_control){.kind = LM_CONTROL_TRACK});
    run(r, 1);
    const struct geod_geodesic earth = wgs84();
    double latitude, longitude, metres, bearing;
    ownship_at(r, &latitude, &longitude);
    geod_inverse(&earth, latitude, longitude, 46, 11.05, &metres, &bearing, NULL);
    const double elevation = told(&l, LM_REPORT_TRACK_ELEVATION);
    const double slant = told(&l, LM_REPORT_TRACK_SLANT);
    assert_float_equal(told(&l, LM_REPORT_TRACK_LATITUDE), 46, 1e-4);
    assert_float_equal(told(&l, LM_REPORT_TRACK_LONGITUDE), 11.05, 1e-4);
    assert_float_equal(told(&l, LM_REPORT_TRACK_BEARING), bearing, 0.3);
    assert_float_equal(elevation, hill_m(46, 11.05), 4);
    assert_true(fabs(slant - hypot(metres, 2000 - elevation)) < 35);
    assert_true(fabs(told(&l, LM_REPORT_TRACK_RATE) -
                     (-150 * cos(bearing * 0.017453292519943) * metres / slant)) < 2);
    assert_true(told(&l, LM_REPORT_TRACK_SPEED) == 0);
    assert_false(is_told(&l, LM_REPORT_TRACK_COURSE)); /* it stands */
    /* A place that is tracked is the place that is told. */
    assert_float_equal(told(&l, LM_REPORT_PLACE_LATITUDE), 46, 1e-4);
    assert_float_equal(told(&l, LM_REPORT_PLACE_ELEVATION), hill_m(46, 11.05), 4);
    command(r, (struct lm_control){.kind = LM_CONTROL_DROP});
    run(r, 0.5);
    assert_false(is_told(&l, LM_REPORT_TRACK_LATITUDE) || is_told(&l, LM_REPORT_TRACK_SLANT));
    free_rig(r);
}

TEST(nothing_slews_the_cursor_away_from_what_is_tracked)
{
    static struct listener l;
    struct rig *r = rig_that_tells(&l, NODE);
    run(r, 1.5);
    command(r, (struct lm_control){.kind = LM_CONTROL_CURSOR,
                                   .cursor = {FX_BAM_DEG(46), FX_BAM_DEG(221) / 20}});
    run(r, 0.3);
    command(r, (struct lm_control){.kind = LM_CONTROL_TRACK});
    run(r, 0.5);
    command(r, lm_control_slew(1000, 1000));
    const struct geod_geodesic earth = wgs84();
    for (int i = 0; i < 20; i++) {
        run(r, 0.1);
        double latitude, longitude, metres, bearing;
        ownship_at(r, &latitude, &longitude);
        geod_inverse(&earth, latitude, longitude, 46, 11.05, &metres, &bearing, NULL);
        assert_float_equal(told(&l, LM_REPORT_CURSOR_LATITUDE), 46, 1e-4);
        assert_float_equal(told(&l, LM_REPORT_CURSOR_RANGE), metres, 40);
        assert_float_equal(told(&l, LM_REPORT_CURSOR_BEARING), bearing, 0.4);
    }
    free_rig(r);
}

TEST(a_board_that_leaves_the_radar_to_the_image_tells_its_scale)
{
    static struct listener l;
    struct rig *r = rig_that_tells(&l, NODE);
    r->board.lent.radar = NULL;
    assert_int_equal(lm_unit_init(&r->unit, &r->board.lent), LM_OK);
    run(r, 0.5);
    assert_true(told(&l, LM_REPORT_RANGE_SCALE) == 10);
    free_rig(r);
}

TEST(old_navigation_is_told_as_old_and_lost_navigation_as_no_data)
{
    static struct listener l;
    struct rig *r = rig_that_tells(&l, NODE);
    run(r, 2);
    assert_int_equal(l.last[LM_REPORT_CURSOR_LATITUDE].data[2], 0);
    r->bus.stop_us = r->now_us;
    run(r, 1);
    assert_true(is_told(&l, LM_REPORT_CURSOR_LATITUDE));
    assert_int_equal(l.last[LM_REPORT_CURSOR_LATITUDE].data[2], STALE);
    run(r, 3);
    assert_false(is_told(&l, LM_REPORT_CURSOR_LATITUDE));
    assert_true(is_told(&l, LM_REPORT_PICTURE)); /* the display itself is well */
    assert_true(l.state.data[7] & LM_FLAG_NAV_DEAD);
    free_rig(r);
}

TEST(the_state_word_comes_twice_a_second_and_a_unit_without_a_number_is_silent)
{
    static struct listener l;
    struct rig *r = rig_that_tells(&l, NODE);
    run(r, 10);
    assert_in_range(l.states, 19, 21);
    free_rig(r);
    r = rig_that_tells(&l, 0);
    run(r, 2);
    assert_int_equal(l.frames + l.states, 0);
    free_rig(r);
}

static const struct lm_control cursor_on_map = {.kind = LM_CONTROL_CURSOR,
                                                .cursor = {FX_BAM_DEG(46), FX_BAM_DEG(221) / 20}};

TEST(a_slant_range_needs_a_height_and_an_elevation_a_map)
{
    static struct listener l;
    struct rig *r = rig_that_tells(&l, NODE);
    command(r, cursor_on_map);
    run(r, 1.5);
    assert_true(is_told(&l, LM_REPORT_CURSOR_SLANT));
    l.kept[0] = 1038, l.kept[1] = 320;
    run(r, 12);
    assert_true(r->unit.ownship.height_quality == LM_NAV_DEAD);
    assert_true(is_told(&l, LM_REPORT_CURSOR_RANGE) && is_told(&l, LM_REPORT_CURSOR_ELEVATION));
    assert_false(is_told(&l, LM_REPORT_CURSOR_SLANT));
    free_rig(r);
    r = rig_that_tells(&l, NODE);
    r->image.bytes[100] ^= 1;
    assert_int_equal(lm_unit_init(&r->unit, &r->board.lent), LM_OK);
    command(r, cursor_on_map);
    run(r, 1.5);
    assert_true(is_told(&l, LM_REPORT_CURSOR_RANGE));
    assert_false(is_told(&l, LM_REPORT_CURSOR_SLANT) || is_told(&l, LM_REPORT_CURSOR_ELEVATION));
    free_rig(r);
}

/* 555 km north: the map is known as before, the range is none that a radar has. */
TEST(a_place_of_the_map_beyond_400_km_is_told_without_ranges)
{
    static struct listener l;
    struct rig *r = rig_that_tells(&l, NODE);
    run(r, 1.5);
    r->bus.jump_degrees = 5;
    run(r, 1);
    command(r, cursor_on_map);
    run(r, 1);
    assert_float_equal(told(&l, LM_REPORT_CURSOR_ELEVATION), hill_m(46, 11.05), 4);
    assert_false(is_told(&l, LM_REPORT_CURSOR_RANGE) || is_told(&l, LM_REPORT_CURSOR_SLANT));
    free_rig(r);
}

TEST(a_patch_beside_the_map_is_told_without_an_elevation)
{
    static struct listener l;
    struct rig *r = rig_that_tells(&l, NODE);
    run(r, 1.5);
    struct lm_control beside = patch_here;
    beside.sar.centre.longitude = hs_bam(11.1);
    command(r, beside);
    run(r, 1);
    assert_float_equal(told(&l, LM_REPORT_PLACE_LONGITUDE), 11.1, 2e-7);
    assert_false(is_told(&l, LM_REPORT_PLACE_ELEVATION));
    free_rig(r);
}

TEST(a_patch_whose_tiles_are_not_there_yet_is_told_as_being_read)
{
    static struct listener l;
    struct rig *r = rig_that_tells(&l, NODE);
    run(r, 1.4);
    r->board.flash.busy_polls = 1000;
    command(r, patch_here);
    run(r, 0.3);
    assert_int_equal(l.last[LM_REPORT_PATCH].data[4], LM_REPORT_READING);
    assert_int_equal(l.last[LM_REPORT_PATCH].data[5], 0);
    run(r, 0.5); /* by then the patch begins with whatever there is */
    assert_int_equal(l.last[LM_REPORT_PATCH].data[4], LM_REPORT_DRAWING);
    free_rig(r);
}

/* South-east at 20 m/s, two kilometres ahead. A target is no place. */
TEST(a_mover_is_told_with_its_speed_and_course_and_as_no_place)
{
    static struct listener l;
    static struct lm_target mover;
    struct rig *r = rig_that_tells(&l, NODE);
    run(r, 1.5);
    mover = point_at(46, 11.01, 3, 20);
    mover.flags = LM_TARGET_ABOVE_GROUND;
    mover.heading = hs_bam(160);
    mover.speed_mm_s = 20000;
    mover.leg_m = 50000;
    seal_target(&mover);
    r->unit.map.target_set.items = &mover;
    r->unit.map.target_set.count = 1;
    const struct lm_mover_state at = lm_mover_state_at(&mover, r->unit.exercise.time_us);
    command(r, (struct lm_control){.kind = LM_CONTROL_SECTOR, .sector = {LM_SECTOR_GMT, 0}});
    command(r, (struct lm_control){.kind = LM_CONTROL_CURSOR, .cursor = at.position});
    command(r, (struct lm_control){.kind = LM_CONTROL_TRACK});
    run(r, 1);
    assert_int_equal(l.last[LM_REPORT_TRACK].data[4], LM_TRACK_MOVER);
    assert_int_equal(l.last[LM_REPORT_TRACK].data[5], LM_TRACK_HELD);
    assert_float_equal(told(&l, LM_REPORT_TRACK_SPEED), 20, 0.01);
    assert_float_equal(remainder(told(&l, LM_REPORT_TRACK_COURSE) - 160, 180), 0, 0.1);
    assert_false(is_told(&l, LM_REPORT_PLACE_LATITUDE) || is_told(&l, LM_REPORT_PLACE_ELEVATION));
    free_rig(r);
}

/* Between two measurements a track coasts by what was known last; the own speed is not. */
TEST(without_a_velocity_a_track_closes_at_no_rate_and_ends)
{
    static struct listener l;
    struct rig *r = rig_that_tells(&l, NODE);
    run(r, 1.5);
    command(r, cursor_on_map);
    run(r, 0.3);
    command(r, (struct lm_control){.kind = LM_CONTROL_TRACK});
    run(r, 1);
    assert_true(told(&l, LM_REPORT_TRACK_RATE) < -50);
    l.kept[0] = 1039, l.kept[1] = 1040;
    for (int i = 0; i < 150 && r->unit.track.state == LM_TRACK_HELD; i++) {
        run(r, 0.1);
    }
    run(r, 0.3);
    assert_int_equal(l.last[LM_REPORT_TRACK].data[5], LM_TRACK_COASTING);
    assert_int_equal(l.last[LM_REPORT_TRACK].data[6], LM_TRACK_NO_NAV);
    assert_true(told(&l, LM_REPORT_TRACK_RATE) == 0);
    run(r, 12);
    assert_int_equal(l.last[LM_REPORT_TRACK].data[5], LM_TRACK_OFF);
    free_rig(r);
}

/* Ranging looks along the nose. A place that is tracked does not need to know where that is. */
TEST(ranging_waits_for_the_attitude_and_a_place_does_not)
{
    static struct listener l;
    struct rig *r = rig_that_tells(&l, NODE);
    r->bus.pitch_deg = -20;
    run(r, 1.5);
    command(r, (struct lm_control){.kind = LM_CONTROL_RANGING});
    run(r, 0.5);
    assert_int_equal(l.last[LM_REPORT_TRACK].data[5], LM_TRACK_HELD);
    l.kept[0] = 311, l.kept[1] = 312;
    run(r, 3);
    assert_int_equal(l.last[LM_REPORT_TRACK].data[5], LM_TRACK_SEARCHING);
    assert_int_equal(l.last[LM_REPORT_TRACK].data[6], LM_TRACK_NO_NAV);
    command(r, (struct lm_control){.kind = LM_CONTROL_DROP});
    command(r, cursor_on_map);
    command(r, (struct lm_control){.kind = LM_CONTROL_TRACK});
    run(r, 0.5);
    assert_int_equal(l.last[LM_REPORT_TRACK].data[4], LM_TRACK_FIXED);
    assert_int_equal(l.last[LM_REPORT_TRACK].data[5], LM_TRACK_HELD);
    free_rig(r);
}

/* A bus on which nothing can be sent: reports, services and SWAP are silent, and the display flies.
 */
TEST(on_a_bus_of_another_framing_nothing_is_told)
{
    static struct listener l;
    struct rig *r = rig_that_tells(&l, NODE);
    r->board.lent.bus_profile = &lm_bus_generic;
    r->board.lent.obeys_controls = true;
    assert_int_not_equal(lm_bus_generic.framing, LM_BUS_CANAEROSPACE);
    assert_int_equal(lm_unit_init(&r->unit, &r->board.lent), LM_OK);
    l.frames = l.states = 0;
    run(r, 2);
    assert_int_equal(l.frames + l.states, 0);
    assert_int_equal(r->unit.count.frames > 50, 1);
    const struct lm_can_frame gain = {
        .id = LM_CONTROL_ID, .length = 8, .data = {9, LM_CANAS_LONG, 0, 1}};
    const uint32_t refused = r->unit.control_bus.count.refused;
    lm_canas_control_take(&r->unit.control_bus, &gain);
    assert_int_equal(r->unit.control_bus.count.heard, 0);
    assert_in_range(r->unit.control_bus.count.refused - refused, 0, 1);
    free_rig(r);
}
