#include "bake_sheet.h"

#include "hs/angle.h"
#include "hs/chart.h"

#include <stdio.h>

enum { COLUMNS_MAX = 8, ZOOM = 3, SIDE = ZOOM * LM_CHIP_SIDE, GAP = 6, CAPTION = 20, SPAN = 100 };

static const uint32_t lit = 0x142814, hidden = 0x000c40;

static uint8_t brightest(const struct db_signature *s)
{
    uint8_t most = 1;
    for (uint32_t i = 0; i < db_signature_chips(&s->head); i++) {
        for (int k = 0; k < LM_CHIP_SIDE * LM_CHIP_SIDE; k++) {
            const uint8_t level = s->chips[i].level[k / LM_CHIP_SIDE][k % LM_CHIP_SIDE];
            most = level > most ? level : most;
        }
    }
    return most;
}

/* The brighter of ground and echo in each colour. */
static uint32_t tint(uint32_t ground, uint32_t grey)
{
    uint32_t pixel = 0;
    for (int shift = 0; shift < 24; shift += 8) {
        const uint32_t part = ground >> shift & 0xff;
        pixel |= (part > grey ? part : grey) << shift;
    }
    return pixel;
}

static void draw_chip(const struct lm_chip *c, uint8_t white, struct sheet *sheet, int x, int y)
{
    for (int i = 0; i < SIDE * SIDE; i++) {
        const int row = LM_CHIP_SIDE - 1 - i / SIDE / ZOOM, column = i % SIDE / ZOOM;
        const int step = c->level[row][column] - white + SPAN;
        const bool is_hidden = c->shadow[row][column / 8] >> column % 8 & 1;
        const uint32_t grey =
            c->level[row][column] > 0 && step > 0 ? (uint32_t)step * 255 / SPAN : 0;
        sheet_dot(sheet, x + i % SIDE, y + i / SIDE, tint(is_hidden ? hidden : lit, grey));
    }
}

int bake_sheet(const struct db_signature *s, const char *path)
{
    const int aspects = s->head.aspects, depressions = s->head.depressions;
    const int columns = aspects < COLUMNS_MAX ? aspects : COLUMNS_MAX;
    const uint8_t white = brightest(s);
    struct sheet sheet;
    if (sheet_open(&sheet, GAP + columns * (SIDE + GAP),
                   GAP + depressions * (SIDE + CAPTION + GAP)) != 0) {
        return -1;
    }
    for (int i = 0; i < columns * depressions; i++) {
        const int aspect = i % columns * aspects / columns, depression = i / columns;
        const int x = GAP + i % columns * (SIDE + GAP);
        const int y = GAP + depression * (SIDE + CAPTION + GAP);
        char text[64];
        draw_chip(&s->chips[depression * aspects + aspect], white, &sheet, x, y);
        snprintf(text, sizeof text, "%g, %g down", 360.0 * aspect / aspects,
                 hs_degrees(s->head.depression[depression]));
        sheet_text(&sheet, x, y + SIDE + 4, text, INK_BLACK);
    }
    return sheet_close(&sheet, path);
}
