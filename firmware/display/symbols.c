#include "fx/sat.h"
#include "lm/const.h"
#include "lm/font.h"
#include "lm/units.h"
#include "overlay_internal.h"

enum { ARCMIN_HUNDREDTHS = 360 * 60 * 100 };

/* Length of a symbol, in thousandths of half the shorter side of the glass. */
static int32_t part_of_half(const struct lm_glass *g, int32_t thousandths)
{
    const int32_t shorter = fx_min_i32(g->surface.width_px, g->surface.height_px);
    return shorter * thousandths / 2000;
}

static uint32_t degrees_of(fx_bam_t angle)
{
    return lm_deg_of_bam(angle) % 360;
}

/* The pen of symbols of the picture, which end at the frame. */
static struct lm_pen picture_pen(const struct lm_glass *g)
{
    const struct lm_frame *f = g->frame;
    struct lm_pen pen = lm_symbol_pen(g);
    pen.clip = (struct lm_rectangle){f->left_px, f->top_px, f->left_px + f->width_px,
                                     f->top_px + f->height_px};
    return pen;
}

/* Where the frame's symbols begin beside the labels of the left keys, some dots away: a tick right
 * behind a word is read as a sign. A label has at most five characters, from the second dot of the
 * glass, and ground around them. */
static int32_t beside_labels(const struct lm_glass *g, const struct lm_pen *pen)
{
    return fx_max_i32(g->frame->left_px, 3 * pen->dot_px + 5 * lm_column_px(pen)) + 4 * pen->dot_px;
}

static void line(const struct lm_pen *pen, int32_t x0, int32_t y0, int32_t x1, int32_t y1)
{
    lm_draw_line(pen, (struct lm_point){x0, y0}, (struct lm_point){x1, y1});
}

/* Range arcs at a quarter, half and three quarters of the range (at 10 nm at the half alone); as
 * options the sector's edges and the beam. */
static void draw_sector(const struct lm_glass *g, const struct lm_symbols *s)
{
    struct lm_pen pen = picture_pen(g);
    const struct lm_spot apex = {lm_px_q8_of_px(s->view.at.x), lm_px_q8_of_px(s->view.at.y)};
    const int32_t radius = s->view.radius_px;
    const fx_bam_t half = s->azimuth_half;
    const int32_t first = s->range_nm > 10 ? 1 : 2;
    for (int32_t quarter = first; quarter <= 4 - first; quarter++) {
        lm_draw_arc(&pen, &(struct lm_arc){apex, radius * quarter / 4, 0u - half, 2 * half});
    }
    for (int32_t side = -1; s->options.has_borders && side <= 1; side += 2) {
        const fx_bam_t edge = (fx_bam_t)side * half;
        lm_draw_line(&pen, lm_ray_end(apex, edge, 1), lm_ray_end(apex, edge, radius));
    }
    if (s->is_sweeping && s->options.has_strobe) {
        pen.colour = g->palette->faint;
        const fx_bam_t beam = (fx_bam_t)s->antenna_azimuth;
        lm_draw_line(&pen, lm_ray_end(apex, beam, radius / 40), lm_ray_end(apex, beam, radius));
    }
}

/* Bracket `length` pixels long, at the upper left corner of a window or patch, right of the gain
 * and of the labels. One of a tenth of the length has a tick in its middle. */
static void draw_bracket(const struct lm_glass *g, const struct lm_symbols *s, int32_t length,
                         bool is_tenth)
{
    const struct lm_pen pen = picture_pen(g);
    const int32_t dot = pen.dot_px, square_left = s->view.middle.x - s->view.radius_px;
    const int32_t x = fx_max_i32(square_left + 4 * dot, beside_labels(g, &pen) + 6 * dot);
    const int32_t y = s->view.middle.y - s->view.radius_px + 4 * dot;
    line(&pen, x, y, x + length, y);
    line(&pen, x, y, x, y + 3 * dot);
    line(&pen, x + length, y, x + length, y + 3 * dot);
    if (is_tenth) {
        line(&pen, x + length / 2, y, x + length / 2, y + 2 * dot);
    }
}

static int32_t px_of_feet(const struct lm_symbols *s, uint64_t feet)
{
    return (int32_t)(feet * LM_FOOT_UM * 256 / 1000 / s->view.scale_mm_per_px_q8);
}

/* Symbols of a window: a bracket 1,500 feet long, and a small cross where the cursor would be in
 * the whole sector. */
static void draw_window(const struct lm_glass *g, const struct lm_symbols *s)
{
    const struct lm_pen pen = picture_pen(g);
    draw_bracket(g, s, px_of_feet(s, 1500), false);
    if (s->is_cue_shown) {
        const int32_t arm = part_of_half(g, 30);
        line(&pen, s->cue.x - arm, s->cue.y, s->cue.x + arm, s->cue.y);
        line(&pen, s->cue.x, s->cue.y - arm, s->cue.x, s->cue.y + arm);
    }
}

/* The line of sight, an arrow that points up, and north, a line with its letter, at the lower right
 * corner of a patch. */
static void draw_look(const struct lm_glass *g, const struct lm_symbols *s)
{
    const struct lm_pen pen = picture_pen(g);
    const int32_t arm = part_of_half(g, 60), head = part_of_half(g, 20);
    const int32_t away = s->view.radius_px - 2 * arm;
    const struct lm_point at = {s->view.middle.x + away, s->view.middle.y + away};
    const struct lm_spot from = lm_pixel_middle(at);
    const fx_bam_t north = 0u - s->patch_look;
    const struct lm_point tip = lm_ray_end(from, 0, arm),
                          letter = lm_ray_end(from, north, 7 * arm / 4);
    line(&pen, at.x, at.y + arm / 2, tip.x, tip.y);
    line(&pen, tip.x, tip.y, tip.x - head, tip.y + head);
    line(&pen, tip.x, tip.y, tip.x + head, tip.y + head);
    lm_draw_line(&pen, at, lm_ray_end(from, north, arm));
    lm_write(&pen, letter.x - lm_column_px(&pen) / 2, letter.y - lm_row_px(&pen) / 2, "N",
             g->palette->ink);
}

/* Symbols of a patch: a bracket 1,500 feet long, or 150 feet where that would be more than half a
 * side, and the directions of the line of sight and of north. */
static void draw_patch(const struct lm_glass *g, const struct lm_symbols *s)
{
    const int32_t whole = px_of_feet(s, 1500);
    const bool is_tenth = whole > s->view.radius_px;
    draw_bracket(g, s, is_tenth ? px_of_feet(s, 150) : whole, is_tenth);
    draw_look(g, s);
}

/* Length of an angle on the antenna's scales: 60 degrees are 0.72 of half the glass. */
static int32_t scale_px(const struct lm_glass *g, int32_t angle)
{
    const int64_t sixty = (int64_t)FX_BAM_DEG(60);
    const int64_t clamped = fx_clamp_i64(angle, -sixty, sixty);
    return (int32_t)(clamped * part_of_half(g, 720) / sixty);
}

/* The antenna's scales: azimuth along the bottom of the frame, elevation along its left side,
 * beside the labels. Each has ticks at every ten degrees up to thirty, and a T that points at the
 * antenna's angle. */
static void draw_antenna(const struct lm_glass *g, const struct lm_symbols *s)
{
    const struct lm_pen pen = picture_pen(g);
    const int32_t dot = pen.dot_px, tick = 2 * dot, stem = 3 * dot;
    const int32_t middle_x = s->view.middle.x,
                  bottom = g->frame->top_px + g->frame->height_px - pen.line_px;
    const int32_t middle_y = g->surface.height_px / 2, left = beside_labels(g, &pen);
    for (int32_t tens = -3; tens <= 3; tens++) {
        const int32_t at = scale_px(g, tens * (int32_t)FX_BAM_DEG(10));
        line(&pen, middle_x + at, bottom - tick, middle_x + at, bottom);
        line(&pen, left, middle_y + at, left + tick, middle_y + at);
    }
    if (!s->is_sweeping) {
        return;
    }
    const int32_t x = middle_x + scale_px(g, s->antenna_azimuth);
    const int32_t bar_y = bottom - tick - stem;
    line(&pen, x, bar_y, x, bottom - tick);
    line(&pen, x - stem, bar_y, x + stem, bar_y);
    const int32_t y = middle_y - scale_px(g, s->antenna_elevation);
    const int32_t bar_x = left + tick + stem;
    line(&pen, left + tick, y, bar_x, y);
    line(&pen, bar_x, y - stem, bar_x, y + stem);
}

/* The gain: a bracket beside the label of OSB 20, with a caret. */
static void draw_gain(const struct lm_glass *g, int32_t gain_db)
{
    const struct lm_pen pen = picture_pen(g);
    const int32_t dot = pen.dot_px, x = beside_labels(g, &pen);
    const int32_t top = g->frame->top_px, high = part_of_half(g, 250);
    line(&pen, x, top, x, top + high);
    line(&pen, x, top, x + 3 * dot, top);
    line(&pen, x, top + high, x + 3 * dot, top + high);
    const int32_t y = top + high / 2 - gain_db * high / (2 * LM_GAIN_MAX_DB);
    line(&pen, x, y, x - 3 * dot, y - 2 * dot);
    line(&pen, x, y, x - 3 * dot, y + 2 * dot);
}

/* The cursor: lines across the whole frame, and four ticks around the window that the next field of
 * view would cut out. In a sector these are an eighth of the range away. In a window they are drawn
 * if a finer one is offered. */
static void draw_cursor(const struct lm_glass *g, const struct lm_symbols *s)
{
    const struct lm_pen pen = picture_pen(g);
    const struct lm_frame *f = g->frame;
    const struct lm_point at = lm_view_point(&s->view, s->cursor);
    const int32_t right = f->left_px + f->width_px - 1, bottom = f->top_px + f->height_px - 1;
    const int32_t x = fx_clamp_i32(at.x, f->left_px, right);
    const int32_t y = fx_clamp_i32(at.y, f->top_px, bottom);
    line(&pen, x, f->top_px, x, bottom);
    line(&pen, f->left_px, y, right, y);
    int32_t away = s->view.radius_px / 8;
    if (s->view.shape == LM_VIEW_WINDOW && s->is_finer_offered) {
        away =
            s->view.radius_px * 6 / 25; /* DBS2 reaches 0.03 of the range, this window an eighth */
    } else if (s->view.shape != LM_VIEW_SECTOR) {
        return;
    }
    const int32_t half = part_of_half(g, 65) / 2;
    for (int32_t side = -1; side <= 1; side += 2) {
        line(&pen, x + side * away, y - half, x + side * away, y + half);
        line(&pen, x - half, y + side * away, x + half, y + side * away);
    }
}

static void draw_diamond(const struct lm_pen *pen, struct lm_point at, int32_t reach)
{
    for (int32_t side = -1; side <= 1; side += 2) {
        line(pen, at.x - reach, at.y, at.x, at.y + side * reach);
        line(pen, at.x, at.y + side * reach, at.x + reach, at.y);
    }
}

/* The steerpoint: a diamond. */
static void draw_steerpoint(const struct lm_glass *g, struct lm_point at)
{
    const struct lm_pen pen = picture_pen(g);
    draw_diamond(&pen, at, part_of_half(g, 65) / 2);
}

/* A Maltese cross: four triangles whose tips meet a little beyond the middle [FreeFalcon,
 * bscope.cpp, AGRangingDisplay]. */
static void draw_maltese(const struct lm_glass *g, const struct lm_pen *pen, struct lm_point at)
{
    const int32_t far = part_of_half(g, 45), aside = part_of_half(g, 15);
    for (int32_t side = -1; side <= 1; side += 2) {
        const int32_t x = at.x + side * far, y = at.y + side * far;
        line(pen, at.x - aside, y, at.x + aside, y);
        line(pen, at.x - aside, y, at.x, at.y);
        line(pen, at.x + aside, y, at.x, at.y);
        line(pen, x, at.y - aside, x, at.y + aside);
        line(pen, x, at.y - aside, at.x, at.y);
        line(pen, x, at.y + aside, at.x, at.y);
    }
}

/* What is tracked: a filled diamond, hollow while it coasts, with the course of a mover. */
static void draw_track(const struct lm_glass *g, const struct lm_symbols *s)
{
    const struct lm_pen pen = picture_pen(g);
    const int32_t reach = part_of_half(g, 65);
    if (s->track_shape == LM_SHAPE_CROSS) {
        draw_maltese(g, &pen, s->track);
        return;
    }
    draw_diamond(&pen, s->track, reach);
    for (int32_t y = 1 - reach; s->track_shape == LM_SHAPE_FILLED && y < reach; y += pen.line_px) {
        const int32_t half = reach - (y < 0 ? -y : y);
        lm_draw_box(&pen, s->track.x - half, s->track.y + y, 2 * half + 1, pen.line_px);
    }
    if (s->has_track_course) {
        lm_draw_line(&pen, s->track,
                     lm_ray_end(lm_pixel_middle(s->track), s->track_course, 2 * reach));
    }
}

/* What is said of the track, in the lower left corner of the frame. */
static void write_track(const struct lm_glass *g, const struct lm_symbols *s)
{
    const struct lm_pen pen = lm_symbol_pen(g);
    lm_write(&pen, beside_labels(g, &pen),
             g->frame->top_px + g->frame->height_px - 2 * lm_row_px(&pen), s->track_words.words,
             g->palette->ink);
}

/* The ownship: a circle with a line twice its radius long in the direction of its heading. */
static void draw_ownship(const struct lm_glass *g, const struct lm_symbols *s)
{
    const struct lm_pen pen = picture_pen(g);
    const struct lm_point at = lm_view_point(&s->view, s->ownship);
    const int32_t radius = part_of_half(g, 50);
    const struct lm_spot centre = lm_pixel_middle(at);
    lm_draw_arc(&pen, &(struct lm_arc){centre, radius, 0, FX_BAM_180});
    lm_draw_arc(&pen, &(struct lm_arc){centre, radius, FX_BAM_180, FX_BAM_180});
    lm_draw_line(&pen, at, lm_ray_end(centre, s->ownship_heading, 2 * radius));
}

/* ---- numbers ---- */

/* Top of a row of numbers. Row 0 is between the upper labels, which may have two lines, and the
 * frame; rows 1 and 2 are between the frame and the lower labels. */
static int32_t row_y(const struct lm_glass *g, const struct lm_pen *pen, int32_t row)
{
    const int32_t bottom = g->surface.height_px - (4 + 3 * 9) * pen->dot_px;
    return row == 0 ? LM_TOP_ROW_DOTS * pen->dot_px : bottom + (row - 1) * lm_row_px(pen);
}

/* Left edge of the first number of a row, and right edge of the last from the glass's own. */
static int32_t margin_px(const struct lm_pen *pen)
{
    return 2 * lm_column_px(pen);
}

enum align { ALIGN_LEFT, ALIGN_MIDDLE, ALIGN_RIGHT };

static void write_row(const struct lm_glass *g, int32_t row, enum align align, const char *words)
{
    const struct lm_pen pen = lm_symbol_pen(g);
    const int32_t edge = margin_px(&pen), width = lm_text_width(&pen, words);
    int32_t x = edge;
    if (align == ALIGN_MIDDLE) {
        x = (g->surface.width_px - width) / 2;
    } else if (align == ALIGN_RIGHT) {
        x = g->surface.width_px - edge - width;
    }
    lm_write(&pen, x, row_y(g, &pen, row), words, g->palette->ink);
}

/* Write the letter of the hemisphere, degrees, and minutes to the hundredth: "N46" LM_GLYPH_DEGREE
 * "02.50". `digits` is the number of digits of the degrees. */
static void write_angle(const struct lm_glass *g, int32_t row, const char *letter, uint32_t angle,
                        uint32_t digits)
{
    const uint32_t hundredths =
        (uint32_t)(((uint64_t)angle * ARCMIN_HUNDREDTHS + (1u << 31)) >> 32);
    struct lm_text t = {0};
    lm_text_add(&t, letter);
    lm_text_number(&t, hundredths / 6000, digits);
    lm_text_add(&t, LM_GLYPH_DEGREE);
    lm_text_number(&t, hundredths / 100 % 60, 2);
    lm_text_add(&t, ".");
    lm_text_number(&t, hundredths % 100, 2);
    write_row(g, row, ALIGN_RIGHT, t.words);
}

static void write_position(const struct lm_glass *g, struct lm_position position)
{
    const int32_t latitude = (int32_t)position.latitude, longitude = (int32_t)position.longitude;
    write_angle(g, 1, latitude < 0 ? "S" : "N", fx_abs_u32(latitude), 2);
    write_angle(g, 2, longitude < 0 ? "W" : "E", fx_abs_u32(longitude), 3);
}

/* The cursor's bearing and range, elevation, and position. */
static void write_cursor(const struct lm_glass *g, const struct lm_symbols *s)
{
    const uint32_t tenths = (s->cursor_range_m * 10 + LM_NM_M / 2) / LM_NM_M;
    struct lm_text t = {0};
    lm_text_number(&t, degrees_of(s->cursor_bearing), 3);
    lm_text_add(&t, LM_GLYPH_DEGREE "/");
    lm_text_number(&t, tenths / 10, 2);
    lm_text_add(&t, ".");
    lm_text_number(&t, tenths % 10, 1);
    write_row(g, 1, ALIGN_LEFT, t.words);
    if (s->has_cursor_elevation) {
        const int64_t feet_q22 = (int64_t)s->cursor_elevation_m_q10 * LM_FEET_PER_M_Q12;
        t = (struct lm_text){0};
        lm_text_add(&t, "ELV ");
        lm_text_signed(&t, (int32_t)((feet_q22 + (1 << 21)) >> 22));
        lm_text_add(&t, "FT");
        write_row(g, 2, ALIGN_LEFT, t.words);
    }
    write_position(g, s->cursor_position);
}

/* Time to go to the steerpoint, in minutes and seconds. */
static void write_to_go(const struct lm_glass *g, uint32_t to_go_s)
{
    struct lm_text t = {0};
    lm_text_add(&t, "TTG ");
    if (to_go_s < LM_TO_GO_NONE) {
        lm_text_number(&t, to_go_s / 60, 2);
        lm_text_add(&t, ":");
        lm_text_number(&t, to_go_s % 60, 2);
    } else {
        lm_text_add(&t, "--:--");
    }
    write_row(g, 1, ALIGN_MIDDLE, t.words);
}

/* Length of the map's cells. It stands between the longest elevation, which has twelve characters,
 * and the longest longitude, which has ten. */
static void write_map_cell(const struct lm_glass *g, uint32_t cell_mm)
{
    const struct lm_pen pen = lm_symbol_pen(g);
    const int32_t column = lm_column_px(&pen), edge = margin_px(&pen);
    const int32_t left = edge + 12 * column, right = g->surface.width_px - edge - 10 * column;
    struct lm_text t = {0};
    lm_text_add(&t, "MAP ");
    lm_text_number(&t, fx_min_u32((cell_mm + 500) / 1000, 9999), 1);
    lm_text_add(&t, "M");
    lm_write(&pen, (left + right - lm_text_width(&pen, t.words)) / 2, row_y(g, &pen, 2), t.words,
             g->palette->ink);
}

static void write_patch(const struct lm_glass *g, const struct lm_symbols *s)
{
    struct lm_text t = {0};
    lm_text_add(&t, "CELL ");
    lm_text_number(&t, s->patch_cell_mm / 1000, 1);
    lm_text_add(&t, ".");
    lm_text_number(&t, s->patch_cell_mm / 100 % 10, 1);
    lm_text_add(&t, "M");
    write_row(g, 0, ALIGN_LEFT, t.words);
    t = (struct lm_text){0};
    lm_text_add(&t, "LOOK ");
    lm_text_number(&t, degrees_of(s->patch_look), 3);
    write_row(g, 0, ALIGN_RIGHT, t.words);
    t = (struct lm_text){0};
    lm_text_number(&t, s->patch_percent, 1);
    lm_text_add(&t, "%");
    if (s->patch_to_go_s != 0) {
        lm_text_add(&t, " ");
        lm_text_number(&t, s->patch_to_go_s, 1);
        lm_text_add(&t, "S");
    }
    write_row(g, 0, ALIGN_MIDDLE, t.words);
}

static void write_heading(const struct lm_glass *g, fx_bam_t heading)
{
    struct lm_text t = {0};
    lm_text_number(&t, degrees_of(heading), 3);
    write_row(g, 0, ALIGN_MIDDLE, t.words);
}

void lm_overlay_symbols(const struct lm_glass *g, const struct lm_symbols *s)
{
    if (s->has_cursor) {
        write_cursor(g, s);
    }
    if (s->view.shape == LM_VIEW_PATCH) {
        draw_patch(g, s);
        write_patch(g, s);
    } else {
        if (s->view.shape == LM_VIEW_SECTOR) {
            draw_sector(g, s);
        } else {
            draw_window(g, s);
        }
        draw_antenna(g, s);
        if (s->has_heading && s->options.has_heading) {
            write_heading(g, s->heading);
        }
    }
    draw_gain(g, s->gain_db);
    if (s->coarse_mm != 0) {
        write_map_cell(g, s->coarse_mm);
    }
    if (s->has_steerpoint) {
        write_to_go(g, s->to_go_s);
    }
    if (s->is_steerpoint_on_glass) {
        draw_steerpoint(g, s->steerpoint);
    }
    if (s->is_cursor_on_glass) {
        draw_cursor(g, s);
    }
    if (s->is_ownship_shown) {
        draw_ownship(g, s);
    }
    if (s->track_shape != LM_SHAPE_NONE) {
        draw_track(g, s);
    }
    if (s->track_words.length != 0) {
        write_track(g, s);
    }
}
