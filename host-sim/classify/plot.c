#include "classify/plot.h"

#include "hs/error.h"
#include "hs/png.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    WIDTH = 860,
    HEIGHT = 480,
    LEFT = 70,
    RIGHT = 840,
    TOP = 20,
    BOTTOM = 420,
    GLYPH_WIDTH = 3,
    GLYPH_HEIGHT = 5,
    GLYPH_SCALE = 2,
    GLYPH_STEP = (GLYPH_WIDTH + 1) * GLYPH_SCALE,
};

#define WHITE 0xffffffu
#define BLACK 0x000000u
#define GREY  0xd8d8d8u
#define RED   0xc02020u
#define BLUE  0x2040c0u
#define GREEN 0x208020u

struct canvas {
    uint32_t pixels[WIDTH * HEIGHT];
};

/* Five rows of three bits, the top row in the highest. */
static uint16_t glyph_of(char letter)
{
    static const uint16_t digits[] = {075557, 026227, 071747, 071717, 055711,
                                      074717, 074757, 071111, 075757, 075717};
    static const uint16_t letters[] = {025755, 065656, 034443, 065556, 074747, 074744, 034553,
                                       055755, 072227, 011153, 055655, 044447, 057755, 065555,
                                       025552, 065644, 025563, 065655, 034216, 072222, 055557,
                                       055552, 055775, 055255, 055222, 071247};
    if (letter >= '0' && letter <= '9') {
        return digits[letter - '0'];
    }
    if (letter >= 'A' && letter <= 'Z') {
        return letters[letter - 'A'];
    }
    return letter == '.' ? 000002 : 0;
}

static void dot(struct canvas *c, int x, int y, uint32_t colour)
{
    if (x >= 0 && x < WIDTH && y >= 0 && y < HEIGHT) {
        c->pixels[y * WIDTH + x] = colour;
    }
}

static void write_text(struct canvas *c, int x, int y, const char *text, uint32_t colour)
{
    for (; *text; text++, x += GLYPH_STEP) {
        const uint16_t glyph = glyph_of(*text);
        for (int i = 0; i < GLYPH_WIDTH * GLYPH_HEIGHT * GLYPH_SCALE * GLYPH_SCALE; i++) {
            const int gx = i % (GLYPH_WIDTH * GLYPH_SCALE), gy = i / (GLYPH_WIDTH * GLYPH_SCALE);
            const int bit = 14 - (gy / GLYPH_SCALE * GLYPH_WIDTH + gx / GLYPH_SCALE);
            if (glyph >> bit & 1) {
                dot(c, x + gx, y + gy, colour);
            }
        }
    }
}

static void draw_line(struct canvas *c, double x0, double y0, double x1, double y1, uint32_t colour,
                      int thick)
{
    const int steps = (int)fmax(fabs(x1 - x0), fabs(y1 - y0)) + 1;
    for (int i = 0; i <= steps; i++) {
        const int x = (int)lround(x0 + (x1 - x0) * i / steps);
        const int y = (int)lround(y0 + (y1 - y0) * i / steps);
        for (int d = 0; d < thick; d++) {
            dot(c, x, y + d, colour);
        }
    }
}

/* A single epoch is in the middle. */
static double x_of(double epoch, int epochs)
{
    return LEFT + (RIGHT - LEFT) * (epochs > 1 ? (epoch - 1) / (epochs - 1) : 0.5);
}

static double y_of(double value)
{
    return BOTTOM - (BOTTOM - TOP) * value;
}

static void draw_axes(struct canvas *c, int epochs)
{
    char text[32];
    for (int i = 0; i <= 10; i++) {
        const double y = y_of(i / 10.0);
        draw_line(c, LEFT, y, RIGHT, y, i == 0 ? BLACK : GREY, 1);
        snprintf(text, sizeof text, "%.1f", i / 10.0);
        write_text(c, LEFT - 34, (int)y - GLYPH_HEIGHT, text, BLACK);
    }
    draw_line(c, LEFT, TOP, LEFT, BOTTOM, BLACK, 1);
    /* About eight ticks at a round distance: 1, 2 or 5 times a power of ten. */
    int step = 1;
    for (int i = 0; epochs / step > 8; i++) {
        step = i % 3 == 1 ? step / 2 * 5 : step * 2;
    }
    for (int epoch = step; epoch <= epochs; epoch += step) {
        const int x = (int)x_of(epoch, epochs);
        draw_line(c, x, BOTTOM, x, BOTTOM + 5, BLACK, 1);
        snprintf(text, sizeof text, "%d", epoch);
        write_text(c, x - (int)strlen(text) * GLYPH_STEP / 2, BOTTOM + 10, text, BLACK);
    }
    write_text(c, (LEFT + RIGHT) / 2 - 20, BOTTOM + 24, "EPOCH", BLACK);
}

static double value_of(const struct db_epoch *e, int curve)
{
    return curve == 0 ? e->rms : curve == 1 ? e->recognition : e->validation;
}

/* A mark where the curve ends: of a single epoch it is all there is to see. */
static void draw_end(struct canvas *c, double x, double y, uint32_t colour)
{
    enum { HALF = 3 };
    draw_line(c, x - HALF, y - HALF, x + HALF, y - HALF, colour, 2 * HALF + 1);
}

static void draw_curve(struct canvas *c, const struct db_train_report *r, int curve,
                       uint32_t colour)
{
    for (int i = 0; i < r->epoch_count; i++) {
        const int from = i > 0 ? i - 1 : 0;
        const double a = value_of(&r->epochs[from], curve), b = value_of(&r->epochs[i], curve);
        if (!isnan(a) && !isnan(b)) {
            draw_line(c, x_of(from + 1, r->epoch_count), y_of(fmin(a, 1)),
                      x_of(i + 1, r->epoch_count), y_of(fmin(b, 1)), colour, 2);
        }
        if (i + 1 == r->epoch_count && !isnan(b)) {
            draw_end(c, x_of(i + 1, r->epoch_count), y_of(fmin(b, 1)), colour);
        }
    }
}

static void draw_key(struct canvas *c, bool has_validation)
{
    static const char *const names[] = {"RMS ERROR", "RECOGNITION OF EXEMPLARS",
                                        "RECOGNITION OF VALIDATION"};
    static const uint32_t colours[] = {RED, BLUE, GREEN};
    int x = LEFT;
    for (int i = 0; i < 2 + has_validation; i++) {
        draw_line(c, x, HEIGHT - 11, x + 20, HEIGHT - 11, colours[i], 2);
        write_text(c, x + 26, HEIGHT - 16, names[i], BLACK);
        x += 50 + (int)strlen(names[i]) * GLYPH_STEP;
    }
}

int db_plot_training(const char *path, const struct db_train_report *report)
{
    struct canvas *c = malloc(sizeof *c);
    if (!c) {
        return hs_error(path, NULL, "out of memory");
    }
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        c->pixels[i] = WHITE;
    }
    for (int i = 0; i < report->event_count; i++) {
        const double x = x_of(report->events[i].epoch, report->epoch_count);
        draw_line(c, x, TOP, x, BOTTOM, GREY, 1);
    }
    draw_axes(c, report->epoch_count);
    const bool has_validation = report->epoch_count > 0 && !isnan(report->epochs[0].validation);
    for (int curve = 2; curve >= 0; curve--) {
        static const uint32_t colours[] = {RED, BLUE, GREEN};
        draw_curve(c, report, curve, colours[curve]);
    }
    draw_key(c, has_validation);
    const int result = hs_png_write_xrgb(path, c->pixels, WIDTH, HEIGHT, WIDTH);
    free(c);
    return result;
}
