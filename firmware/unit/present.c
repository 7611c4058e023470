#include "lm/bit.h"
#include "unit_internal.h"

static void describe_cursor(const struct lm_unit *u, struct lm_symbols *s)
{
    const struct lm_cursor *c = &u->cursor;
    s->has_cursor = c->is_placed && lm_has_ownship(u);
    s->is_cursor_on_glass = s->has_cursor && c->is_on_glass;
    s->cursor = c->offset;
    s->cursor_place = c->place;
    s->cursor_range_m = c->range_m;
    s->cursor_bearing = c->bearing;
    s->has_cursor_elevation = u->map.is_usable && u->cursor_elevation_q10 != LM_NO_ELEVATION;
    s->cursor_elevation_q10 = u->cursor_elevation_q10;
}

/* Where it is to go: as commanded, or else the bus's steerpoint, while that is not stale. */
static bool find_steerpoint(const struct lm_unit *u, struct lm_place *place)
{
    *place = u->has_own_steerpoint ? u->own_steerpoint : u->ownship.steerpoint;
    return lm_has_ownship(u) &&
           (u->has_own_steerpoint || u->ownship.steerpoint_quality == LM_NAV_GOOD);
}

static uint32_t to_go_s(const struct lm_unit *u, struct lm_place place)
{
    uint32_t distance_q8;
    fx_bam_t bearing;
    lm_geo_inverse(lm_ownship_place(u), place, &distance_q8, &bearing);
    const uint64_t distance_mm = (uint64_t)distance_q8 * 1000 / 256;
    const uint32_t speed_mm_s = (uint32_t)u->ownship.ground_speed_mm_s;
    if (u->ownship.velocity_quality == LM_NAV_DEAD || speed_mm_s == 0) {
        return LM_TO_GO_NONE;
    }
    const uint64_t seconds = (distance_mm + speed_mm_s / 2) / speed_mm_s;
    return seconds < LM_TO_GO_NONE ? (uint32_t)seconds : LM_TO_GO_NONE;
}

static void describe_steerpoint(const struct lm_unit *u, struct lm_symbols *s)
{
    struct lm_place place;
    struct lm_offset at;
    s->has_steerpoint = find_steerpoint(u, &place);
    if (!s->has_steerpoint) {
        return;
    }
    s->to_go_s = to_go_s(u, place);
    if (lm_view_find(&u->view, place, &at)) {
        const struct lm_frame *f = &u->frame;
        const struct lm_point p = lm_view_point(&u->view, at);
        s->steerpoint = p;
        s->is_steerpoint_on_glass = p.x >= f->left_px && p.x < f->left_px + f->width_px &&
                                    p.y >= f->top_px && p.y < f->top_px + f->height_px;
    }
}

/* Where the cursor would be if the whole sector were shown. */
static void describe_window(const struct lm_unit *u, struct lm_symbols *s)
{
    const struct lm_view_from from = {lm_ownship_place(u), u->view.up, u->view.height_q10};
    const struct lm_view whole =
        lm_view_of_sector(&u->frame, &from, u->board->radar->range[u->page.range].range_m);
    struct lm_offset at;
    s->is_cue_shown = u->cursor.is_placed && lm_view_find(&whole, u->cursor.place, &at);
    if (s->is_cue_shown) {
        s->cue = lm_view_point(&whole, at);
    }
    s->is_finer_offered = u->page.field == LM_FIELD_DBS1;
}

static struct lm_symbols describe(const struct lm_unit *u)
{
    const struct lm_sector *sector = &u->sector;
    const struct lm_radar *radar = sector->radar;
    struct lm_symbols s = {
        .view = u->view,
        .is_sweeping = !(u->flags & LM_FLAGS_NO_LINES),
        .range_nm = radar->range[u->page.range].range_nm,
        .azimuth_half = radar->azimuth_half[u->page.azimuth],
        .antenna_azimuth = lm_sector_edge_bam(sector, sector->line),
        .antenna_elevation = sector->tilt,
        .gain_db = u->page.gain_db,
        .heading = u->ownship.heading,
        .has_heading = u->ownship.heading_quality != LM_NAV_DEAD,
    };
    if (u->view.shape == LM_VIEW_WINDOW) {
        describe_window(u, &s);
    }
    describe_cursor(u, &s);
    describe_steerpoint(u, &s);
    if (u->is_view_held && lm_has_ownship(u)) {
        /* It flies over the map and does not stand on the ground that slant ranges are for. */
        struct lm_view level = u->view;
        level.height_q10 = 0;
        s.is_ownship_shown = lm_view_find(&level, lm_ownship_place(u), &s.ownship);
        s.ownship_heading = u->ownship.heading - u->view.up;
    }
    if (u->view.shape == LM_VIEW_PATCH) {
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
