/* Where things stand on the glass: every text and symbol of every page, at every size. The linker
 * leads the firmware's calls of lm_draw_text here (tests/unit/unit.mk). */
#include "check.h"
#include "glass_walk.h"

#include <stdio.h>

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
    for (int32_t n = 0; n < LM_SECTOR_MODES * LM_FOVS * radar->ranges * LM_AZIMUTHS; n++) {
        const int32_t mode = n % LM_SECTOR_MODES, fov = n / LM_SECTOR_MODES % LM_FOVS;
        const int32_t range = n / (LM_SECTOR_MODES * LM_FOVS) % radar->ranges;
        const int32_t azimuth = n / (LM_SECTOR_MODES * LM_FOVS * radar->ranges);
        const int32_t range_nm = radar->range[range].range_nm;
        const struct lm_control narrow = {.kind = LM_CONTROL_AZIMUTH, .azimuth_index = azimuth};
        const struct lm_control scale = {.kind = LM_CONTROL_RANGE, .range_nm = range_nm};
        if (fov > radar->mode[mode].fov_last ||
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
        snprintf(situation, sizeof situation, "%s %s %d nm A%d", radar->mode[mode].name,
                 radar->fov[fov].name, (int)range_nm, (int)azimuth);
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
