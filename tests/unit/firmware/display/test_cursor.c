/* View and cursor against PROJ's geodesics. */
#include "check.h"
#include "hs/angle.h"
#include "lm/cursor.h"
#include "wgs84.h"

#include <math.h>

enum { SIDE = 480, RANGE_M = 37040 };

static const double pi = 3.14159265358979323846;

static struct lm_position place_at(double lat, double lon)
{
    return (struct lm_position){hs_bam(lat), hs_bam(lon)};
}

static struct lm_position moved(struct lm_position from, double azimuth, double metres)
{
    double lat, lon;
    wgs84_direct(hs_degrees(from.latitude), hs_degrees(from.longitude), azimuth, metres, &lat,
                 &lon);
    return place_at(lat, lon);
}

static double distance(struct lm_position a, struct lm_position b)
{
    return wgs84_metres(hs_degrees(a.latitude), hs_degrees(a.longitude), hs_degrees(b.latitude),
                        hs_degrees(b.longitude));
}

/* A cursor, the aircraft it is moved against, and the sector on the glass. */
struct scene {
    bool is_whole; /* the first format of the sector */
    struct lm_frame frame;
    struct lm_view view;
    struct lm_cursor cursor;
    struct lm_cursor_scene against;
    uint64_t now_us;
};

static void look_from(struct scene *s, struct lm_position ownship, double heading)
{
    s->frame = lm_frame_of_display(SIDE, SIDE);
    const struct lm_view_from from = {ownship, hs_bam(heading), 0};
    s->view = lm_view_of_sector(&s->frame, &from, RANGE_M, s->is_whole);
    s->against = (struct lm_cursor_scene){.view = &s->view,
                                          .ownship = ownship,
                                          .heading = hs_bam(heading),
                                          .scale_m = RANGE_M,
                                          .half_px = SIDE / 2,
                                          .slew_percent = 100};
}

static void steps(struct scene *s, double seconds)
{
    for (int i = 0; i < (int)lround(seconds / 0.02); i++) {
        s->now_us += LM_CURSOR_STEP_US;
        assert_true(lm_cursor_step(&s->cursor, &s->against, s->now_us));
        lm_cursor_locate(&s->cursor, &s->against);
    }
}

static const struct lm_position origins[] = {
    {0x20B60B61, 0x07D27D28},  /* 46 N 11 E */
    {0xD0000000, 0x7FFFFF00},  /* 67.5 S, the antimeridian */
    {0x00000000, 0xF0000000}}; /* the equator */

TEST(the_place_under_the_origin_is_the_origin)
{
    for (size_t o = 0; o < 3; o++) {
        struct scene s = {0};
        look_from(&s, origins[o], 30);
        const struct lm_position there = lm_view_position(&s.view, (struct lm_offset){0, 0});
        assert_true(distance(there, origins[o]) < 0.1);
    }
}

TEST(a_place_is_where_geodesics_put_it_within_a_pixel)
{
    for (size_t o = 0; o < 3; o++) {
        struct scene s = {0};
        look_from(&s, origins[o], 30);
        for (double turn = -60; turn <= 60; turn += 15) {
            for (double part = 0.05; part <= 1; part += 0.19) {
                const struct lm_position there = moved(origins[o], 30 + turn, part * RANGE_M);
                struct lm_offset found;
                assert_true(lm_view_find(&s.view, there, &found));
                const double r = part * s.view.radius_px * 256;
                /* lm_geo_inverse: 0.2 % of the distance; 210 pixels of it are half a pixel. */
                assert_true(fabs(found.x_px_q8 - r * sin(turn * pi / 180)) < 128);
                assert_true(fabs(found.y_px_q8 - r * cos(turn * pi / 180)) < 128);
                const struct lm_position back = lm_view_position(&s.view, found);
                assert_true(distance(back, there) < 0.003 * part * RANGE_M + 2);
            }
        }
    }
}

TEST(a_place_too_far_to_be_drawn_is_refused)
{
    struct scene s = {0};
    look_from(&s, origins[0], 0);
    struct lm_offset found = {1, 2};
    assert_false(lm_view_find(&s.view, moved(origins[0], 10, 260000), &found));
    assert_false(lm_view_find(&s.view, place_at(-46, -169), &found));
    struct lm_view patch = lm_view_of_patch(&s.frame, origins[0], 0, 256, 500);
    assert_false(lm_view_find(&patch, moved(origins[0], 10, 20000), &found));
    assert_int_equal(found.x_px_q8, 1);
    assert_int_equal(found.y_px_q8, 2);
}

TEST(zero_is_half_the_range_straight_ahead)
{
    struct scene s = {0};
    look_from(&s, origins[0], 77);
    steps(&s, 0.02);
    assert_true(distance(s.cursor.position, moved(origins[0], 77, RANGE_M / 2)) < 1);
    assert_true(s.cursor.is_on_glass);
    assert_in_range(s.cursor.range_m, RANGE_M / 2 - 40, RANGE_M / 2 + 40);
    assert_true(fabs(hs_degrees(s.cursor.bearing) - 77) < 0.2);
}

TEST(full_deflection_crosses_half_the_glass_in_a_second_in_every_direction)
{
    const int directions[][2] = {{1000, 0}, {-1000, 0}, {0, 1000}, {0, -1000}, {500, -500}};
    for (size_t i = 0; i < sizeof directions / sizeof *directions; i++) {
        struct scene s = {0};
        look_from(&s, origins[0], 200);
        steps(&s, 0.02);
        const struct lm_offset before = s.cursor.offset;
        s.cursor.slew_x = directions[i][0];
        s.cursor.slew_y = directions[i][1];
        steps(&s, 0.3);
        const double px_x = (s.cursor.offset.x_px_q8 - before.x_px_q8) / 256.0;
        const double px_y = (s.cursor.offset.y_px_q8 - before.y_px_q8) / 256.0;
        assert_true(fabs(px_x - 0.3 * SIDE / 2 * directions[i][0] / 1000) < 1);
        assert_true(fabs(px_y - 0.3 * SIDE / 2 * directions[i][1] / 1000) < 1);
    }
}

/* At 20 ms it steps; what is late by less than that keeps the beat, and what is missed is not made
 * up for. */
TEST(steps_keep_their_beat_and_do_not_catch_up)
{
    static const struct {
        uint64_t now_us;
        bool is_step;
    } calls[] = {{20000, true},  {39999, false},  {50000, true},   {59999, false},  {60000, true},
                 {60000, false}, {100000, true},  {100000, false}, {119999, false}, {120000, true},
                 {170000, true}, {170000, false}, {189999, false}, {189999, false}, {190000, true}};
    struct scene s = {0};
    look_from(&s, origins[0], 0);
    for (size_t i = 0; i < sizeof calls / sizeof *calls; i++) {
        assert_int_equal(lm_cursor_step(&s.cursor, &s.against, calls[i].now_us), calls[i].is_step);
    }
}

TEST(slewing_stops_at_the_edge_of_what_is_shown)
{
    for (int turn = 0; turn < 360; turn += 20) {
        struct scene s = {0};
        look_from(&s, origins[1], 10);
        steps(&s, 0.02);
        s.cursor.slew_x = (int32_t)lround(1000 * sin(turn * pi / 180));
        s.cursor.slew_y = (int32_t)lround(1000 * cos(turn * pi / 180));
        steps(&s, 5);
        assert_true(s.cursor.is_on_glass);
        assert_true(hypot(s.cursor.offset.x_px_q8, s.cursor.offset.y_px_q8) <
                    (s.view.radius_px + 1.5) * 256);
        assert_true(s.cursor.offset.y_px_q8 > -256);
        s.view = lm_view_of_patch(&s.frame, moved(origins[1], 10, 15000), hs_bam(40), 256, 5000);
        steps(&s, 5);
        assert_true(s.cursor.is_on_glass);
        const int32_t most_q8 = (s.view.radius_px + 1) * 256;
        assert_in_range(s.cursor.offset.x_px_q8 + most_q8, 0, 2 * most_q8);
        assert_in_range(s.cursor.offset.y_px_q8 + most_q8, 0, 2 * most_q8);
    }
}

/* [FreeFalcon], gmscope.cpp 1320: the cursor is capped at 0.95 of half the viewport's height. */
TEST(a_slewed_cursor_stays_in_the_box_of_the_source_and_in_the_frame)
{
    static const int towards[][2] = {{-1000, 0}, {1000, 0}, {0, -1000}, {-1000, -1000}, {0, 1000}};
    for (size_t i = 0; i < 2 * sizeof towards / sizeof *towards; i++) {
        struct scene s = {.is_whole = i % 2};
        look_from(&s, origins[1], 10);
        steps(&s, 0.02);
        s.cursor.slew_x = towards[i / 2][0];
        s.cursor.slew_y = towards[i / 2][1];
        steps(&s, 5);
        const double height = s.frame.height_px, wide = s.frame.width_px / 2;
        const double x = s.cursor.offset.x_px_q8 / 256.0, y = s.cursor.offset.y_px_q8 / 256.0;
        assert_true(s.cursor.is_on_glass);
        assert_true(fabs(x) < fmin(0.475 * height, wide - 1) + 1);
        assert_true(y > 0.025 * height - 1 && y < 0.975 * height + 1);
        if (!s.is_whole && s.cursor.slew_x != 0 && s.cursor.slew_y == 0) {
            assert_true(fabs(x) > 0.475 * height - 1);
        }
        if (!s.is_whole && s.cursor.slew_y == 1000) {
            assert_true(y > 0.975 * height - 1);
        }
    }
}

TEST(a_place_that_the_frame_cuts_off_is_not_on_the_glass)
{
    struct scene s = {0};
    look_from(&s, origins[0], 0);
    const double aside_m = (double)RANGE_M * s.view.aside_px / s.view.radius_px;
    s.cursor.is_placed = true;
    for (int out = -1; out <= 1; out += 2) {
        for (int side = -1; side <= 1; side += 2) {
            const struct lm_position ahead = moved(origins[0], 0, RANGE_M / 2.0);
            s.cursor.position = moved(ahead, 90 * side, aside_m * (1 + 0.02 * out));
            lm_cursor_locate(&s.cursor, &s.against);
            assert_int_equal(s.cursor.is_on_glass, out < 0);
        }
    }
}

TEST(the_cursor_stays_over_its_place_while_the_aircraft_flies_and_turns)
{
    struct scene s = {0};
    look_from(&s, origins[0], 0);
    steps(&s, 0.02);
    const struct lm_position held = s.cursor.position;
    for (int second = 1; second <= 60; second++) {
        look_from(&s, moved(origins[0], 20, 150.0 * second), second * 0.5);
        steps(&s, 0.02);
        assert_int_equal(s.cursor.position.latitude, held.latitude);
        assert_int_equal(s.cursor.position.longitude, held.longitude);
        struct lm_offset found;
        assert_true(lm_view_find(&s.view, held, &found));
        assert_int_equal(found.x_px_q8, s.cursor.offset.x_px_q8);
    }
    assert_true(s.cursor.range_m < RANGE_M / 2 - 7000);
}

TEST(in_snowplow_it_moves_with_the_aircraft_until_it_is_stabilised)
{
    struct scene s = {.cursor.is_snowplow = true};
    s.cursor.slew_x = 1000; /* which snowplow does not heed */
    for (int second = 0; second <= 30; second++) {
        const struct lm_position ownship = moved(origins[0], 20, 150.0 * second);
        look_from(&s, ownship, second);
        steps(&s, 0.02);
        assert_true(distance(s.cursor.position, moved(ownship, second, RANGE_M / 2)) < 1);
    }
    s.cursor.slew_x = 0;
    lm_cursor_stabilise(&s.cursor);
    const struct lm_position held = s.cursor.position;
    look_from(&s, moved(origins[0], 20, 9000), 50);
    steps(&s, 0.1);
    assert_memory_equal(&s.cursor.position, &held, sizeof held);
}

TEST(automatic_range_goes_up_from_095_and_down_below_0425)
{
    const struct {
        double part;
        int wants;
    } cases[] = {{0.951, 1}, {1.5, 1}, {0.949, 0}, {0.6, 0}, {0.4255, 0}, {0.4245, -1}, {0.1, -1}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct lm_cursor c = {.range_m = (uint32_t)(cases[i].part * RANGE_M), .offset = {0, 25600}};
        assert_int_equal(lm_cursor_wants_range(&c, RANGE_M), cases[i].wants);
        c.offset.y_px_q8 = -25600; /* flown past: stays */
        assert_int_equal(lm_cursor_wants_range(&c, RANGE_M), 0);
    }
    /* To the metre, on scales of whole nautical miles. */
    for (uint32_t nm = 5; nm <= 160; nm++) {
        const uint32_t scale_m = nm * 1852;
        for (uint32_t m = 1; m <= scale_m; m++) {
            const struct lm_cursor c = {.range_m = m, .offset = {0, 25600}};
            const int wanted = m * 20 >= scale_m * 19 ? 1 : m * 40 < scale_m * 17 ? -1 : 0;
            assert_int_equal(lm_cursor_wants_range(&c, scale_m), wanted);
        }
    }
    /* Between two scales no cursor makes it swing. */
    for (uint32_t m = 1; m < 200000; m += 7) {
        const struct lm_cursor c = {.range_m = m, .offset = {0, 25600}};
        assert_false(lm_cursor_wants_range(&c, 37040) == 1 &&
                     lm_cursor_wants_range(&c, 74080) == -1);
    }
}

TEST(a_cursor_beyond_reach_comes_home_when_it_is_slewed)
{
    struct scene s = {0};
    look_from(&s, origins[0], 0);
    steps(&s, 0.02);
    look_from(&s, moved(origins[0], 90, 900000), 0);
    steps(&s, 0.1);
    assert_false(s.cursor.is_on_glass);
    s.cursor.slew_x = 10;
    steps(&s, 0.1);
    assert_true(s.cursor.is_on_glass);
    assert_true(s.cursor.range_m < RANGE_M);
}
