#include "lm/draw.h"

#include <stdbool.h>
#include <stddef.h>

#include "fx/sat.h"
#include "fx/trig.h"
#include "lm/draw_list.h"
#include "lm/font.h"

enum {
    SHORT_PX = 8,
    /* A row of a character: its dots, and the leftmost of them. */
    DOTS = (1 << LM_FONT_WIDTH) - 1,
    LEFTMOST = 1 << (LM_FONT_WIDTH - 1)
};

struct lm_pen lm_pen_for(const struct lm_surface *surface, uint32_t colour)
{
    const int32_t shorter =
        surface->width_px < surface->height_px ? surface->width_px : surface->height_px;
    const int32_t dot_px = fx_clamp_i32((shorter + 60) / 240, 1, 4);
    return (struct lm_pen){.surface = *surface,
                           .clip = {0, 0, surface->width_px, surface->height_px},
                           .colour = colour,
                           .dot_px = dot_px,
                           .line_px = dot_px > 2 ? 2 : 1};
}

/* Fill the columns of a rectangle one by one: upright lines, whose rows are too short for a loop.
 */
static void fill_columns(const struct lm_pen *pen, const struct lm_rectangle *r)
{
    const size_t stride = pen->surface.stride_px;
    const uint32_t colour = pen->colour;
    for (int32_t column = r->left; column < r->right; column++) {
        uint32_t *out = pen->surface.pixels + (size_t)r->top * stride + column;
        for (int32_t row = r->top; row < r->bottom; row++, out += stride) {
            *out = colour;
        }
    }
}

/* Fill a rectangle that lies within the pen's clip. */
static void fill(const struct lm_pen *pen, const struct lm_rectangle *r)
{
    if (r->right - r->left < fx_min_i32(r->bottom - r->top, SHORT_PX)) {
        fill_columns(pen, r);
        return;
    }
    const size_t stride = pen->surface.stride_px;
    const uint32_t colour = pen->colour; /* a pixel might alias the pen's */
    uint32_t *out = pen->surface.pixels + (size_t)r->top * stride;
    for (int32_t row = r->top; row < r->bottom; row++, out += stride) {
        int32_t column = r->left;
        for (; column + 4 <= r->right; column += 4) {
            out[column] = colour;
            out[column + 1] = colour;
            out[column + 2] = colour;
            out[column + 3] = colour;
        }
        for (; column < r->right; column++) {
            out[column] = colour;
        }
    }
}

void lm_draw_box(const struct lm_pen *pen, int32_t x, int32_t y, int32_t width, int32_t height)
{
    const struct lm_rectangle *clip = &pen->clip;
    const struct lm_rectangle box = {.left = fx_max_i32(x, clip->left),
                                     .top = fx_max_i32(y, clip->top),
                                     .right = fx_min_i32(x + width, clip->right),
                                     .bottom = fx_min_i32(y + height, clip->bottom)};
    if (pen->list) {
        lm_draw_list_box(pen->list, pen, &box);
    } else if (!pen->within) {
        fill(pen, &box);
    } else {
        struct lm_rectangle part;
        struct lm_damage_walk walk = lm_damage_walk(&box);
        while (lm_damage_next(pen->within, &walk, &part)) {
            fill(pen, &part);
        }
    }
}

/* Dots of a line from one end to the other: `count` of them; coordinates and steps in Q16. */
struct dots {
    int32_t x, y, step_x, step_y, count;
};

/* True if a dot of the pen's line width at p is within the clip. */
static bool is_in_clip(const struct lm_pen *pen, struct lm_point p)
{
    const struct lm_rectangle *clip = &pen->clip;
    return p.x >= clip->left && p.x <= clip->right - pen->line_px && p.y >= clip->top &&
           p.y <= clip->bottom - pen->line_px;
}

/* Draw those pixels of a dot that the pen may touch. Most dots of a long line lie in bands without
 * any. */
static void draw_dot_within(const struct lm_pen *pen, uint32_t x, uint32_t y)
{
    const uint32_t dot = (uint32_t)pen->line_px, last = y + dot - 1;
    const uint64_t *const band = pen->within->band;
    if ((band[y / LM_BLOCK_HEIGHT_PX] | band[last / LM_BLOCK_HEIGHT_PX]) == 0) {
        return;
    }
    for (uint32_t row = y; row <= last; row++) {
        uint32_t *const out = pen->surface.pixels + (size_t)row * pen->surface.stride_px;
        const uint64_t blocks = band[row / LM_BLOCK_HEIGHT_PX];
        for (uint32_t column = x; column < x + dot; column++) {
            if (blocks >> column / LM_BLOCK_WIDTH_PX & 1) {
                out[column] = pen->colour;
            }
        }
    }
}

/* Draw dots of one pixel, or two by two, that are all within the clip. Most lines consist of these,
 * so they are not clipped one by one. */
static void draw_dots_inside(const struct lm_pen *pen, struct dots d)
{
    const size_t stride = pen->surface.stride_px;
    const uint32_t colour = pen->colour;
    for (; d.count > 0; d.count--, d.x += d.step_x, d.y += d.step_y) {
        uint32_t *const out = pen->surface.pixels + (size_t)(d.y >> 16) * stride + (d.x >> 16);
        if (pen->within) {
            draw_dot_within(pen, (uint32_t)d.x >> 16, (uint32_t)d.y >> 16);
            continue;
        }
        out[0] = colour;
        if (pen->line_px == 2) {
            out[1] = out[stride] = out[stride + 1] = colour;
        }
    }
}

void lm_draw_line(const struct lm_pen *pen, struct lm_point from, struct lm_point to)
{
    const int32_t dx = to.x - from.x, dy = to.y - from.y;
    const int32_t wide = dx < 0 ? -dx : dx, high = dy < 0 ? -dy : dy;
    const int32_t steps = fx_max_i32(wide, high);
    if (dx == 0 || dy == 0) {
        lm_draw_box(pen, fx_min_i32(from.x, to.x), fx_min_i32(from.y, to.y),
                    dx == 0 ? pen->line_px : wide + 1, dy == 0 ? pen->line_px : high + 1);
        return;
    }
    if (pen->list) {
        lm_draw_list_line(pen->list, pen, from, to);
        return;
    }
    /* |dx| and |dy| are below 2^14 (LM_DRAW_FAR), so the products stay below 2^30. */
    struct dots d = {from.x * 65536 + 32768, from.y * 65536 + 32768, dx * 65536 / steps,
                     dy * 65536 / steps, steps + 1};
    if (pen->line_px <= 2 && is_in_clip(pen, from) && is_in_clip(pen, to)) {
        draw_dots_inside(pen, d);
        return;
    }
    for (; d.count > 0; d.count--, d.x += d.step_x, d.y += d.step_y) {
        lm_draw_box(pen, d.x >> 16, d.y >> 16, pen->line_px, pen->line_px);
    }
}

struct lm_point lm_ray_end(struct lm_spot from, fx_bam_t azimuth, int32_t length)
{
    return (struct lm_point){(from.x_px_q8 + (length * fx_sin_q15(azimuth) >> 7)) >> 8,
                             (from.y_px_q8 - (length * fx_cos_q15(azimuth) >> 7)) >> 8};
}

struct lm_point lm_arc_end(const struct lm_arc *arc, uint32_t chord)
{
    const fx_bam_t turned = (fx_bam_t)((uint64_t)arc->span * chord / LM_ARC_CHORDS);
    return lm_ray_end(arc->centre, arc->left + turned, arc->radius);
}

/* True if the pen may touch a line. */
static bool may_touch(const struct lm_pen *pen, struct lm_point from, struct lm_point to)
{
    const struct lm_rectangle around = lm_line_bounds(pen, from, to);
    return !pen->within || lm_damage_meets(pen->within, &around);
}

void lm_draw_arc(const struct lm_pen *pen, const struct lm_arc *arc)
{
    if (pen->list) {
        lm_draw_list_arc(pen->list, pen, arc);
        return;
    }
    struct lm_point from = lm_arc_end(arc, 0);
    for (uint32_t chord = 1; chord <= LM_ARC_CHORDS; chord++) {
        const struct lm_point to = lm_arc_end(arc, chord);
        if (may_touch(pen, from, to)) {
            lm_draw_line(pen, from, to);
        }
        from = to;
    }
}

/* Draw a row of a character. Neighbouring dots are drawn as one box. */
static void draw_dots(const struct lm_pen *pen, int32_t x, int32_t y, uint8_t row)
{
    for (int32_t column = 0; column < LM_FONT_WIDTH; column++) {
        const int32_t first = column;
        while (column < LM_FONT_WIDTH && (row >> (LM_FONT_WIDTH - 1 - column) & 1)) {
            column++;
        }
        if (column > first) {
            lm_draw_box(pen, x + first * pen->dot_px, y, (column - first) * pen->dot_px,
                        pen->dot_px);
        }
    }
}

/* Draw a character that lies within the clip, dot by dot. */
static void draw_glyph_inside(const struct lm_pen *pen, int32_t x, int32_t y, const uint8_t *rows)
{
    const size_t dot = (size_t)pen->dot_px, stride = pen->surface.stride_px;
    const uint32_t colour = pen->colour;
    uint32_t *out = pen->surface.pixels + (size_t)y * stride + (size_t)x;
    for (int32_t row = 0; row < LM_FONT_HEIGHT; row++) {
        for (size_t high = 0; high < dot; high++, out += stride) {
            uint32_t *pixel = out;
            for (uint32_t left = rows[row]; left != 0; left = left << 1 & DOTS, pixel += dot) {
                for (size_t wide = 0; left & LEFTMOST && wide < dot; wide++) {
                    pixel[wide] = colour;
                }
            }
        }
    }
}

static void draw_glyph(const struct lm_pen *pen, int32_t x, int32_t y, const uint8_t *rows)
{
    const struct lm_rectangle *const clip = &pen->clip;
    const bool is_inside = x >= clip->left && x + LM_FONT_WIDTH * pen->dot_px <= clip->right &&
                           y >= clip->top && y + LM_FONT_HEIGHT * pen->dot_px <= clip->bottom;
    if (is_inside && !pen->within) {
        draw_glyph_inside(pen, x, y, rows);
        return;
    }
    for (int32_t row = 0; row < LM_FONT_HEIGHT; row++, y += pen->dot_px) {
        if (y < clip->bottom && y + pen->dot_px > clip->top) {
            draw_dots(pen, x, y, rows[row]);
        }
    }
}

void lm_draw_text(const struct lm_pen *pen, int32_t x, int32_t y, const char *words)
{
    if (pen->list) {
        lm_draw_list_text(pen->list, pen, (struct lm_point){x, y}, words);
    } else {
        lm_draw_glyphs(pen, x, y, words);
    }
}

void lm_draw_glyphs(const struct lm_pen *pen, int32_t x, int32_t y, const char *words)
{
    for (; *words; words++, x += lm_column_px(pen)) {
        if (x < pen->clip.right && x + lm_column_px(pen) > pen->clip.left) {
            draw_glyph(pen, x, y, lm_font_glyph(*words));
        }
    }
}

int32_t lm_text_width(const struct lm_pen *pen, const char *words)
{
    int32_t width = 0;
    for (; *words; words++) {
        width += lm_column_px(pen);
    }
    return width ? width - pen->dot_px : 0;
}
