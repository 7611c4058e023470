#include "fx/trig.h"
#include "lm/bit.h"
#include "parts.h"

/* Twice the radius of the Earth, 4/3 as large as it is: what refraction makes of it. */
enum { TWO_RADII_M = 16989333 };

/* The antenna's elevation: along the line of sight to the cursor, or to half the range when the
 * cursor is not on the glass. The beam is as tall as the picture, so that it changes nothing yet.
 */
static int32_t antenna_elevation(const struct lm_unit *u)
{
    if (!u->has_db) {
        return 0;
    }
    const uint32_t half_m = u->board->radar->range_m[u->page.range] / 2;
    const uint32_t range_m = u->cursor.is_on_glass ? u->cursor.range_m : half_m;
    const int32_t drop_m = (int32_t)((uint64_t)range_m * range_m / TWO_RADII_M);
    const int32_t above_m = (lm_antenna_height_q6(u) - u->db.mean_elevation_q6) / 64;
    return (int32_t)fx_atan2(-(above_m + drop_m), (int32_t)range_m);
}

static void describe_cursor(const struct lm_unit *u, struct lm_symbols *s)
{
    const struct lm_cursor *c = &u->cursor;
    s->has_cursor = c->is_placed && lm_has_ownship(u);
    s->is_cursor_on_glass = s->has_cursor && c->is_on_glass;
    s->cursor = c->offset;
    s->cursor_place = c->place;
    s->cursor_range_m = c->range_m;
    s->cursor_bearing = c->bearing;
    s->has_cursor_elevation = u->has_db && u->cursor_elevation_q10 != LM_NO_ELEVATION;
    s->cursor_elevation_m = u->cursor_elevation_q10 / 1024;
}

static struct lm_symbols describe(const struct lm_unit *u)
{
    const struct lm_ground_map *g = &u->ground_map;
    struct lm_symbols s = {
        .view = u->view,
        .is_patch = u->page.mode == LM_MODE_SAR,
        .is_sweeping = !(u->flags & LM_FLAGS_NO_LINES),
        .range_nm = g->radar->range_nm[g->range],
        .azimuth_half = g->radar->azimuth_half[g->azimuth],
        .antenna_azimuth = lm_ground_map_edge_bam(g, g->line),
        .antenna_elevation = antenna_elevation(u),
        .gain_db = u->page.gain_db,
        .heading = u->ownship.heading,
        .has_heading = u->ownship.heading_quality != LM_NAV_DEAD,
    };
    describe_cursor(u, &s);
    if (u->is_view_held && lm_has_ownship(u)) {
        s.is_ownship_shown = lm_view_find(&u->view, lm_ownship_place(u), &s.ownship);
        s.ownship_heading = u->ownship.heading - u->view.up;
    }
    if (s.is_patch) {
        s.patch_cell_mm = u->sar.command.cell_mm;
        s.patch_percent = (uint16_t)(u->sar.line * 100 / u->sar.radar->sar.cells);
        s.patch_to_go_s = (uint32_t)((lm_sar_time_to_go_us(&u->sar) + 999999) / 1000000);
        s.patch_look = u->sar.command.look_azimuth;
    }
    return s;
}

static void show_radar(const struct lm_unit *u, const struct lm_glass *glass)
{
    const struct lm_symbols symbols = describe(u);
    lm_overlay_picture(glass, &u->plane);
    lm_overlay_symbols(glass, &symbols);
    lm_overlay_warnings(glass, u->flags);
}

static void show_bit(const struct lm_unit *u, const struct lm_glass *glass)
{
    lm_overlay_blank(glass);
    for (uint32_t row = 0; row < LM_BIT_ROWS; row++) {
        const struct lm_text text = lm_bit_row(u, row);
        lm_overlay_row(glass, row, text.words);
    }
}

static void draw_glass(const struct lm_unit *u, const struct lm_surface *surface)
{
    const struct lm_glass glass = {*surface, &u->frame, &u->palette};
    switch ((enum lm_format)u->page.format) {
    case LM_FORMAT_RADAR:
    case LM_FORMAT_CNTL:
    case LM_FORMAT_DCLT:
        show_radar(u, &glass);
        break;
    case LM_FORMAT_BIT:
        show_bit(u, &glass);
        break;
    case LM_FORMAT_TEST:
        lm_overlay_test_pattern(&glass);
        break;
    }
    lm_overlay_labels(&glass, &u->page);
    lm_overlay_alive(&glass, u->count.frames);
}

void lm_show_frame(struct lm_unit *u, uint64_t now_us)
{
    const struct lm_display *display = u->board->display;
    struct lm_surface surface;
    const int status = display->acquire(display->ctx, &surface);
    if (status != LM_OK) {
        u->count.display_busy += status == LM_BUSY;
        u->count.display_errors += status < 0;
        return;
    }
    if (u->flags & (LM_FLAG_NAV_DEAD | LM_FLAG_DB)) {
        lm_plane_clear(&u->plane, &u->frame);
        lm_sar_restart(
            &u->sar); /* a patch that was removed is drawn anew, not shown as an empty one */
    }
    draw_glass(u, &surface);
    u->count.display_errors += display->present(display->ctx) != LM_OK;
    u->count.frames++;
    /* Frames that were missed are not made up for. */
    u->next_frame_us += LM_FRAME_US;
    if (u->next_frame_us <= now_us) {
        u->next_frame_us = now_us + LM_FRAME_US;
    }
}
