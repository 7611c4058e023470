/* Where things stand on the glass: every text and symbol of every page, at every size. The linker
 * leads the firmware's calls of lm_draw_text here (tests/unit/unit.mk). */
#include "check.h"
#include "glass_walk.h"

#include <stdio.h>

/* Pairs of a mode and a field of view. */
enum { FOVS = LM_FOVS, PAIRS = (int)LM_SECTOR_CHOICES * (int)LM_FOVS };

/* Pixels that are not black outside the frame, but for texts and the hand that shows life. */
static void nothing_is_beside_the_frame(const struct walk *w, const char *situation)
{
    const struct lm_frame *f = &w->rig->unit.picture.frame;
    const int32_t side = w->side_px, hand = 14 * walk_dot_px(w);
    for (int32_t y = 0; y < side; y++) {
        for (int32_t x = 0; x < side; x++) {
            const bool is_inside = x >= f->left_px && x < f->left_px + f->width_px &&
                                   y >= f->top_px && y < f->top_px + f->height_px;
            const bool is_hand = x >= side - hand && y >= side - hand;
            if (!is_inside && !is_hand && w->glass[y * side + x] != 0 && !walk_has_text(w, x, y)) {
                fail_msg("%s, glass of %d: a pixel at %d, %d is lit", situation, (int)side, (int)x,
                         (int)y);
            }
        }
    }
}

static void check_sectors(struct walk *w)
{
    const struct lm_radar *radar = &lm_radar_default;
    for (int32_t n = 0; n < PAIRS * radar->ranges * LM_AZIMUTHS; n++) {
        const int32_t mode = n / FOVS % LM_SECTOR_CHOICES, fov = n % FOVS;
        const int32_t range = n / PAIRS % radar->ranges;
        const int32_t azimuth = n / (PAIRS * radar->ranges);
        const int32_t range_nm = radar->range[range].range_nm;
        const struct lm_control narrow = {.kind = LM_CONTROL_AZIMUTH, .azimuth_index = azimuth};
        const struct lm_control scale = {.kind = LM_CONTROL_RANGE, .range_nm = range_nm};
        if (fov > (int32_t)lm_radar_fov_last(radar, (uint32_t)mode) ||
            range > (int32_t)lm_radar_range_last(radar, (uint32_t)mode, (uint32_t)fov)) {
            continue;
        }
        /* The smallest scale is one that every mode and field of view has. */
        command(w->rig, range_10);
        command(w->rig, (struct lm_control){.kind = LM_CONTROL_SECTOR, .sector = {mode, fov}});
        command(w->rig, scale);
        command(w->rig, narrow);
        /* Into a corner of the frame, and with every other the beam to another place. */
        command(w->rig, lm_control_slew(n % 2 ? 1000 : -1000, n % 4 < 2 ? -1000 : 1000));
        run(w->rig, 0.11 + 0.05 * (n % 3));
        char situation[64];
        snprintf(situation, sizeof situation, "%s %s %d nm A%d",
                 lm_radar_mode_name(radar, (uint32_t)mode), radar->fov[fov].name, (int)range_nm,
                 (int)azimuth);
        nothing_is_beside_the_frame(w, situation);
    }
}

TEST(no_symbol_of_any_mode_scale_or_width_is_outside_the_frame)
{
    static const uint16_t sides[] = {480, 768, 1024};
    for (size_t i = 0; i < 2 * sizeof sides / sizeof *sides; i++) {
        const struct lm_glass_options all = {i % 2, true, true, true};
        struct walk *w = walk_begin(sides[i / 2], &all);
        w->rig->bus.has_steerpoint = true;
        w->rig->bus.steerpoint_deg[0] = 46, w->rig->bus.steerpoint_deg[1] = 11.0002;
        check_sectors(w);
        command(w->rig, patch_here);
        run(w->rig, 1);
        nothing_is_beside_the_frame(w, "patch");
        command(w->rig, (struct lm_control){.kind = LM_CONTROL_DROP});
        command(w->rig, (struct lm_control){.kind = LM_CONTROL_FREEZE, .is_frozen = true});
        run(w->rig, 1);
        nothing_is_beside_the_frame(w, "frozen");
        walk_end(w);
    }
}

/* Whether the ground around one text, a dot wide, is over a pixel of the other. */
static bool meet(const struct walk_text *a, const struct walk_text *b, int32_t dot)
{
    return a->left - dot < b->right && b->left < a->right + dot && a->top - dot < b->bottom &&
           b->top < a->bottom + dot;
}

static void no_texts_meet(const struct walk *w, const char *situation)
{
    const int32_t dot = walk_dot_px(w);
    for (uint32_t i = 0; i < w->texts; i++) {
        const struct walk_text *a = &w->text[i];
        if (a->left < 0 || a->top < 0 || a->right > w->side_px || a->bottom > w->side_px) {
            fail_msg("%s, glass of %d: \"%s\" is not all on the glass", situation, (int)w->side_px,
                     a->words);
        }
        for (uint32_t k = 0; k < w->texts; k++) {
            if (k != i && meet(a, &w->text[k], dot)) {
                fail_msg("%s, glass of %d: \"%s\" at %d, %d meets \"%s\" at %d, %d", situation,
                         (int)w->side_px, a->words, (int)a->left, (int)a->top, w->text[k].words,
                         (int)w->text[k].left, (int)w->text[k].top);
            }
        }
    }
}

/* The gain's bracket, whole, left of which no label of the left keys reaches. */
static void the_gain_is_clear_of_labels(const struct walk *w, const char *situation)
{
    const struct rig *r = w->rig;
    const struct lm_frame *f = &r->unit.picture.frame;
    const int32_t dot = walk_dot_px(w), high = w->side_px * 250 / 2000;
    int32_t left = 33 * dot > f->left_px ? 33 * dot : f->left_px;
    if (r->unit.page.format == LM_FORMAT_BIT || r->unit.page.format == LM_FORMAT_TEST) {
        return;
    }
    left += 4 * dot;
    for (int32_t y = f->top_px; y <= f->top_px + high; y++) {
        if (w->glass[y * w->side_px + left] != r->unit.palette.symbol) {
            fail_msg("%s, glass of %d: the gain's bracket is cut at row %d", situation,
                     (int)w->side_px, (int)y);
        }
    }
}

/* Look at the page after two frames. */
static void look(struct walk *w, const char *page, const char *setting)
{
    char situation[64];
    snprintf(situation, sizeof situation, "%s, %s", page, setting);
    run(w->rig, 0.07);
    no_texts_meet(w, situation);
    the_gain_is_clear_of_labels(w, situation);
}

static void press_often(struct walk *w, int button, int times)
{
    for (int i = 0; i < times; i++) {
        command(w->rig, lm_control_button(true, button));
        command(w->rig, lm_control_button(false, button));
        run(w->rig, 0.01);
    }
}

/* Every page with the settings that it has now. */
static void look_at_pages(struct walk *w, const char *setting)
{
    enum { CNTL = 5, DCLT = 11, BIT = 12, FCR = 13, TEST = 14 };
    look(w, "radar", setting);
    press_often(w, DCLT, 1);
    look(w, "decluttered", setting);
    press_often(w, DCLT, 1);
    press_often(w, CNTL, 1);
    look(w, "CNTL", setting);
    press_often(w, DCLT, 1);
    look(w, "DCLT", setting);
    press_often(w, BIT, 1);
    press_often(w, CNTL, 2);
    press_often(w, BIT, 1);
    look(w, "BIT", setting);
    press_often(w, TEST, 1);
    look(w, "TEST", setting);
    press_often(w, FCR, 1);
}

/* The settings of the control page at one end, those of the radar page switched. */
static void turn_all(struct walk *w, bool is_up)
{
    static const int ups[] = {2, 6, 18, 20}, downs[] = {3, 7, 17, 19};
    press_often(w, 5, 1);
    for (int i = 0; i < 4; i++) {
        press_often(w, is_up ? ups[i] : downs[i], i == 0 ? 70 : 25);
    }
    press_often(w, 4, 1);
    press_often(w, 8, 1);
    press_often(w, 9, 1);
    press_often(w, 16, 1);
    press_often(w, 5, 1);
    for (int osb = 6; osb <= 8; osb++) {
        press_often(w, osb, 1);
    }
    press_often(w, 2, 1);
}

/* Every mode, field of view and scale, and a patch. */
static void look_at_pictures(struct walk *w)
{
    const struct lm_radar *radar = &lm_radar_default;
    for (int32_t n = 0; n < PAIRS; n++) {
        const int32_t mode = n / LM_FOVS, fov = n % LM_FOVS;
        if (fov > (int32_t)lm_radar_fov_last(radar, (uint32_t)mode)) {
            continue;
        }
        for (uint32_t i = 0; i <= lm_radar_range_last(radar, (uint32_t)mode, (uint32_t)fov); i++) {
            char setting[32];
            const int32_t range_nm = radar->range[i].range_nm;
            snprintf(setting, sizeof setting, "%s %s %d nm",
                     lm_radar_mode_name(radar, (uint32_t)mode), radar->fov[fov].name,
                     (int)range_nm);
            command(w->rig, range_10);
            command(w->rig, (struct lm_control){.kind = LM_CONTROL_SECTOR, .sector = {mode, fov}});
            command(w->rig, (struct lm_control){.kind = LM_CONTROL_RANGE, .range_nm = range_nm});
            look_at_pages(w, setting);
        }
    }
    command(w->rig, patch_here);
    run(w->rig, 1);
    for (int cell = 0; cell < 6; cell++) {
        look_at_pages(w, "patch");
        press_often(w, 16, 1);
    }
    w->rig->unit.flags = 0;
}

TEST(no_text_meets_another_on_any_page_at_any_size_and_setting)
{
    static const uint16_t sides[] = {256, 300, 420, 480, 660, 768, 900, 1024};
    for (size_t i = 0; i < sizeof sides / sizeof *sides; i++) {
        const struct lm_glass_options all = {false, true, true, true};
        struct walk *w = walk_begin(sides[i], &all);
        w->rig->bus.has_steerpoint = true;
        w->rig->bus.steerpoint_deg[0] = 46.4, w->rig->bus.steerpoint_deg[1] = 11;
        look_at_pictures(w);
        command(w->rig, (struct lm_control){.kind = LM_CONTROL_DROP});
        turn_all(w, true);
        look_at_pictures(w);
        turn_all(w, false);
        look_at_pictures(w);
        walk_end(w);
    }
}

/* Pixels of the glass within the frame that are of a colour. */
static int coloured(const struct walk *w, uint32_t colour)
{
    int count = 0;
    for (int32_t i = 0; i < w->side_px * w->side_px; i++) {
        count += w->glass[i] == colour;
    }
    return count;
}

TEST(heading_strobe_and_borders_are_on_the_glass_when_the_board_asks_for_them)
{
    const struct lm_glass_options none = {0}, one[] = {{.has_heading = true},
                                                       {.has_strobe = true},
                                                       {.has_borders = true}};
    for (int i = 0; i < 3; i++) {
        struct walk *plain = walk_begin(480, &none), *w = walk_begin(480, &one[i]);
        const uint32_t symbol = w->rig->unit.palette.symbol, faint = w->rig->unit.palette.faint;
        for (int k = 0; k < 2; k++) {
            struct rig *r = k ? w->rig : plain->rig;
            r->bus.nose_deg = 77;
            command(r, (struct lm_control){.kind = LM_CONTROL_AZIMUTH, .azimuth_index = 1});
            run(r, 1.5);
        }
        assert_int_equal(walk_says(w, "077"), i == 0);
        assert_false(walk_says(plain, "077"));
        assert_int_equal(coloured(plain, faint), 0);
        assert_int_equal(coloured(w, faint) > 100, i == 1);
        /* Two lines of the frame's height, less what lies under other symbols. */
        const int more = coloured(w, symbol) - coloured(plain, symbol);
        assert_int_equal(more > 2 * 250, i == 2);
        walk_end(plain);
        walk_end(w);
    }
}
