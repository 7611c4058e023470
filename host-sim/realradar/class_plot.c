#include "hs/error.h"
#include "hs/png.h"
#include "lm/font.h" /* the display's own letters */
#include "realradar/class_order.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    WIDTH = 900,
    LEFT = 170,
    RIGHT = 880,
    TOP = 46,
    CLASS_HEIGHT = 62,
    BAR_HEIGHT = 16,
    LETTER_SCALE = 2,
    LETTER_STEP = (LM_FONT_WIDTH + 1) * LETTER_SCALE,
    LOWEST_DB = -50,
    HIGHEST_DB = 20,
    GRID_DB = 10,
};

#define WHITE     0xffffffu
#define BLACK     0x000000u
#define GREY      0xd0d0d0u
#define MEASURED  0x3060c0u
#define SIMULATED 0xe08020u

struct canvas {
    uint32_t *pixels;
    int height;
};

static void fill(struct canvas *c, int x0, int y0, int x1, int y1, uint32_t colour)
{
    for (int y = y0 > 0 ? y0 : 0; y < y1 && y < c->height; y++) {
        for (int x = x0 > 0 ? x0 : 0; x < x1 && x < WIDTH; x++) {
            c->pixels[y * WIDTH + x] = colour;
        }
    }
}

static void write_text(struct canvas *c, int x, int y, const char *text, uint32_t colour)
{
    for (; *text; text++, x += LETTER_STEP) {
        /* The display has capitals only. */
        const char letter = (char)(*text >= 'a' && *text <= 'z' ? *text - 'a' + 'A' : *text);
        const uint8_t *glyph = lm_font_glyph(letter);
        for (int dot = 0; dot < LM_FONT_WIDTH * LM_FONT_HEIGHT; dot++) {
            const int across = dot % LM_FONT_WIDTH, down = dot / LM_FONT_WIDTH;
            if (glyph[down] >> (LM_FONT_WIDTH - 1 - across) & 1) {
                const int left = x + across * LETTER_SCALE, top = y + down * LETTER_SCALE;
                fill(c, left, top, left + LETTER_SCALE, top + LETTER_SCALE, colour);
            }
        }
    }
}

static int x_of(double db)
{
    const double part = (db - LOWEST_DB) / (HIGHEST_DB - LOWEST_DB);
    return LEFT + (int)lround((RIGHT - LEFT) * fmin(fmax(part, 0), 1));
}

static void draw_grid(struct canvas *c)
{
    const int bottom = c->height - 46;
    for (int db = LOWEST_DB; db <= HIGHEST_DB; db += GRID_DB) {
        char text[8];
        const int x = x_of(db), length = snprintf(text, sizeof text, "%d", db);
        fill(c, x, TOP - 6, x + 1, bottom, db == 0 ? BLACK : GREY);
        write_text(c, x - length * LETTER_STEP / 2, bottom + 6, text, BLACK);
    }
    write_text(c, LEFT + (RIGHT - LEFT) / 2 - LETTER_STEP, bottom + 26, "DB", BLACK);
}

static void draw_bar(struct canvas *c, int y, const struct rr_spread *s, uint32_t colour)
{
    fill(c, x_of(s->low), y, x_of(s->high) + 1, y + BAR_HEIGHT, colour);
    fill(c, x_of(s->median) - 1, y - 3, x_of(s->median) + 2, y + BAR_HEIGHT + 3, BLACK);
}

static void draw(struct canvas *c, const struct rr_class_order *order,
                 const struct db_class_table *table)
{
    fill(c, 0, 0, WIDTH, c->height, WHITE);
    write_text(c, LEFT, 12, "measured, C band", MEASURED);
    write_text(c, LEFT + 340, 12, "simulated, X band", SIMULATED);
    draw_grid(c);
    for (int i = 0; i < order->count; i++) {
        const int y = TOP + (order->count - 1 - i) * CLASS_HEIGHT;
        const struct rr_class_row *row = &order->rows[i];
        write_text(c, 12, y + 16, table->items[row->class_index].name, BLACK);
        draw_bar(c, y + 4, &row->measured, MEASURED);
        draw_bar(c, y + 8 + BAR_HEIGHT, &row->simulated, SIMULATED);
    }
}

int rr_class_order_plot(const struct rr_class_order *order, const struct db_class_table *table,
                        const char *path)
{
    struct canvas c = {.height = TOP + order->count * CLASS_HEIGHT + 46};
    c.pixels = malloc(WIDTH * (size_t)c.height * sizeof *c.pixels);
    if (!c.pixels) {
        return hs_error(path, NULL, "out of memory");
    }
    draw(&c, order, table);
    const int status = hs_png_write_xrgb(path, c.pixels, WIDTH, c.height, WIDTH);
    free(c.pixels);
    return status;
}
