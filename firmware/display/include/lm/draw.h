/* Drawing: boxes, lines, arcs and text on a surface, of which every symbol is made. Everything is
 * clipped to the pen's clip. A pen with a list notes what it draws (lm/draw_list.h), and the
 * surface is left alone. Nothing here fails. */
#ifndef LM_DRAW_H
#define LM_DRAW_H

#include <stdint.h>

#include "fx/types.h"
#include "lm/damage.h"
#include "lm/port.h"
#include "lm/units.h"

/* Points may lie off the surface, up to LM_DRAW_FAR pixels from its corner in x and in y. */
enum { LM_DRAW_FAR = 8191 };

/* A pixel: x to the right, y down, from the surface's upper left corner. */
struct lm_point {
    int32_t x, y;
};

/* A point with fractions of a pixel: x to the right, y down, from the surface's upper left corner.
 * The middle of pixel (x, y) is at (256 x + 128, 256 y + 128). */
struct lm_spot {
    int32_t x_px_q8, y_px_q8;
};

static inline struct lm_spot lm_pixel_middle(struct lm_point p)
{
    return (struct lm_spot){lm_px_q8_of_px(p.x) + 128, lm_px_q8_of_px(p.y) + 128};
}

struct lm_draw_list;

/* Pen: surface, clip, colour and sizes of what is drawn. */
struct lm_pen {
    struct lm_surface surface;      /* its pixels are borrowed */
    struct lm_rectangle clip;       /* the pixels that may be touched; within the surface */
    uint32_t colour;                /* 0x00RRGGBB */
    int32_t dot_px;                 /* size of a dot of the font: characters are 5 by 7 dots */
    int32_t line_px;                /* width of lines */
    struct lm_draw_list *list;      /* borrowed: what notes everything instead; or NULL */
    const struct lm_damage *within; /* borrowed: only its blocks are touched; NULL: all are */
};

/* The pen for a surface of 256 to 1024 pixels a side, all of which is its clip. It has no list.
 * Text and lines grow with the surface: its shorter side holds 35 to 69 characters. */
struct lm_pen lm_pen_for(const struct lm_surface *surface, uint32_t colour);

/* Fill the box whose upper left pixel is (x, y). */
void lm_draw_box(const struct lm_pen *pen, int32_t x, int32_t y, int32_t width, int32_t height);

/* Draw a line, both ends included. */
void lm_draw_line(const struct lm_pen *pen, struct lm_point from, struct lm_point to);

/* The pixels that a line may touch. */
static inline struct lm_rectangle lm_line_bounds(const struct lm_pen *pen, struct lm_point from,
                                                 struct lm_point to)
{
    return (struct lm_rectangle){.left = from.x < to.x ? from.x : to.x,
                                 .top = from.y < to.y ? from.y : to.y,
                                 .right = (from.x < to.x ? to.x : from.x) + pen->line_px,
                                 .bottom = (from.y < to.y ? to.y : from.y) + pen->line_px};
}

/* The pixel `length` pixels (0..LM_DRAW_FAR) away from `from`, at `azimuth` clockwise from straight
 * up. */
struct lm_point lm_ray_end(struct lm_spot from, fx_bam_t azimuth, int32_t length);

/* An arc from azimuth `left` clockwise over `span`. It is drawn as a chain of chords. */
struct lm_arc {
    struct lm_spot centre;
    int32_t radius; /* 0..LM_DRAW_FAR pixels */
    fx_bam_t left, span;
};

enum { LM_ARC_CHORDS = 48 };

/* The end of an arc's chord 1..LM_ARC_CHORDS; 0: where the arc begins. */
struct lm_point lm_arc_end(const struct lm_arc *arc, uint32_t chord);

void lm_draw_arc(const struct lm_pen *pen, const struct lm_arc *arc);

/* Draw a line of text; (x, y) is the upper left corner of its first character. `words` ends with a
 * zero; lm/font.h lists the characters. */
void lm_draw_text(const struct lm_pen *pen, int32_t x, int32_t y, const char *words);

/* The same with a pen that has no list. */
void lm_draw_glyphs(const struct lm_pen *pen, int32_t x, int32_t y, const char *words);

/* Width of a text in pixels, without the gap behind its last character. */
int32_t lm_text_width(const struct lm_pen *pen, const char *words);

/* Pixels from the top of a row of text to the top of the next. */
static inline int32_t lm_row_px(const struct lm_pen *pen)
{
    return 9 * pen->dot_px;
}

/* Pixels from the left edge of a character to that of the next. */
static inline int32_t lm_column_px(const struct lm_pen *pen)
{
    return 6 * pen->dot_px;
}

#endif
