#include "lm/overlay.h"

#include "fx/mem.h"
#include "fx/sat.h"
#include "lm/font.h"
#include "overlay_internal.h"

void lm_overlay_blank(const struct lm_glass *g)
{
    const struct lm_pen pen = lm_glass_pen(g, g->palette->ink);
    lm_draw_box(&pen, 0, 0, g->surface.width_px, g->surface.height_px);
}

void lm_write(const struct lm_pen *pen, int32_t x, int32_t y, const char *words, uint32_t ground)
{
    struct lm_pen under = *pen;
    under.colour = ground;
    const int32_t dot = pen->dot_px;
    lm_draw_box(&under, x - dot, y - dot, lm_text_width(pen, words) + 2 * dot,
                (LM_FONT_HEIGHT + 2) * dot);
    lm_draw_text(pen, x, y, words);
}

/* ---- labels ---- */

/* Edge of the glass that a label is aligned to. */
enum side { SIDE_TOP, SIDE_RIGHT, SIDE_BOTTOM, SIDE_LEFT };

/* Middle of key `place`, 0..4 along its side. Keys are 0.30 of half the glass apart. */
static int32_t key_middle(int32_t place, int32_t extent_px)
{
    return extent_px * (50 + (place - 2) * 15) / 100;
}

static int32_t aligned_x(const struct lm_glass *g, const struct lm_pen *pen, enum side side,
                         int32_t middle, const char *words)
{
    const int32_t width = lm_text_width(pen, words), edge = 2 * pen->dot_px;
    switch (side) {
    case SIDE_RIGHT:
        return g->surface.width_px - edge - width;
    case SIDE_LEFT:
        return edge;
    case SIDE_TOP:
    case SIDE_BOTTOM:
        break;
    }
    return middle - width / 2;
}

static void draw_label(const struct lm_glass *g, const struct lm_label *label, enum side side,
                       int32_t middle)
{
    struct lm_pen pen = lm_symbol_pen(g);
    const int32_t rows = label->line[1][0] ? 2 : 1;
    const int32_t high = rows * lm_row_px(&pen) - 2 * pen.dot_px, edge = 2 * pen.dot_px;
    int32_t y = middle - high / 2;
    if (side == SIDE_TOP) {
        y = edge;
    } else if (side == SIDE_BOTTOM) {
        y = g->surface.height_px - edge - high;
    }
    const uint32_t ground = label->is_inverse ? pen.colour : g->palette->ink;
    pen.colour = label->is_inverse ? g->palette->ink : pen.colour;
    for (int32_t i = 0; i < rows; i++, y += lm_row_px(&pen)) {
        lm_write(&pen, aligned_x(g, &pen, side, middle, label->line[i]), y, label->line[i], ground);
    }
}

void lm_overlay_labels(const struct lm_glass *g, const struct lm_page *page)
{
    struct lm_label label;
    const int32_t width = g->surface.width_px, height = g->surface.height_px;
    for (int32_t key = 0; key < LM_OSBS; key++) {
        const uint8_t osb = (uint8_t)(key + 1);
        const enum side side = (enum side)(key / 5);
        const int32_t along = key % 5;
        const int32_t place = side == SIDE_TOP || side == SIDE_RIGHT ? along : 4 - along;
        const bool is_upright = side == SIDE_RIGHT || side == SIDE_LEFT;
        const int32_t extent = is_upright ? height : width;
        if (lm_page_label(page, osb, &label)) {
            draw_label(g, &label, side, key_middle(place, extent));
        }
        if (is_upright && lm_page_value(page, osb, &label)) {
            const int32_t between = key_middle(place, extent) + key_middle(place + 1, extent);
            draw_label(g, &label, side, between / 2);
        }
    }
}

/* ---- words ---- */

static const char flag_words[LM_FLAGS][9] = {
    "NAV", "NAV FAIL", "DB FAIL", "TILE", "BUS",    "FZ",   "OFF MAP", "NO RAD",   "UNABLE",
    "WX",  "BLW TERR", "MAG HDG", "EXC",  "SENDER", "MALF", "RESTART", "UNSIGNED", "POLE"};

const char *lm_flag_word(uint32_t number)
{
    return flag_words[number < LM_FLAGS ? number : 0];
}

/* Write a warning in a box, at row `row` of rows of so many dots. */
static void draw_warning(const struct lm_glass *g, int32_t row, int32_t row_dots, const char *words)
{
    const struct lm_pen pen = lm_glass_pen(g, g->palette->warning);
    const int32_t dot = pen.dot_px, width = lm_text_width(&pen, words);
    const int32_t x = g->frame->left_px + (g->frame->width_px - width) / 2;
    const int32_t first = fx_max_i32(g->frame->top_px, LM_BELOW_TOP_ROW_DOTS * dot) + 3 * dot;
    const int32_t y = first + row * row_dots * dot;
    const int32_t left = x - 3 * dot, right = x + width + 2 * dot;
    const int32_t top = y - 3 * dot, bottom = y + (LM_FONT_HEIGHT + 2) * dot;
    struct lm_pen ground = pen;
    ground.colour = g->palette->ink;
    lm_draw_box(&ground, left, top, right - left, bottom - top);
    lm_draw_line(&pen, (struct lm_point){left, top}, (struct lm_point){right, top});
    lm_draw_line(&pen, (struct lm_point){left, bottom}, (struct lm_point){right, bottom});
    lm_draw_text(&pen, x, y, words);
}

/* The reason that is written below the word of a flag, or "", as for no flag. */
static const char *reason_of(uint32_t flag, const struct lm_warning_reasons *reasons)
{
    return flag == LM_FLAG_DB         ? reasons->database
           : flag == LM_FLAG_UNABLE   ? reasons->unable
           : flag == LM_FLAG_EXERCISE ? reasons->exercise
           : flag == LM_FLAG_SENDER   ? reasons->sender
                                      : "";
}

/* Below the top of the frame a glass has 207 dots: 15 rows a little apart, or 20 close together. */
void lm_overlay_warnings(const struct lm_glass *g, uint32_t flags,
                         const struct lm_warning_reasons *reasons)
{
    enum { APART = 13, CLOSE = 10, ROWS_APART = 15 };
    const char *words[2 * LM_FLAGS];
    int32_t rows = 0;
    for (uint32_t i = 0; i < LM_FLAGS; i++) {
        const char *const why = reason_of(flags & 1u << i, reasons);
        if (flags & 1u << i) {
            words[rows++] = flag_words[i];
        }
        if (*why) {
            words[rows++] = why;
        }
    }
    for (int32_t row = 0; row < rows; row++) {
        draw_warning(g, row, rows > ROWS_APART ? CLOSE : APART, words[row]);
    }
}

void lm_overlay_alive(const struct lm_glass *g, uint32_t picture)
{
    const struct lm_pen pen = lm_symbol_pen(g);
    const int32_t size = 4 * pen.dot_px;
    const struct lm_point hub = {g->surface.width_px - 2 * size, g->surface.height_px - 2 * size};
    lm_draw_line(&pen, hub, lm_ray_end(lm_pixel_middle(hub), (fx_bam_t)(picture % 8) << 29, size));
}

void lm_overlay_row(const struct lm_glass *g, uint32_t row, const char *words)
{
    const struct lm_pen pen = lm_symbol_pen(g);
    /* The row of the top labels comes first. */
    lm_draw_text(&pen, lm_column_px(&pen), (int32_t)(row + 1) * lm_row_px(&pen) + 4 * pen.dot_px,
                 words);
}
