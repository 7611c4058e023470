#include "lm/draw.h"

#include <stdbool.h>
#include <stddef.h>

#include "fx/sat.h"
#include "fx/trig.h"
#include "lm/font.h"

enum { ARC_CHORDS = 48 };

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

void lm_draw_box(const struct lm_pen *pen, int32_t x, int32_t y, int32_t width, int32_t height)
{
    const struct lm_clip *clip = &pen->clip;
    const int32_t right = fx_min_i32(x + width, clip->right);
    const int32_t bottom = fx_min_i32(y + height, clip->bottom);
    const int32_t left = fx_max_i32(x, clip->left);
    for (int32_t row = fx_max_i32(y, clip->top); row < bottom; row++) {
        uint32_t *out = pen->surface.pixels + (uint32_t)row * pen->surface.stride_px;
        for (int32_t column = left; column < right; column++) {
            out[column] = pen->colour;
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
    const struct lm_clip *clip = &pen->clip;
    return p.x >= clip->left && p.x <= clip->right - pen->line_px && p.y >= clip->top &&
           p.y <= clip->bottom - pen->line_px;
}

/* Draw dots of one pixel, or two by two, that are all within the clip. Most lines consist of these,
 * so they are not clipped one by one. */
static void draw_dots_inside(const struct lm_pen *pen, struct dots d)
{
    const size_t stride = pen->surface.stride_px;
    const uint32_t colour = pen->colour;
    for (; d.count > 0; d.count--, d.x += d.step_x, d.y += d.step_y) {
        uint32_t *const out = pen->surface.pixels + (size_t)(d.y >> 16) * stride + (d.x >> 16);
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

void lm_draw_arc(const struct lm_pen *pen, struct lm_spot centre, int32_t radius, fx_bam_t left,
                 fx_bam_t span)
{
    struct lm_point from = lm_ray_end(centre, left, radius);
    for (uint32_t i = 1; i <= ARC_CHORDS; i++) {
        const fx_bam_t turned = (fx_bam_t)((uint64_t)span * i / ARC_CHORDS);
        const struct lm_point to = lm_ray_end(centre, left + turned, radius);
        lm_draw_line(pen, from, to);
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

void lm_draw_text(const struct lm_pen *pen, int32_t x, int32_t y, const char *words)
{
    for (; *words; words++, x += lm_column_px(pen)) {
        const uint8_t *rows = lm_font_glyph(*words);
        for (int32_t row = 0; row < LM_FONT_HEIGHT; row++) {
            draw_dots(pen, x, y + row * pen->dot_px, rows[row]);
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
