/* Sheets and charts: a picture to draw figures on, and axes with curves on it. Coordinates are
 * pixels from the upper left corner; what falls outside the sheet is not drawn. */
#ifndef HS_CHART_H
#define HS_CHART_H

#include <stdint.h>

enum { INK_BLACK = 0x000000, INK_GREY = 0xd0d0d0, INK_BLUE = 0x1040c0, INK_RED = 0xc02020 };

struct sheet {
    uint32_t *pixels; /* owned: 0x00RRGGBB */
    int width, height;
};

/* Open a white sheet. Returns 0, or -1 with the error reported (no memory). */
int sheet_open(struct sheet *s, int width, int height);

/* Write the sheet as a PNG and free it. Returns 0, or -1 with the error reported; it is freed
 * either way. */
int sheet_close(struct sheet *s, const char *path);

/* Colour one pixel, or those of a straight line. `ink` is 0x00RRGGBB here and below. */
void sheet_dot(struct sheet *s, int x, int y, uint32_t ink);
void sheet_line(struct sheet *s, double x0, double y0, double x1, double y1, uint32_t ink);

/* Text in capitals and small letters from its upper left corner, in the display's own font. */
void sheet_text(struct sheet *s, int x, int y, const char *text, uint32_t ink);

/* Axes in a rectangle of the sheet, in pixels: x_low..x_high and y_low..y_high in the units of the
 * curve, a grid line each x_step and y_step. Texts are borrowed. */
struct chart {
    struct sheet *sheet; /* borrowed */
    int left, top, width, height;
    double x_low, x_high, x_step, y_low, y_high, y_step;
    const char *title, *x_name;
};

/* Draw the axes, their grid, numbers and names. */
void chart_axes(const struct chart *c);

/* The curve y = f(x), sampled `samples` times and joined; what leaves the rectangle is cut off. */
void chart_curve(const struct chart *c, double (*f)(void *ctx, double x), void *ctx, int samples,
                 uint32_t ink);

/* Draw a dashed vertical line at x. */
void chart_upright(const struct chart *c, double x, uint32_t ink);

#endif
