#include "sim/bezel.h"

#include "lm/draw.h"
#include "lm/font.h"

#include <stdio.h>
#include <string.h>

enum {
    PANEL = 0x002C2F33,
    KEY = 0x00474C52,
    EDGE = 0x00181A1C,
    LIT = 0x00D8C060,
    WORDS = 0x00C8CCD0
};

static const char *const rocker_names[LM_ROCKERS] = {[LM_ROCKER_GAIN] = "GAIN",
                                                     [LM_ROCKER_SYM] = "SYM",
                                                     [LM_ROCKER_BRT] = "BRT",
                                                     [LM_ROCKER_CON] = "CON"};

struct bezel bezel_around(uint16_t glass_width_px, uint16_t glass_height_px)
{
    const uint16_t shorter = glass_width_px < glass_height_px ? glass_width_px : glass_height_px;
    const uint16_t margin_px = shorter / 8;
    return (struct bezel){.glass_width_px = glass_width_px,
                          .glass_height_px = glass_height_px,
                          .margin_px = margin_px,
                          .width_px = (uint16_t)(glass_width_px + 2 * margin_px),
                          .height_px = (uint16_t)(glass_height_px + 2 * margin_px)};
}

/* A corner's rocker: gain and symbology above, contrast and brightness below. */
static struct bezel_box rocker_box(const struct bezel *b, enum lm_rocker rocker, bool is_more)
{
    const bool is_right = rocker == LM_ROCKER_SYM || rocker == LM_ROCKER_BRT;
    const bool is_low = rocker == LM_ROCKER_CON || rocker == LM_ROCKER_BRT;
    const int32_t m = b->margin_px, wide = m * 6 / 10, high = m * 3 / 10;
    return (struct bezel_box){(is_right ? b->width_px - m : 0) + (m - wide) / 2,
                              (is_low ? b->height_px - m : 0) + m / 10 + (is_more ? 0 : high), wide,
                              high};
}

struct bezel_box bezel_box_of(const struct bezel *b, int32_t button)
{
    if (button > LM_OSBS) {
        const int32_t half = button - LM_OSBS - 1;
        return rocker_box(b, (enum lm_rocker)(half / 2), half % 2 == 0);
    }
    const int32_t side = (button - 1) / 5, along = (button - 1) % 5;
    const int32_t place = side < 2 ? along : 4 - along;
    const bool is_upright = side % 2 == 1;
    const int32_t m = b->margin_px, size = m * 6 / 10, gap = (m - size) / 2;
    const int32_t extent = is_upright ? b->glass_height_px : b->glass_width_px;
    const int32_t at = m + extent * (50 + (place - 2) * 15) / 100 - size / 2;
    const int32_t far_x = b->width_px - m + gap, far_y = b->height_px - m + gap;
    if (is_upright) {
        return (struct bezel_box){side == 1 ? far_x : gap, at, size, size};
    }
    return (struct bezel_box){at, side == 0 ? gap : far_y, size, size};
}

int32_t bezel_button_at(const struct bezel *b, int32_t x, int32_t y)
{
    for (int32_t button = 1; button <= LM_BUTTONS; button++) {
        const struct bezel_box box = bezel_box_of(b, button);
        if (x >= box.x && x < box.x + box.width && y >= box.y && y < box.y + box.height) {
            return button;
        }
    }
    return 0;
}

static void draw_words(struct lm_pen pen, const struct bezel_box *box, const char *words)
{
    const int32_t width = lm_text_width(&pen, words), height = LM_FONT_HEIGHT * pen.dot_px;
    lm_draw_text(&pen, box->x + (box->width - width) / 2, box->y + (box->height - height) / 2,
                 words);
}

static void draw_button(struct lm_pen pen, const struct bezel *b, int32_t button, bool is_lit)
{
    const struct bezel_box box = bezel_box_of(b, button);
    char words[12];
    pen.colour = EDGE;
    lm_draw_box(&pen, box.x - 1, box.y - 1, box.width + 2, box.height + 2);
    pen.colour = is_lit ? LIT : KEY;
    lm_draw_box(&pen, box.x + 1, box.y + 1, box.width - 2, box.height - 2);
    if (button <= LM_OSBS) {
        snprintf(words, sizeof words, "%d", button);
    } else {
        snprintf(words, sizeof words, "%s", (button - LM_OSBS) % 2 ? "+" : "-");
    }
    pen.colour = is_lit ? EDGE : WORDS;
    draw_words(pen, &box, words);
}

static void draw_rocker_name(struct lm_pen pen, const struct bezel *b, enum lm_rocker rocker)
{
    struct bezel_box box = rocker_box(b, rocker, false);
    box.y += box.height;
    pen.colour = WORDS;
    draw_words(pen, &box, rocker_names[rocker]);
}

void bezel_draw(const struct bezel *b, uint32_t *pixels, const uint32_t *glass, uint32_t down)
{
    const struct lm_surface surface = {.pixels = pixels,
                                       .stride_px = b->width_px,
                                       .width_px = b->width_px,
                                       .height_px = b->height_px};
    struct lm_pen pen = lm_pen_for(&surface, PANEL);
    pen.dot_px = b->margin_px < 80 ? 1 : 2;
    lm_draw_box(&pen, 0, 0, b->width_px, b->height_px);
    pen.colour = EDGE;
    lm_draw_box(&pen, b->margin_px - 3, b->margin_px - 3, b->glass_width_px + 6,
                b->glass_height_px + 6);
    for (int32_t button = 1; button <= LM_BUTTONS; button++) {
        draw_button(pen, b, button, down >> (button - 1) & 1);
    }
    for (int32_t rocker = 0; rocker < LM_ROCKERS; rocker++) {
        draw_rocker_name(pen, b, (enum lm_rocker)rocker);
    }
    for (uint32_t y = 0; y < b->glass_height_px; y++) {
        memcpy(pixels + (y + b->margin_px) * b->width_px + b->margin_px,
               glass + y * b->glass_width_px, b->glass_width_px * sizeof *pixels);
    }
}
