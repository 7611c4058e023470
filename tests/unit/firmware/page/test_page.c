/* Every key of the page pressed: what it does to the unit, and what the glass then says. Keys stand
 * where RADAR facts put them: 1 = top left, clockwise, five to a side, three tenths of half a
 * screen apart. */
#include "check.h"
#include "glass_text.h"
#include "hs/angle.h"
#include "lm/bit.h"
#include "lm/font.h"
#include "scales.h"
#include "unit_rig.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int says_inverse(const struct rig *r, const char *words)
{
    const struct lm_surface s = glass_of(r);
    return glass_find(&s, words, r->unit.palette.ink, r->unit.palette.symbol, NULL);
}

static int warns(const struct rig *r, const char *words)
{
    const struct lm_surface s = glass_of(r);
    return glass_find(&s, words, r->unit.palette.warning, r->unit.palette.ink, NULL);
}

/* Whether these words are the label of that key: beside it, and in inverse video or not. */
static int labelled(const struct rig *r, int osb, const char *words, int is_inverse)
{
    const struct lm_surface s = glass_of(r);
    const uint32_t symbol = r->unit.palette.symbol, ink = r->unit.palette.ink;
    struct lm_point at;
    if (!glass_find(&s, words, is_inverse ? ink : symbol, is_inverse ? symbol : ink, &at)) {
        return 0;
    }
    const struct lm_pen pen = lm_pen_for(&s, symbol);
    const int side = (osb - 1) / 5, along = (osb - 1) % 5;
    const double middle = 240 * (1 + 0.3 * (side < 2 ? along - 2 : 2 - along));
    const int32_t width = lm_text_width(&pen, words);
    switch (side) {
    case 0:
        return at.y < 20 && fabs(at.x + width / 2.0 - middle) < 3;
    case 1:
        return at.x + width > WIDTH - 10 && fabs(at.y + 7 - middle) < 12;
    case 2:
        return at.y > HEIGHT - 24 && fabs(at.x + width / 2.0 - middle) < 3;
    default:
        return at.x < 10 && fabs(at.y + 7 - middle) < 12;
    }
}

TEST(the_page_after_power_up_has_the_labels_of_the_key_map)
{
    struct rig *r = start_rig();
    run(r, 1);
    static const struct {
        int osb;
        const char *words;
        int is_inverse;
    } map[] = {{1, "GM", 0},    {2, "MAN", 0},   {3, "NORM", 0},         {4, "OVRD", 0},
               {5, "CNTL", 0},  {7, "FZ", 0},    {8, "SP", 0},           {9, "CZ", 0},
               {10, "STP", 1},  {11, "DCLT", 0}, {12, "BIT", 0},         {13, "FCR", 1},
               {14, "TEST", 0}, {15, "SWAP", 0}, {19, LM_GLYPH_DOWN, 0}, {20, LM_GLYPH_UP, 0}};
    assert_false(says(r, "CELL"));
    for (size_t i = 0; i < sizeof map / sizeof *map; i++) {
        if (!labelled(r, map[i].osb, map[i].words, map[i].is_inverse)) {
            fail_msg("OSB %d does not say %s", map[i].osb, map[i].words);
        }
    }
    const struct lm_surface s = glass_of(r);
    struct lm_point at;
    assert_true(glass_find(&s, "40", r->unit.palette.symbol, 0, &at)); /* between 19 and 20 */
    assert_in_range(at.y, 96 + 7, 168 - 21);
    assert_true(at.x < 10);
    free_rig(r);
}

TEST(osb_1_goes_round_the_modes_and_leaves_the_patch)
{
    static const char *const modes[] = {"GMT", "SEA", "BCN", "GM"};
    struct rig *r = fly_rig();
    for (int i = 0; i < LM_SECTOR_CHOICES; i++) {
        const uint32_t before = plane_sum(r);
        press(r, 1);
        assert_true(labelled(r, 1, modes[i], 0));
        assert_int_equal(r->unit.picture.sector.command.mode, (i + 1) % LM_SECTOR_CHOICES);
        run(r, 2.2);
        assert_true(plane_sum(r) != before);
    }
    command(r, patch_here);
    run(r, 0.1);
    assert_int_equal(r->unit.page.picture, LM_PICTURE_PATCH);
    assert_true(labelled(r, 3, "SAR", 0));
    press(r, 1);
    assert_int_not_equal(r->unit.page.picture, LM_PICTURE_PATCH);
    assert_true(labelled(r, 3, "NORM", 0));
    free_rig(r);
}

TEST(osb_2_lets_the_range_follow_the_cursor)
{
    struct rig *r = fly_rig();
    press(r, 2);
    assert_true(r->unit.page.is_auto_range);
    assert_true(labelled(r, 2, "AUTO", 0));
    assert_int_equal(r->unit.page.range_index, scale_of(10));
    /* From half of 10 nm up to where 20 nm is due. */
    command(r, lm_control_slew(0, 1000));
    run(r, 0.7);
    command(r, lm_control_slew(0, 0));
    run(r, 0.1);
    assert_int_equal(r->unit.page.range_index, scale_of(20));
    assert_true(says(r, "20"));
    /* And back: below 0.425 of 20 nm. */
    command(r, lm_control_slew(0, -1000));
    run(r, 0.3);
    command(r, lm_control_slew(0, 0));
    run(r, 0.1);
    assert_int_equal(r->unit.page.range_index, scale_of(10));
    press(r, 2);
    assert_true(labelled(r, 2, "MAN", 0));
    free_rig(r);
}

TEST(osb_3_goes_round_the_fields_of_view_and_each_draws_its_own_picture)
{
    static const char *const fields[] = {"EXP", "DBS1", "DBS2", "NORM"};
    struct rig *r = fly_rig();
    uint32_t sums[4];
    for (int i = 0; i < 4; i++) {
        press(r, 3);
        assert_true(labelled(r, 3, fields[i], 0));
        assert_int_equal(r->unit.picture.sector.command.fov, (i + 1) % LM_FOVS);
        struct lm_label label; /* a window has no scan of its own */
        assert_int_equal(lm_page_label(&r->unit.page, 18, &label), i == 3);
        run(r, 4);
        assert_true(lit_pixels(r) > 10000);
        sums[i] = plane_sum(r);
        assert_true(i == 0 || sums[i] != sums[i - 1]);
    }
    command(r, patch_here);
    run(r, 0.2);
    press(r, 3);
    assert_int_not_equal(r->unit.page.picture, LM_PICTURE_PATCH);
    free_rig(r);
}

TEST(osb_3_offers_no_sharpening_at_80_nm_and_none_in_gmt)
{
    struct rig *r = fly_rig();
    command(r, (struct lm_control){.kind = LM_CONTROL_RANGE, .range_nm = 80});
    press(r, 3);
    assert_true(labelled(r, 3, "EXP", 0));
    press(r, 3);
    assert_true(labelled(r, 3, "NORM", 0));
    press(r, 1);
    assert_true(labelled(r, 1, "GMT", 0));
    assert_true(says(r, "40")); /* the largest scale of GMT */
    press(r, 20);
    assert_true(says(r, "40"));
    press(r, 3);
    press(r, 3);
    assert_true(labelled(r, 3, "NORM", 0));
    free_rig(r);
}

TEST(osb_3_begins_no_new_sweep_in_a_mode_of_one_field)
{
    struct lm_radar table = lm_radar_default;
    struct lm_page page;
    lm_page_init(&page, &table);
    assert_int_equal(lm_page_press(&page, (struct lm_press){.button = 3}), LM_EFFECT_SECTOR);
    assert_int_equal(page.fov, LM_FOV_EXP);
    table.mode[LM_SECTOR_GM].fov_last = LM_FOV_NORM;
    lm_page_init(&page, &table);
    assert_int_equal(lm_page_press(&page, (struct lm_press){.button = 3}), 0);
    assert_int_equal(page.fov, LM_FOV_NORM);
}

TEST(osb_4_stops_the_transmitter_and_the_picture_says_so)
{
    struct rig *r = fly_rig();
    press(r, 4);
    const uint32_t lines = r->unit.count.lines, sum = plane_sum(r);
    run(r, 0.5);
    assert_int_equal(r->unit.count.lines, lines);
    assert_int_equal(plane_sum(r), sum);
    assert_true(labelled(r, 4, "OVRD", 1));
    assert_true(warns(r, "NO RAD"));
    command(r, lm_control_designate()); /* a patch would need it */
    run(r, 0.1);
    assert_int_not_equal(r->unit.page.picture, LM_PICTURE_PATCH);
    assert_true(warns(r, "UNABLE"));
    press(r, 4);
    run(r, 0.5);
    assert_true(r->unit.count.lines > lines + 50);
    assert_true(labelled(r, 4, "OVRD", 0));
    assert_false(warns(r, "NO RAD"));
    free_rig(r);
}

TEST(osb_5_opens_the_control_page_over_the_picture_and_closes_it)
{
    struct rig *r = fly_rig();
    press(r, 5);
    assert_true(labelled(r, 5, "CNTL", 1));
    assert_true(labelled(r, 10, "RESET", 0));
    assert_true(says(r, "GAMMA") && says(r, "WHITE") && says(r, "BLACK"));
    assert_true(lit_pixels(r) > 10000);
    press(r, 5);
    assert_true(labelled(r, 5, "CNTL", 0));
    assert_false(says(r, "GAMMA"));
    free_rig(r);
}

TEST(osb_6_flies_by_the_barometric_height)
{
    struct rig *r = fly_rig();
    assert_true(labelled(r, 6, "BARO", 0));
    assert_int_equal(r->unit.ownship.height_source, LM_BUS_ELLIPSOID_HEIGHT);
    const uint32_t before = plane_sum(r);
    press(r, 6);
    run(r, 2.5);
    assert_true(labelled(r, 6, "BARO", 1));
    assert_int_equal(r->unit.ownship.height_source, LM_BUS_BARO_ALTITUDE);
    assert_int_equal(r->unit.ownship.height_m_q6, 2300 * 64);
    assert_true(plane_sum(r) != before); /* the hole is wider from higher up */
    press(r, 6);
    run(r, 0.1);
    assert_int_equal(r->unit.ownship.height_source, LM_BUS_ELLIPSOID_HEIGHT);
    free_rig(r);
}

TEST(osb_17_is_blank_until_it_tracks_and_held_it_ranges)
{
    struct rig *r = fly_rig();
    struct lm_label label;
    assert_false(lm_page_label(&r->unit.page, 17, &label));
    press(r, 17);
    run(r, 0.1);
    assert_true(labelled(r, 17, "FTT", 1));
    press(r, 17);
    run(r, 0.1);
    assert_false(lm_page_label(&r->unit.page, 17, &label));
    hold(r, 17, 1);
    run(r, 0.1);
    assert_true(labelled(r, 17, "AGR", 1));
    free_rig(r);
}

/* On the control page: what a key changes, and what stands between it and its pair. */
TEST(the_control_pages_keys_change_the_tone_of_the_picture)
{
    static const struct {
        int up, down;
        const char *words_up, *words_down;
    } pairs[] = {{20, 19, "1.6", "1.4"}, {18, 17, "+1", "-1"}, {6, 7, "+1", "-1"}};
    for (size_t i = 0; i < 3; i++) {
        struct rig *r = fly_rig();
        const struct lm_tone before = r->unit.picture.tone[LM_PICTURE_SECTOR];
        press(r, 5);
        press(r, pairs[i].up);
        assert_true(says(r, pairs[i].words_up));
        assert_memory_not_equal(&r->unit.picture.tone[LM_PICTURE_SECTOR], &before, sizeof before);
        press(r, pairs[i].down);
        assert_memory_equal(&r->unit.picture.tone[LM_PICTURE_SECTOR], &before, sizeof before);
        press(r, pairs[i].down);
        assert_true(says(r, pairs[i].words_down));
        hold(r, pairs[i].up, 5); /* repeats until it stands at its end */
        const struct lm_page *p = &r->unit.page;
        assert_int_equal(p->gamma_tenths + p->white_db + p->black_db, i == 0 ? 10 : 20);
        press(r, 10); /* RESET */
        assert_memory_equal(&r->unit.picture.tone[LM_PICTURE_SECTOR], &before, sizeof before);
        free_rig(r);
    }
}

/* How bright the radar picture is: its greys added up. */
static uint64_t brightness(const struct rig *r)
{
    const struct lm_plane *plane = &r->unit.picture.plane;
    uint64_t sum = 0;
    for (int i = 0; i < plane->width_px * plane->height_px; i++) {
        sum += plane->pixels[i];
    }
    return sum;
}

TEST(osb_1_to_4_of_the_control_page_point_and_shape_the_beam)
{
    struct rig *r = fly_rig();
    run(r, 1.5);
    press(r, 5);
    assert_true(labelled(r, 1, "AUTO", 0));
    assert_true(labelled(r, 4, "BEAM", 0));
    const int32_t automatic = r->unit.picture.sector.tilt;
    const uint64_t before = brightness(r);
    assert_true(automatic < 0); /* down at the end of the range */
    for (int i = 0; i < 50; i++) {
        press(r, 2);
    }
    assert_true(labelled(r, 1, "TILT", 1));
    /* Twenty-five degrees up, as near as tenths of a degree tell where it was. */
    const double up_deg = (r->unit.picture.sector.tilt - automatic) * 360.0 / 4294967296;
    assert_true(fabs(up_deg - 25) < 0.1);
    run(r, 2.5);
    assert_true(brightness(r) < before / 2); /* it looks over the near ground */
    press(r, 3);
    assert_true(r->unit.picture.sector.tilt < automatic + (int32_t)FX_BAM_DEG(25));
    press(r, 1);
    assert_true(labelled(r, 1, "AUTO", 0));
    run(r, 1.5);
    assert_true(abs(r->unit.picture.sector.tilt - automatic) < (int32_t)FX_BAM_DEG(1));
    const uint64_t fan = brightness(r);
    press(r, 4);
    assert_true(labelled(r, 4, "BEAM", 1));
    run(r, 2.5);
    assert_true(brightness(r) < fan / 2); /* only a ring is lit */
    press(r, 10);
    assert_true(labelled(r, 4, "BEAM", 0));
    free_rig(r);
}

TEST(tilt_by_hand_ends_where_the_antenna_does)
{
    struct rig *r = fly_rig();
    const double end_deg = lm_radar_default.antenna.tilt_max * 360.0 / 4294967296;
    run(r, 1.5);
    press(r, 5);
    for (int way = 0; way < 2; way++) {
        for (int i = 0; i < 4 * 60; i++) {
            press(r, 2 + way);
        }
        const double tilt_deg = (int32_t)r->unit.picture.sector.tilt * 360.0 / 4294967296;
        assert_true(fabs(fabs(tilt_deg) - end_deg) < 0.1);
        assert_true((tilt_deg > 0) == (way == 0));
    }
    free_rig(r);
}

TEST(osb_16_of_the_control_page_shows_patches_as_plans)
{
    struct rig *r = fly_rig();
    command(r, patch_here);
    run(r, 5);
    assert_false(r->unit.picture.sar.command.is_plan);
    press(r, 5);
    assert_true(labelled(r, 16, "SAR", 0));
    press(r, 16);
    assert_true(labelled(r, 16, "SAR", 1));
    assert_true(r->unit.page.picture == LM_PICTURE_PATCH && r->unit.picture.sar.command.is_plan);
    run(r, 5);
    assert_true(lit_pixels(r) > 10000);
    press(r, 16);
    assert_false(r->unit.picture.sar.command.is_plan);
    free_rig(r);
}

TEST(osb_8_and_9_of_the_control_page_choose_tint_and_night)
{
    struct rig *r = fly_rig();
    const struct lm_palette day = r->unit.palette;
    press(r, 5);
    assert_true(labelled(r, 8, "GREY", 0));
    press(r, 8);
    assert_true(labelled(r, 8, "GREEN", 0));
    assert_true((r->unit.palette.picture[255] >> 8 & 255) > (r->unit.palette.picture[255] >> 16));
    press(r, 8);
    assert_true(labelled(r, 8, "AMBER", 0));
    press(r, 8);
    assert_memory_equal(&r->unit.palette, &day, sizeof day);
    press(r, 9);
    assert_true(labelled(r, 9, "NIGHT", 1));
    uint32_t brightest = 0;
    for (size_t i = 0; i < WIDTH * HEIGHT; i++) {
        brightest = (r->glass[i] & 255) > brightest ? r->glass[i] & 255 : brightest;
    }
    assert_true(brightest < 128);
    press(r, 9);
    assert_true(labelled(r, 9, "DAY", 0));
    free_rig(r);
}

/* Middle of the ownship's circle, found by its pixels on the frozen glass: the lowest row of the
 * symbol's colour within the frame's columns near the apex. */
static int32_t ownship_top(const struct rig *r)
{
    const struct lm_frame *f = &r->unit.picture.frame;
    const int32_t x = f->left_px + f->width_px / 2 + 12; /* right of the line: radius 0.05 of 240 */
    for (int32_t y = f->top_px; y < f->top_px + f->height_px; y++) {
        if (r->glass[y * WIDTH + x] == r->unit.palette.symbol &&
            r->glass[(y + 2) * WIDTH + x] == r->unit.palette.symbol && y > 300) {
            return y;
        }
    }
    return -1;
}

TEST(osb_7_freezes_the_map_and_the_ownship_moves_over_it)
{
    struct rig *r = fly_rig();
    /* Out of the way with the cursor's lines. */
    command(r, lm_control_slew(-1000, 0));
    run(r, 0.5);
    command(r, lm_control_slew(0, 0));
    press(r, 7);
    assert_true(labelled(r, 7, "FZ", 1));
    assert_true(warns(r, "FZ"));
    const uint32_t sum = plane_sum(r), lines = r->unit.count.lines;
    const int32_t before = ownship_top(r);
    run(r, 20); /* 3,000 m: 55.6 of the 343 pixels of 18,520 m */
    assert_int_equal(plane_sum(r), sum);
    assert_int_equal(r->unit.count.lines, lines);
    const int32_t after = ownship_top(r);
    assert_true(before > 0 && after > 0);
    assert_in_range(before - after, 53, 58);
    press(r, 7);
    run(r, 0.5);
    assert_true(labelled(r, 7, "FZ", 0));
    assert_true(r->unit.count.lines > lines + 50);
    free_rig(r);
}

TEST(a_new_scale_ends_the_freeze)
{
    struct rig *r = fly_rig();
    press(r, 7);
    press(r, 20);
    assert_false(r->unit.page.is_frozen);
    run(r, 1);
    assert_true(lit_pixels(r) > 1000);
    free_rig(r);
}

TEST(osb_8_and_10_choose_snowplow_or_a_held_cursor)
{
    struct rig *r = fly_rig();
    press(r, 8);
    assert_true(labelled(r, 8, "SP", 1) && labelled(r, 10, "STP", 0));
    const struct lm_position start = r->unit.cursor.position;
    const uint32_t half = lm_radar_default.range[scale_of(10)].range_m / 2;
    run(r, 10);
    assert_true(r->unit.cursor.position.latitude - start.latitude > 150000); /* 1,500 m: 161,000 */
    assert_in_range(r->unit.cursor.range_m, half - 20, half + 20);
    command(r, lm_control_designate()); /* stabilises, and no more */
    run(r, 0.05);
    assert_int_not_equal(r->unit.page.picture, LM_PICTURE_PATCH);
    const struct lm_position held = r->unit.cursor.position;
    run(r, 10);
    assert_memory_equal(&r->unit.cursor.position, &held, sizeof held);
    press(r, 10);
    assert_true(labelled(r, 8, "SP", 0) && labelled(r, 10, "STP", 1));
    run(r, 1);
    assert_memory_equal(&r->unit.cursor.position, &held, sizeof held);
    free_rig(r);
}

TEST(osb_9_brings_the_cursor_home)
{
    struct rig *r = fly_rig();
    command(r, lm_control_slew(1000, -500));
    run(r, 0.4);
    command(r, lm_control_slew(0, 0));
    run(r, 0.1);
    assert_true(r->unit.cursor.offset.x_px_q8 > 80 * 256);
    press(r, 9);
    const uint32_t half = lm_radar_default.range[scale_of(10)].range_m / 2;
    assert_in_range(r->unit.cursor.offset.x_px_q8 + 256, 0, 512);
    assert_in_range(r->unit.cursor.range_m, half - 60, half + 20);
    free_rig(r);
}

TEST(osb_11_takes_the_chosen_labels_away_and_never_an_unusual_one)
{
    struct rig *r = fly_rig();
    press(r, 11);
    assert_true(labelled(r, 11, "DCLT", 1));
    const char *const gone[] = {"SP", "CZ", "STP", "BIT", "TEST", "SWAP", "CELL"};
    for (size_t i = 0; i < sizeof gone / sizeof *gone; i++) {
        assert_false(says(r, gone[i]) || says_inverse(r, gone[i]));
    }
    assert_true(labelled(r, 1, "GM", 0) && labelled(r, 3, "NORM", 0));
    press(r, 7); /* the key works, and what it says is unusual now */
    assert_true(labelled(r, 7, "FZ", 1));
    press(r, 11);
    assert_true(labelled(r, 9, "CZ", 0) && labelled(r, 15, "SWAP", 0));
    free_rig(r);
}

TEST(osb_11_held_opens_the_choice_of_labels)
{
    struct rig *r = fly_rig();
    hold(r, 11, 1);
    assert_int_equal(r->unit.page.format, LM_FORMAT_DCLT);
    assert_true(labelled(r, 9, "CZ", 1) && labelled(r, 1, "GM", 0));
    press(r, 9);
    press(r, 1);
    press(r, 19);
    assert_true(labelled(r, 9, "CZ", 0) && labelled(r, 1, "GM", 1));
    assert_int_equal(r->unit.page.range_index, scale_of(10)); /* the keys only choose */
    press(r, 11);
    assert_int_equal(r->unit.page.format, LM_FORMAT_RADAR);
    press(r, 11);
    assert_true(labelled(r, 9, "CZ", 0));
    assert_false(says(r, "GM"));
    free_rig(r);
}

TEST(osb_12_to_14_are_the_direct_access_to_the_formats)
{
    struct rig *r = fly_rig();
    press(r, 12);
    assert_int_equal(r->unit.page.format, LM_FORMAT_BIT);
    assert_true(labelled(r, 12, "BIT", 1) && labelled(r, 13, "FCR", 0));
    const uint32_t lines = r->unit.count.lines;
    press(r, 14);
    assert_int_equal(r->unit.page.format, LM_FORMAT_TEST);
    assert_true(labelled(r, 14, "TEST", 1));
    assert_true(says(r, "ABCDEFGHIJKLMNOPQRSTUVWXYZ"));
    run(r, 1);
    assert_true(r->unit.count.lines > lines + 200); /* the radar works on behind it */
    press(r, 13);
    assert_int_equal(r->unit.page.format, LM_FORMAT_RADAR);
    assert_true(labelled(r, 13, "FCR", 1));
    free_rig(r);
}

/* With another display: test_swap. */
TEST(osb_15_without_another_display_is_refused)
{
    struct rig *r = fly_rig();
    press(r, 15);
    assert_int_equal(r->unit.refusal, LM_REFUSED_SWAP);
    press(r, 12);
    press(r, 15);
    assert_int_equal(r->unit.count.commands_refused, 2);
    assert_int_equal(r->unit.page.format, LM_FORMAT_BIT);
    assert_true(says(r, "SWAPS    0"));
    free_rig(r);
}

/* Move the cursor off the track, where a patch can be made. */
static void slew_right(struct rig *r)
{
    command(r, lm_control_slew(1000, 0));
    run(r, 0.3);
    command(r, lm_control_slew(0, 0));
    run(r, 0.1);
}

TEST(osb_16_chooses_the_cell_and_draws_the_patch_again)
{
    struct rig *r = fly_rig();
    press(r, 16); /* free in a sector */
    assert_false(says(r, "5M") || says(r, "10M"));
    slew_right(r);
    command(r, lm_control_designate());
    run(r, 1);
    assert_int_equal(r->unit.page.picture, LM_PICTURE_PATCH);
    assert_int_equal(r->unit.picture.sar.command.cell_mm, 5000);
    assert_true(says(r, "CELL 5.0M") && says(r, "5M"));
    press(r, 16);
    assert_int_equal(r->unit.picture.sar.command.cell_mm, 10000);
    assert_true(says(r, "10M"));
    const struct lm_position centre = r->unit.picture.sar.command.centre;
    press(r, 16);
    assert_int_equal(r->unit.picture.sar.command.cell_mm, 20000);
    assert_memory_equal(&r->unit.picture.sar.command.centre, &centre, sizeof centre);
    assert_true(says(r, "CELL 20.0M"));
    free_rig(r);
}

TEST(the_page_shows_the_cell_and_the_geometry_that_a_command_chose)
{
    struct rig *r = fly_rig();
    struct lm_control patch = patch_here;
    patch.sar.cell_mm = 2500;
    patch.sar.is_plan = true;
    command(r, patch);
    run(r, 0.5);
    struct lm_label label;
    assert_true(lm_page_label(&r->unit.page, 16, &label));
    assert_string_equal(label.line[1], "2.5M");
    press(r, 16);
    assert_int_equal(r->unit.picture.sar.command.cell_mm,
                     3000); /* the next larger that is offered */
    assert_true(says(r, "3M") && r->unit.picture.sar.command.is_plan);
    press(r, 5);
    assert_true(labelled(r, 16, "SAR", 1));
    free_rig(r);
}

/* How far from straight up the outer half of the picture reaches, degrees. */
static double widest_degrees(const struct rig *r)
{
    const struct lm_point apex = r->unit.picture.view.at;
    double widest = 0;
    for (int32_t y = 0; y < HEIGHT; y++) {
        for (int32_t x = 0; x < WIDTH; x++) {
            const double right = x + 0.5 - apex.x, up = apex.y - (y + 0.5);
            if (r->plane[y * WIDTH + x] > 0 &&
                hypot(right, up) > r->unit.picture.view.radius_px / 2.0) {
                widest = fmax(widest, fabs(atan2(right, up)) * 57.29578);
            }
        }
    }
    return widest;
}

TEST(osb_18_goes_through_the_azimuths)
{
    struct rig *r = fly_rig();
    const char *const digits[] = {"3", "1", "6"};
    const fx_bam_t halves[] = {FX_BAM_DEG(30), FX_BAM_DEG(10), FX_BAM_DEG(60)};
    for (int i = 0; i < 3; i++) {
        press(r, 18);
        assert_int_equal(
            lm_radar_default.azimuth_half[r->unit.picture.sector.command.azimuth_index], halves[i]);
        struct lm_label label;
        assert_true(lm_page_label(&r->unit.page, 18, &label));
        assert_string_equal(label.line[0], "A");
        assert_string_equal(label.line[1], digits[i]);
        run(r, 1);
        const double half = i == 0 ? 30 : i == 1 ? 10 : 60;
        const double widest = widest_degrees(r);
        assert_true(widest > half - 3 && widest < half + 1.5);
    }
    free_rig(r);
}

TEST(osb_19_and_20_step_the_range_and_end_automatic_range)
{
    struct rig *r = fly_rig();
    char words[8];
    press(r, 2);
    for (int range = scale_of(10) + 1; range < lm_radar_default.ranges; range++) {
        press(r, 20);
        assert_int_equal(r->unit.picture.sector.command.range_index, range);
        snprintf(words, sizeof words, "%d", lm_radar_default.range[range].range_nm);
        assert_true(says(r, words));
        assert_false(r->unit.page.is_auto_range);
    }
    assert_false(says(r, LM_GLYPH_UP)); /* no further */
    press(r, 20);
    assert_int_equal(r->unit.picture.sector.command.range_index, lm_radar_default.ranges - 1);
    for (int range = lm_radar_default.ranges - 2; range >= 0; range--) {
        press(r, 19);
        assert_int_equal(r->unit.picture.sector.command.range_index, range);
        snprintf(words, sizeof words, "%d", lm_radar_default.range[range].range_nm);
        assert_true(says(r, words));
    }
    assert_false(says(r, LM_GLYPH_DOWN));
    free_rig(r);
}

TEST(rockers_and_the_range_knob_change_gain_and_glass)
{
    struct rig *r = fly_rig();
    const struct lm_tone tone = r->unit.picture.tone[LM_PICTURE_SECTOR];
    press(r, lm_rocker_button(LM_ROCKER_GAIN, true));
    assert_int_equal(r->unit.page.gain_db, 1);
    assert_memory_not_equal(&r->unit.picture.tone[LM_PICTURE_SECTOR], &tone, sizeof tone);
    press(r, lm_rocker_button(LM_ROCKER_GAIN, false));
    command(r, lm_control_knob(1000));
    run(r, 0.01);
    const struct lm_tone_config table = lm_radar_default.mode[LM_SECTOR_GM].tone;
    const struct lm_tone_config config = lm_page_tone(&r->unit.page, &table);
    /* 20 % of amplitude: 20 log10 1.2 = 1.584 dB */
    assert_true(fabs((table.black_db_q8 - config.black_db_q8) / 256.0 - 1.584) < 0.01);
    command(r, lm_control_knob(0));
    run(r, 0.01);
    assert_memory_equal(&r->unit.picture.tone[LM_PICTURE_SECTOR], &tone, sizeof tone);
    const struct lm_palette palette = r->unit.palette;
    const enum lm_rocker rockers[] = {LM_ROCKER_SYM, LM_ROCKER_BRT, LM_ROCKER_CON};
    for (int i = 0; i < 3; i++) {
        press(r, lm_rocker_button(rockers[i], false));
        assert_memory_not_equal(&r->unit.palette, &palette, sizeof palette);
        assert_true(says(r, "NORM"));
        press(r, lm_rocker_button(rockers[i], true));
        assert_memory_equal(&r->unit.palette, &palette, sizeof palette);
    }
    hold(r, lm_rocker_button(LM_ROCKER_GAIN, true), 5);
    assert_int_equal(r->unit.page.gain_db, LM_GAIN_MAX_DB);
    free_rig(r);
}

/* The columns of the cursor's vertical and the rows of its horizontal line. */
TEST(the_cursors_lines_cross_the_whole_frame_at_its_place)
{
    struct rig *r = fly_rig();
    command(r, lm_control_slew(700, 300));
    run(r, 0.3);
    command(r, lm_control_slew(0, 0));
    run(r, 0.1);
    const struct lm_frame *f = &r->unit.picture.frame;
    const struct lm_point at = lm_view_point(&r->unit.picture.view, r->unit.cursor.offset);
    for (int32_t x = f->left_px; x < f->left_px + f->width_px; x++) {
        assert_int_equal(r->glass[at.y * WIDTH + x], r->unit.palette.symbol);
    }
    for (int32_t y = f->top_px; y < f->top_px + f->height_px; y++) {
        assert_int_equal(r->glass[y * WIDTH + at.x], r->unit.palette.symbol);
    }
    /* The cue: ticks across the lines at an eighth of the range. */
    const int32_t away = r->unit.picture.view.radius_px / 8;
    for (int side = -1; side <= 1; side += 2) {
        assert_int_equal(r->glass[(at.y + 5) * WIDTH + at.x + side * away], r->unit.palette.symbol);
        assert_int_equal(r->glass[(at.y + side * away) * WIDTH + at.x - 5], r->unit.palette.symbol);
    }
    free_rig(r);
}

TEST(the_cursors_numbers_are_right)
{
    struct rig *r = fly_rig();
    /* Zero: 5 nm due north of the aircraft at the moment of the press, 46 N 11 E minus 0.05 degree
     * plus what it has flown at 150 m/s. */
    press(r, 9);
    run(r, 0.1);
    const double flown = 150 * (double)r->now_us / 1e6;
    const double lat = hs_degrees(r->unit.cursor.position.latitude);
    const double own = 46 - 0.05 + flown / 111132.0;
    assert_true(fabs((lat - own) * 111149 - 9260) < 60); /* a degree at 46 N: 111,149 m */
    char words[32];
    const double minutes = (lat - 45) * 60;
    snprintf(words, sizeof words, "N45" LM_GLYPH_DEGREE "%05.2f", minutes);
    assert_true(says(r, minutes < 60 ? words : "N46"));
    assert_true(says(r, "E011" LM_GLYPH_DEGREE "00.00"));
    assert_true(says(r, "000" LM_GLYPH_DEGREE "/05.0"));
    /* hills(): 100 m + 50 sin(0) = 100 m = 328 ft at the meridian of the image's centre. */
    const double feet = r->unit.cursor_elevation_m_q10 / 1024.0 * 3.28084;
    assert_true(feet > 150 && feet < 500);
    snprintf(words, sizeof words, "ELV +%.0fFT", feet);
    assert_true(says(r, words));
    free_rig(r);
}

TEST(the_cursor_stays_over_its_place_through_turns_of_the_page)
{
    struct rig *r = fly_rig();
    command(r, lm_control_slew(300, 0));
    run(r, 0.2);
    command(r, lm_control_slew(0, 0));
    run(r, 0.8);
    const struct lm_position held = r->unit.cursor.position;
    const int keys[] = {20, 18, 7, 7, 5, 5, 12, 13, 19, 4, 4};
    for (size_t i = 0; i < sizeof keys / sizeof *keys; i++) {
        press(r, keys[i]);
        run(r, 0.5);
        assert_memory_equal(&r->unit.cursor.position, &held, sizeof held);
    }
    free_rig(r);
}

TEST(designate_looks_closely_at_the_cursor_and_drop_comes_back)
{
    struct rig *r = fly_rig();
    slew_right(r);
    command(r, lm_control_designate());
    run(r, 4);
    assert_int_equal(r->unit.page.picture, LM_PICTURE_PATCH);
    assert_memory_equal(&r->unit.picture.sar.command.centre, &r->unit.cursor.position,
                        sizeof(struct lm_position));
    assert_int_equal(r->unit.picture.sar.line, r->unit.picture.sar.lines);
    char look[16];
    snprintf(look, sizeof look, "LOOK %03.0f",
             r->unit.picture.sar.command.look_azimuth * 360.0 / 4294967296.0);
    assert_true(says(r, "100%") && says(r, "CELL 5.0M") && says(r, look));
    assert_in_range(r->unit.cursor.offset.x_px_q8 + 256, 0, 512); /* in the middle of the patch */
    command(r, lm_control_drop());
    run(r, 0.1);
    assert_int_not_equal(r->unit.page.picture, LM_PICTURE_PATCH);
    free_rig(r);
}

TEST(a_patch_that_cannot_be_made_is_refused_on_the_glass_for_two_seconds)
{
    struct rig *r = fly_rig();
    /* Too near: under the aircraft. */
    command(r, lm_control_slew(0, -1000));
    run(r, 2);
    command(r, lm_control_slew(0, 0));
    command(r, lm_control_designate());
    run(r, 0.1);
    assert_int_not_equal(r->unit.page.picture, LM_PICTURE_PATCH);
    assert_int_equal(r->unit.count.commands_refused, 1);
    assert_true(warns(r, "UNABLE"));
    run(r, 2);
    assert_false(warns(r, "UNABLE"));
    free_rig(r);
}

TEST(a_patch_dead_ahead_is_refused_and_its_time_to_go_is_on_the_glass_elsewhere)
{
    struct rig *r = fly_rig();
    command(r, lm_control_designate());
    run(r, 0.1);
    assert_int_not_equal(r->unit.page.picture, LM_PICTURE_PATCH);
    assert_true(warns(r, "UNABLE"));
    /* 10 km away at 150 m/s, 30 degrees off, with cells of 1 m: about 2 s. */
    slew_right(r);
    command(r, lm_control_designate());
    run(r, 0.1);
    for (int i = 0; i < 3; i++) {
        press(r, 16);
    }
    assert_true(says(r, "1M"));
    run(r, 0.3);
    command(r, (struct lm_control){.kind = LM_CONTROL_FREEZE, .is_frozen = true});
    run(r, 0.1);
    assert_int_equal(r->unit.page.picture, LM_PICTURE_PATCH);
    char words[24];
    snprintf(words, sizeof words, "%u%% %.0fS", r->unit.picture.sar.line * 100 / 256,
             ceil((double)lm_sar_time_to_go_us(&r->unit.picture.sar) / 1e6));
    assert_true(says(r, words));
    free_rig(r);
}

TEST(the_bit_page_says_what_the_counters_say)
{
    struct rig *r = fly_rig();
    r->bus.is_down = 1;
    run(r, 2.5);
    r->bus.is_down = 0;
    r->bus.sent_us = r->now_us;
    command(r, (struct lm_control){.kind = LM_CONTROL_RANGE, .range_nm = 9});
    /* A frame of a wrong type and a lone half of a double, which the next other frame tears. */
    const struct lm_can_frame bad = {.id = 321, .length = 8, .data = {9, 77}};
    const struct lm_can_frame half = {.id = 1036, .length = 8, .data = {9, LM_CANAS_DOUBLEH}};
    struct lm_bus_event events[LM_BUS_EVENTS];
    lm_bus_take(&r->unit.bus, &bad, events);
    lm_bus_take(&r->unit.bus, &half, events);
    r->unit.map.tiles.count.corrupt = 5;
    r->unit.map.chips.count.corrupt = 7;
    r->unit.nav.disagreements = r->unit.senders.disagreements =
        89; /* known, so that no flag rises */
    r->unit.map.count.targets_lost = 21;
    r->unit.map.count.signatures_lost = 34;
    r->unit.picture.sar.detail.left_out = 55;
    run(r, 1);
    press(r, 12);
    /* Stop the clock: the numbers of the picture on the glass. */
    const struct lm_unit *u = &r->unit;
    const struct {
        const char *name;
        uint32_t value;
    } counters[] = {{"FRAMES   %u", u->count.frames - 1}, /* this picture is counted behind it */
                    {"BUSY     %u", u->count.display_busy},
                    {"LATE     %u", u->count.lines_dropped},
                    {"BUS ERR  %u", u->count.bus_errors},
                    {"JUMPS    %u", u->nav.position_jumps},
                    {"REFUSED  %u", u->count.commands_refused},
                    {"TILES    %u", u->map.tiles.count.tiles_read},
                    {"EVICTED  %u", u->map.tiles.count.evicted},
                    {"COARSER  %u", u->map.tiles.count.substituted},
                    {"READ ERR %u", u->map.tiles.count.io_errors},
                    {"CRC ERR  %u", 5 + 7},
                    {"DROPPED  %u", u->map.tiles.count.requests_dropped},
                    {"DISP ERR %u", u->count.display_errors},
                    {"BUS BAD  %u", 1},
                    {"SENDERS  %u", 89 + u->nav.rivals},
                    {"TGT LOST %u", 21},
                    {"SIG LOST %u", 34},
                    {"STUCK    %u", u->keys.count.stuck},
                    {"SWAPS    %u", u->count.swaps},
                    {"DTL LOST %u", 55},
                    {"LEVELS   %u", u->map.db.lod_count},
                    {"RECORDS  %u", u->map.db.record_count}};
    assert_true(u->count.bus_errors > 1000 && u->count.commands_refused == 1);
    for (size_t i = 0; i < sizeof counters / sizeof *counters; i++) {
        char words[48];
        snprintf(words, sizeof words, counters[i].name, counters[i].value);
        if (!says(r, words)) {
            fail_msg("the glass does not say %s", words);
        }
    }
    /* LINES, BUS, HITS and MISSES move between two pictures: their rows as text. */
    char line[48];
    snprintf(line, sizeof line, "LINES    %u", u->count.lines);
    assert_non_null(strstr(lm_bit_row(u, 4).words, line));
    snprintf(line, sizeof line, "BUS      %u", u->count.bus_frames);
    assert_non_null(strstr(lm_bit_row(u, 5).words, line));
    snprintf(line, sizeof line, "HITS     %u", lm_tile_cache_hits(&u->map.tiles));
    assert_non_null(strstr(lm_bit_row(u, 9).words, line));
    snprintf(line, sizeof line, "MISSES   %u", u->map.tiles.count.misses);
    assert_non_null(strstr(lm_bit_row(u, 9).words, line));
    assert_true(says(r, "LANDMASS"));
    /* The bus fell silent at 1.5 s; heading is stale at once and dead a second later. */
    assert_true(says(r, "00:00:01  NAV"));
    assert_true(says(r, "00:00:02  BUS"));
    assert_true(says(r, "00:00:02  NAV FAIL"));
    free_rig(r);
}

TEST(the_bit_page_says_why_the_board_restarted)
{
    struct rig *r = start_rig();
    (void)state;
    assert_string_equal(lm_bit_row(&r->unit, LM_BIT_ROWS - 1).words, "");
    r->board.lent.restart = "HUNG STEP";
    press(r, 12);
    assert_true(says(r, "RESTART  HUNG STEP"));
    free_rig(r);
}

TEST(a_broken_database_leaves_a_bit_page_that_says_so)
{
    struct rig *r = make_rig();
    r->image.bytes[100] ^= 1;
    assert_int_equal(lm_unit_init(&r->unit, &r->board.lent), LM_OK);
    run(r, 0.5);
    press(r, 12);
    assert_true(says(r, "DB FAIL"));
    assert_true(says(r, "RECORDS  0"));
    free_rig(r);
}

TEST(buttons_and_deflections_that_do_not_exist_are_refused)
{
    struct rig *r = fly_rig();
    const struct lm_control bad[] = {
        {.kind = LM_CONTROL_DOWN, .button = 0},
        {.kind = LM_CONTROL_DOWN, .button = LM_BUTTONS + 1},
        {.kind = LM_CONTROL_UP, .button = INT32_MIN},
        {.kind = LM_CONTROL_SLEW, .slew = {.x = 1001}},
        {.kind = LM_CONTROL_SLEW, .slew = {.y = INT32_MIN}},
        {.kind = LM_CONTROL_KNOB, .knob = -1001},
    };
    const struct lm_page before = r->unit.page;
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        command(r, bad[i]);
    }
    run(r, 0.1);
    assert_int_equal(r->unit.count.commands_refused, 6);
    assert_memory_equal(&r->unit.page, &before, sizeof before);
    free_rig(r);
}

/* ---- home ---- */

static double cursor_nm(const struct rig *r)
{
    return r->unit.cursor.range_m / 1852.0;
}

TEST(a_cursor_that_nobody_moved_goes_with_the_scale)
{
    struct rig *r = start_rig();
    run(r, 0.5);
    assert_true(fabs(cursor_nm(r) - 20) < 0.3); /* 40 nm at switch-on */
    command(r, range_10);
    run(r, 0.3);
    assert_true(fabs(cursor_nm(r) - 5) < 0.1);
    assert_true(r->unit.cursor.is_on_glass);
    press(r, 20); /* up */
    run(r, 0.3);
    assert_int_equal(r->unit.page.range_index, scale_of(20));
    assert_true(fabs(cursor_nm(r) - 10) < 0.1);
    /* A window opens about the new place. */
    command(r, (struct lm_control){.kind = LM_CONTROL_SECTOR, .sector = {.fov = LM_FOV_EXP}});
    command(r, range_10);
    run(r, 0.3);
    assert_true(fabs(cursor_nm(r) - 5) < 0.1);
    assert_memory_equal(&r->unit.picture.sector.command.centre, &r->unit.cursor.position,
                        sizeof r->unit.cursor.position);
    free_rig(r);
}

TEST(a_cursor_that_was_moved_or_designated_stays_when_the_scale_changes)
{
    for (int is_designated = 0; is_designated < 2; is_designated++) {
        struct rig *r = fly_rig();
        if (is_designated) {
            /* At 40 nm the cursor is 36 degrees off the nose, where a patch can be made. */
            r->bus.nose_deg = 50;
            run(r, 0.3);
            press(r, 9);
            command(r, lm_control_designate());
            run(r, 0.1);
            assert_int_equal(r->unit.page.picture, LM_PICTURE_PATCH);
            command(r, lm_control_drop());
        } else {
            command(r, lm_control_slew(500, 0));
            run(r, 0.2);
            command(r, lm_control_slew(0, 0));
        }
        run(r, 0.1);
        const struct lm_position before = r->unit.cursor.position;
        press(r, 20);
        run(r, 0.3);
        assert_int_equal(r->unit.page.range_index, scale_of(20));
        assert_memory_equal(&r->unit.cursor.position, &before, sizeof before);
        free_rig(r);
    }
}

TEST(a_cursor_that_the_range_follows_is_left_where_it_is)
{
    struct rig *r = fly_rig();
    press(r, 20);
    run(r, 0.3);
    press(r, 2); /* AUTO at 20 nm, the cursor 10 nm away: 8.5 nm are 18 s on */
    const struct lm_position before = r->unit.cursor.position;
    assert_true(r->unit.cursor.is_home);
    run(r, 20);
    assert_int_equal(r->unit.page.range_index, scale_of(10));
    assert_memory_equal(&r->unit.cursor.position, &before, sizeof before);
    free_rig(r);
}

TEST(a_selection_out_of_range_is_refused_and_changes_nothing)
{
    struct lm_page page;
    lm_page_init(&page, &lm_radar_default);
    const struct lm_page before = page;
    assert_int_equal(lm_page_select_range(&page, -1), 0);
    assert_int_equal(lm_page_select_range(&page, 39), 0);
    assert_int_equal(lm_page_select_range(&page, 160), 0);
    assert_int_equal(lm_page_select_azimuth(&page, LM_AZIMUTHS), 0);
    assert_int_equal(lm_page_select_sector(&page, LM_SECTOR_CHOICES, LM_FOV_NORM), 0);
    assert_int_equal(lm_page_select_sector(&page, LM_SECTOR_BEACON, LM_FOV_DBS1), 0);
    assert_int_equal(lm_page_select_sector(&page, LM_SECTOR_GMT, LM_FOV_DBS2), 0);
    assert_int_equal(lm_page_set_gain(&page, LM_GAIN_MAX_DB + 1), 0);
    assert_int_equal(lm_page_set_knob(&page, -LM_FULL_DEFLECTION - 1), 0);
    assert_memory_equal(&page, &before, sizeof before);

    /* The scale at hand begins the sector again; only another one is told as such. */
    assert_int_equal(lm_page_select_range(&page, 40), LM_EFFECT_SECTOR);
    assert_int_equal(lm_page_select_range(&page, 80), LM_EFFECT_SECTOR | LM_EFFECT_RANGE);
    /* Neither sharpening nor moving targets have a scale so large. */
    const struct lm_page far = page;
    assert_int_equal(lm_page_select_sector(&page, LM_SECTOR_GM, LM_FOV_DBS1), 0);
    assert_int_equal(lm_page_select_sector(&page, LM_SECTOR_GMT, LM_FOV_NORM), 0);
    assert_memory_equal(&page, &far, sizeof far);
    assert_int_equal(lm_page_select_range(&page, 40), LM_EFFECT_SECTOR | LM_EFFECT_RANGE);
    assert_int_equal(lm_page_select_sector(&page, LM_SECTOR_GM, LM_FOV_DBS1),
                     LM_EFFECT_SECTOR | LM_EFFECT_TONE);
}
