/* Overlay internals: what overlay.c, symbols.c and test_pattern.c share. */
#ifndef LM_OVERLAY_INTERNAL_H
#define LM_OVERLAY_INTERNAL_H

#include "lm/draw.h"
#include "lm/overlay.h"

/* The pen of symbols and text. */
static inline struct lm_pen lm_symbol_pen(const struct lm_glass *g)
{
    return lm_pen_for(&g->surface, g->palette->symbol);
}

/* Write text on a ground of colour `ground`, which makes it legible over a bright picture. The
 * ground reaches one dot beyond the text on every side. */
void lm_write(const struct lm_pen *pen, int32_t x, int32_t y, const char *words, uint32_t ground);

#endif
