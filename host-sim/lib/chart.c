#include "hs/chart.h"

#include "hs/error.h"
#include "hs/png.h"
#include "lm/font.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    SCALE = 2,
    LETTER_STEP = (LM_FONT_WIDTH + 1) * SCALE,
    LETTER_HEIGHT = LM_FONT_HEIGHT * SCALE
};

int sheet_open(struct sheet *s, int width, int height)
{
    const size_t count = (size_t)width * (size_t)height;
    *s = (struct sheet){malloc(count * sizeof *s->pixels), width, height};
    if (!s->pixels) {
        return hs_error("figure", NULL, "out of memory");
    }
    memset(s->pixels, 0xff, count * sizeof *s->pixels);
    return 0;
}

int sheet_close(struct sheet *s, const char *path)
{
    const int result = hs_png_write_xrgb(path, s->pixels, s->width, s->height, (size_t)s->width);
    free(s->pixels);
    *s = (struct sheet){0};
    return result;
}

void sheet_dot(struct sheet *s, int x, int y, uint32_t ink)
{
    if (x >= 0 && x < s->width && y >= 0 && y < s->height) {
        s->pixels[y * s->width + x] = ink;
    }
}

void sheet_line(struct sheet *s, double x0, double y0, double x1, double y1, uint32_t ink)
{
    const int steps = (int)fmax(fabs(x1 - x0), fabs(y1 - y0)) + 1;
    for (int i = 0; i <= steps; i++) {
        sheet_dot(s, (int)lround(x0 + (x1 - x0) * i / steps),
                  (int)lround(y0 + (y1 - y0) * i / steps), ink);
    }
}

void sheet_text(struct sheet *s, int x, int y, const char *text, uint32_t ink)
{
    for (; *text; text++, x += LETTER_STEP) {
        const uint8_t *glyph = lm_font_glyph(*text);
        for (int row = 0; row < LETTER_HEIGHT; row++) {
            for (int column = 0; column < LM_FONT_WIDTH * SCALE; column++) {
                if (glyph[row / SCALE] >> (LM_FONT_WIDTH - 1 - column / SCALE) & 1) {
                    sheet_dot(s, x + column, y + row, ink);
                }
            }
        }
    }
}

static int text_width(const char *text)
{
    return (int)strlen(text) * LETTER_STEP;
}

static double x_of(const struct chart *c, double x)
{
    return c->left + c->width * (x - c->x_low) / (c->x_high - c->x_low);
}

static double y_of(const struct chart *c, double y)
{
    return c->top + c->height * (c->y_high - y) / (c->y_high - c->y_low);
}

void chart_axes(const struct chart *c)
{
    const int bottom = c->top + c->height, right = c->left + c->width;
    char text[32];
    for (double x = c->x_low; x <= c->x_high + c->x_step / 1e3; x += c->x_step) {
        const double at = x_of(c, x);
        snprintf(text, sizeof text, "%.6g", fabs(x) < c->x_step / 1e3 ? 0 : x);
        sheet_line(c->sheet, at, c->top, at, bottom, INK_GREY);
        sheet_text(c->sheet, (int)at - text_width(text) / 2, bottom + 6, text, INK_BLACK);
    }
    for (double y = c->y_low; y <= c->y_high + c->y_step / 1e3; y += c->y_step) {
        const double at = y_of(c, y);
        snprintf(text, sizeof text, "%g", y);
        sheet_line(c->sheet, c->left, at, right, at, INK_GREY);
        sheet_text(c->sheet, c->left - text_width(text) - 6, (int)at - LETTER_HEIGHT / 2, text,
                   INK_BLACK);
    }
    sheet_line(c->sheet, c->left, c->top, c->left, bottom, INK_BLACK);
    sheet_line(c->sheet, c->left, bottom, right, bottom, INK_BLACK);
    sheet_text(c->sheet, c->left, c->top - LETTER_HEIGHT - 8, c->title, INK_BLACK);
    sheet_text(c->sheet, right - text_width(c->x_name), bottom + LETTER_HEIGHT + 12, c->x_name,
               INK_BLACK);
}

static double clipped(const struct chart *c, double y)
{
    return fmin(fmax(y, c->y_low), c->y_high);
}

void chart_curve(const struct chart *c, double (*f)(void *ctx, double x), void *ctx, int samples,
                 uint32_t ink)
{
    double last_x = c->x_low, last_y = f(ctx, c->x_low);
    for (int i = 1; i < samples; i++) {
        const double x = c->x_low + (c->x_high - c->x_low) * i / (samples - 1), y = f(ctx, x);
        const int is_off =
            (y < c->y_low && last_y < c->y_low) || (y > c->y_high && last_y > c->y_high);
        if (!is_off) {
            const double from = y_of(c, clipped(c, last_y)), to = y_of(c, clipped(c, y));
            sheet_line(c->sheet, x_of(c, last_x), from, x_of(c, x), to, ink);
            sheet_line(c->sheet, x_of(c, last_x), from + 1, x_of(c, x), to + 1, ink);
        }
        last_x = x;
        last_y = y;
    }
}

void chart_upright(const struct chart *c, double x, uint32_t ink)
{
    if (x < c->x_low || x > c->x_high) {
        return;
    }
    for (int y = c->top; y < c->top + c->height; y++) {
        if (y / 6 % 2 == 0) {
            sheet_dot(c->sheet, (int)lround(x_of(c, x)), y, ink);
        }
    }
}
