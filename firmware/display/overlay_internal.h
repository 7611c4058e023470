/* Overlay internals: what overlay.c, symbols.c and test_pattern.c share. */
#ifndef LM_OVERLAY_INTERNAL_H
#define LM_OVERLAY_INTERNAL_H

#include "lm/draw.h"
#include "lm/overlay.h"

/* Dots from the glass's top to the row of numbers below the upper labels, and to what is below that
 * row. On some glasses the row reaches into the frame by a dot or two. */
enum { LM_TOP_ROW_DOTS = 20, LM_BELOW_TOP_ROW_DOTS = LM_TOP_ROW_DOTS + 9 };

/* A pen for all of the glass. */
static inline struct lm_pen lm_glass_pen(const struct lm_glass *g, uint32_t colour)
{
    struct lm_pen pen = lm_pen_for(&g->surface, colour);
    pen.list = g->list;
    return pen;
}

/* The pen of symbols and text. */
static inline struct lm_pen lm_symbol_pen(const struct lm_glass *g)
{
    return lm_glass_pen(g, g->palette->symbol);
}

/* Write text on a ground of colour `ground`, which makes it legible over a bright picture. The
 * ground reaches one dot beyond the text on every side. */
void lm_write(const struct lm_pen *pen, int32_t x, int32_t y, const char *words, uint32_t ground);

#endif
