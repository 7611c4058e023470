#include "fx/sat.h"
#include "lm/font.h"
#include "overlay_internal.h"

enum { GREYS = 16, GRID = 10 };

/* Sixteen greys from black to white, and below them all 256. */
static void draw_greys(const struct lm_glass *g, int32_t top, int32_t height)
{
    struct lm_pen pen = lm_symbol_pen(g);
    const int32_t width = g->surface.width_px;
    for (int32_t i = 0; i < GREYS; i++) {
        pen.colour = g->palette->picture[i * 255 / (GREYS - 1)];
        lm_draw_box(&pen, width * i / GREYS, top, width / GREYS + 1, height);
    }
    /* Column x has grey x * 256 / width. */
    for (int32_t grey = 0; grey < 256; grey++) {
        const int32_t x = (grey * width + 255) / 256, end = ((grey + 1) * width + 255) / 256;
        pen.colour = g->palette->picture[grey];
        lm_draw_box(&pen, x, top + height, end - x, height / 2);
    }
}

static void draw_colours(const struct lm_glass *g, int32_t top, int32_t height)
{
    const struct lm_palette *p = g->palette;
    const uint32_t colours[] = {p->symbol,  p->faint,   p->warning, p->ink,    p->picture[255],
                                0x00FF0000, 0x0000FF00, 0x000000FF, 0x00FFFFFF};
    const int32_t count = sizeof colours / sizeof colours[0], width = g->surface.width_px;
    struct lm_pen pen = lm_symbol_pen(g);
    for (int32_t i = 0; i < count; i++) {
        pen.colour = colours[i];
        lm_draw_box(&pen, width * i / count, top, width / count + 1, height);
    }
}

/* A grid of tenths of the glass, its diagonals, and circles that must be round. */
static void draw_geometry(const struct lm_glass *g)
{
    struct lm_pen pen = lm_glass_pen(g, g->palette->faint);
    const int32_t right = g->surface.width_px - 1, bottom = g->surface.height_px - 1;
    for (int32_t i = 0; i <= GRID; i++) {
        const int32_t x = right * i / GRID, y = bottom * i / GRID;
        lm_draw_box(&pen, x, 0, 1, bottom + 1);
        lm_draw_box(&pen, 0, y, right + 1, 1);
    }
    pen.colour = g->palette->symbol;
    const struct lm_spot centre = lm_pixel_middle((struct lm_point){right / 2, bottom / 2});
    const int32_t radius = fx_min_i32(right, bottom) / 2;
    for (int32_t i = 1; i <= 3; i++) {
        lm_draw_arc(&pen, &(struct lm_arc){centre, radius * i / 3, 0, FX_BAM_180});
        lm_draw_arc(&pen, &(struct lm_arc){centre, radius * i / 3, FX_BAM_180, FX_BAM_180});
    }
    lm_draw_line(&pen, (struct lm_point){0, 0}, (struct lm_point){right, bottom});
    lm_draw_line(&pen, (struct lm_point){0, bottom}, (struct lm_point){right, 0});
}

static void write_sample(const struct lm_glass *g, int32_t top)
{
    static const char *const sample[] = {
        "ABCDEFGHIJKLMNOPQRSTUVWXYZ",
        "0123456789 !\"#$%&'()*+,-./",
        ":;<=>?@[\\]^_" LM_GLYPH_UP LM_GLYPH_DOWN LM_GLYPH_DEGREE,
    };
    const struct lm_pen pen = lm_symbol_pen(g);
    for (int32_t i = 0; i < 3; i++) {
        const int32_t x = (g->surface.width_px - lm_text_width(&pen, sample[i])) / 2;
        lm_write(&pen, x, top + i * (lm_row_px(&pen) + pen.dot_px), sample[i], g->palette->ink);
    }
}

void lm_overlay_test_pattern(const struct lm_glass *g)
{
    const int32_t height = g->surface.height_px;
    lm_overlay_blank(g);
    draw_geometry(g);
    draw_greys(g, height * 2 / 10, height / 10);
    write_sample(g, height * 45 / 100);
    draw_colours(g, height * 7 / 10, height / 10);
}
