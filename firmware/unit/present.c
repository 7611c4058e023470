#include "present.h"

#include "flags.h"
#include "lm/bit.h"
#include "lm/units.h"
#include "ownship.h"
#include "tracking.h"

static void describe_cursor(const struct lm_unit *u, struct lm_symbols *s)
{
    const struct lm_cursor *c = &u->cursor;
    s->has_cursor = c->is_placed && lm_ownship_is_known(&u->ownship);
    s->is_cursor_on_glass = s->has_cursor && c->is_on_glass;
    s->cursor = c->offset;
    s->cursor_position = c->position;
    s->cursor_range_m = c->range_m;
    s->cursor_bearing = c->bearing;
    s->has_cursor_elevation = u->map.is_usable && u->cursor_elevation_m_q10 != LM_NO_ELEVATION;
    s->cursor_elevation_m_q10 = u->cursor_elevation_m_q10;
}

/* Find the steerpoint: the commanded one, or else the bus's while it is good. */
static bool find_steerpoint(const struct lm_unit *u, struct lm_position *position)
{
    *position = u->steerpoint.is_commanded ? u->steerpoint.position : u->ownship.steerpoint;
    return lm_ownship_is_known(&u->ownship) &&
           (u->steerpoint.is_commanded || u->ownship.steerpoint_quality == LM_NAV_GOOD);
}

static uint32_t to_go_s(const struct lm_unit *u, struct lm_position position)
{
    uint32_t distance_m_q8;
    fx_bam_t bearing;
    lm_geo_inverse(lm_ownship_position(&u->ownship), position, &distance_m_q8, &bearing);
    const uint64_t distance_mm = lm_mm_of_m_q8(distance_m_q8);
    const uint32_t speed_mm_s = (uint32_t)u->ownship.ground_speed_mm_s;
    if (speed_mm_s == 0) {
        return LM_TO_GO_NONE;
    }
    const uint64_t seconds = (distance_mm + speed_mm_s / 2) / speed_mm_s;
    return seconds < LM_TO_GO_NONE ? (uint32_t)seconds : LM_TO_GO_NONE;
}

static void describe_steerpoint(const struct lm_unit *u, struct lm_symbols *s)
{
    struct lm_position position;
    struct lm_offset at;
    s->has_steerpoint = find_steerpoint(u, &position);
    if (!s->has_steerpoint) {
        return;
    }
    s->to_go_s = to_go_s(u, position);
    if (lm_view_find(&u->picture.view, position, &at)) {
        const struct lm_frame *f = &u->picture.frame;
        const struct lm_point p = lm_view_point(&u->picture.view, at);
        s->steerpoint = p;
        s->is_steerpoint_on_glass = p.x >= f->left_px && p.x < f->left_px + f->width_px &&
                                    p.y >= f->top_px && p.y < f->top_px + f->height_px;
    }
}

/* Locate the aircraft over a picture that stands. Slant ranges are those of points on the ground;
 * the aircraft is not on the ground, so it is located by ground range. */
static void describe_ownship(const struct lm_unit *u, struct lm_symbols *s)
{
    struct lm_view level = u->picture.view;
    level.height_m_q10 = 0;
    s->is_ownship_shown = lm_view_find(&level, lm_ownship_position(&u->ownship), &s->ownship);
    s->ownship_heading = u->ownship.heading - u->picture.view.up;
}

static struct lm_symbols describe(const struct lm_unit *u)
{
    struct lm_symbols s = {
        .view = u->picture.view,
        .options = u->board->options,
        .is_sweeping = !(u->flags & LM_FLAGS_NO_LINES),
        .gain_db = u->page.gain_db,
        .heading = u->ownship.heading,
        .has_heading = u->ownship.heading_quality != LM_NAV_DEAD,
    };
    lm_picture_describe(&u->picture, &s);
    describe_cursor(u, &s);
    describe_steerpoint(u, &s);
    lm_tracking_describe(u, &s);
    if (u->picture.is_view_held && lm_ownship_is_known(&u->ownship)) {
        describe_ownship(u, &s);
    }
    return s;
}

static void show_radar(const struct lm_unit *u, const struct lm_glass *glass)
{
    const struct lm_symbols symbols = describe(u);
    lm_overlay_symbols(glass, &symbols);
    const struct lm_text database = lm_unit_map_refusal(&u->map);
    const struct lm_text sender = lm_sender_fault(u);
    const struct lm_warning_reasons reasons = {
        .database = database.words,
        .unable = lm_refusal_word(u->unable.reason),
        .exercise = u->live.is_silent ? "TARGETS" : "",
        .sender = sender.words,
    };
    lm_overlay_warnings(glass, u->flags & ~(uint32_t)LM_FLAG_MALFUNCTION, &reasons);
}

static void show_bit(const struct lm_unit *u, const struct lm_glass *glass)
{
    lm_overlay_blank(glass);
    for (uint32_t row = 0; row < LM_BIT_ROWS; row++) {
        const struct lm_text text = lm_bit_row(u, row);
        lm_overlay_row(glass, row, text.words);
    }
}

static void show_test(const struct lm_unit *u, const struct lm_glass *glass)
{
    (void)u;
    lm_overlay_test_pattern(glass);
}

/* What each page shows; the labels are drawn over it. */
static const struct page_drawing {
    bool has_picture;
    void (*draw)(const struct lm_unit *u, const struct lm_glass *glass);
} drawing_of[LM_FORMATS] = {
    [LM_FORMAT_RADAR] = {true, show_radar}, [LM_FORMAT_CNTL] = {true, show_radar},
    [LM_FORMAT_DCLT] = {true, show_radar},  [LM_FORMAT_BIT] = {false, show_bit},
    [LM_FORMAT_TEST] = {false, show_test},
};

/* Note what is on the glass now in the composer's list. */
static void note_glass(const struct lm_unit *u, struct lm_composer *c)
{
    const struct lm_glass glass = {c->surface, &u->picture.frame, &u->palette, &c->list};
    lm_draw_list_begin(&c->list, &c->changed);
    drawing_of[u->page.format].draw(u, &glass);
    lm_overlay_labels(&glass, &u->page);
    lm_overlay_alive(&glass, u->count.frames);
    lm_draw_list_end(&c->list);
}

/* A step that cannot end the frame composes with the list of a step before: what differs is damage
 * when the list is noted again. */
bool lm_compose_glass(const struct lm_unit *u, struct lm_composer *c, uint32_t pixels)
{
    const bool has_picture = drawing_of[u->page.format].has_picture;
    const bool may_end = lm_composer_take(c, &u->palette) <= pixels;
    if (may_end) {
        note_glass(u, c);
    }
    return lm_composer_run(c, has_picture ? &u->picture.plane : NULL, pixels) && may_end;
}

/* Borrow a surface for the next frame. False if there is none. */
static bool borrow_surface(struct lm_unit *u)
{
    const struct lm_display *display = u->board->display;
    struct lm_surface surface = {0};
    const int status = display->acquire(display->ctx, &surface);
    if (status != LM_OK) {
        u->count.display_busy += status == LM_BUSY;
        u->count.display_errors += status < 0;
        return false;
    }
    lm_composer_begin(&u->composer, &surface);
    u->frame_steps = 0;
    return true;
}

/* Compose what this step has time for: the lines that it did not draw leave their share. True if
 * the frame is complete. */
static bool compose_some(struct lm_unit *u, uint32_t lines_left)
{
    /* Nothing is on the first picture yet, so that a pixel of it costs an eighth of others. */
    const uint32_t limit = u->board->glass_step_px * (u->count.frames == 0 ? 8 : 1);
    const bool is_hurried = limit != 0 && ++u->frame_steps >= LM_FRAME_STEPS;
    u->count.frames_hurried += is_hurried;
    if (limit == 0 || is_hurried) {
        return lm_compose_glass(u, &u->composer, UINT32_MAX);
    }
    return lines_left > 0 && lm_compose_glass(u, &u->composer, limit * lines_left / LM_STEP_LINES);
}

static void end_frame(struct lm_unit *u, uint64_t now_us)
{
    const struct lm_display *display = u->board->display;
    u->count.display_errors += display->present(display->ctx, &u->composer.since[0]) != LM_OK;
    lm_composer_finish(&u->composer);
    u->count.frames++;
    /* Missed frames are not drawn later, and the display has its rest. */
    u->next_frame_us += LM_FRAME_US;
    if (u->next_frame_us <= now_us) {
        u->next_frame_us = now_us + LM_FRAME_US;
    } else if (u->next_frame_us < now_us + LM_DISPLAY_REST_US) {
        u->next_frame_us = now_us + LM_DISPLAY_REST_US;
    }
}

void lm_show_frame(struct lm_unit *u, uint32_t lines_left, uint64_t now_us)
{
    if ((u->composer.is_lent || borrow_surface(u)) && compose_some(u, lines_left)) {
        end_frame(u, now_us);
    }
}
