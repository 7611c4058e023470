/* The few marks that every symbol of the page is made of. All clip at the surface's edges. */
#ifndef LM_DRAW_H
#define LM_DRAW_H

#include <stdint.h>

#include "fx/types.h"
#include "lm/port.h"
#include "lm/units.h"

/* Points may lie off the surface, but within LM_DRAW_FAR of its corner each way. */
enum { LM_DRAW_FAR = 8191 };

struct lm_point {
    int32_t x, y; /* pixels; y grows downwards */
};

/* A place between the surface's edges, pixels * 256 from its upper left corner: the middle of pixel
 * (x, y) is at (256 x + 128, 256 y + 128). */
struct lm_spot {
    int32_t x_px_q8, y_px_q8;
};

static inline struct lm_spot lm_pixel_middle(struct lm_point p)
{
    return (struct lm_spot){lm_px_q8_of_px(p.x) + 128, lm_px_q8_of_px(p.y) + 128};
}

/* With what is drawn, and on what. */
struct lm_pen {
    struct lm_surface surface;
    uint32_t colour; /* 0x00RRGGBB */
    int32_t dot_px;  /* size of a dot of the font: text is 7 dots high */
    int32_t line_px; /* width of lines */
};

/* A pen whose text and lines keep their share of the glass from 256 to 1024 pixels: 35 to 69
 * characters across the shorter side. */
struct lm_pen lm_pen_for(const struct lm_surface *surface, uint32_t colour);

void lm_draw_box(const struct lm_pen *pen, int32_t x, int32_t y, int32_t width, int32_t height);
void lm_draw_line(const struct lm_pen *pen, struct lm_point from, struct lm_point to);

/* The pixel at `length` pixels (up to LM_DRAW_FAR) and `azimuth` (from straight up, clockwise) from
 * `from`. */
struct lm_point lm_ray_end(struct lm_spot from, fx_bam_t azimuth, int32_t length);

/* The arc round `centre` from `left` clockwise over `span`, as a chain of chords. */
void lm_draw_arc(const struct lm_pen *pen, struct lm_spot centre, int32_t radius, fx_bam_t left,
                 fx_bam_t span);

/* One line of text; x, y is the upper left corner of its first character. */
void lm_draw_text(const struct lm_pen *pen, int32_t x, int32_t y, const char *words);

/* Width without the gap behind the last character. */
int32_t lm_text_width(const struct lm_pen *pen, const char *words);

/* Distance between the tops of two lines of text, and between two characters. */
static inline int32_t lm_row_px(const struct lm_pen *pen)
{
    return 9 * pen->dot_px;
}

static inline int32_t lm_column_px(const struct lm_pen *pen)
{
    return 6 * pen->dot_px;
}

#endif
