/* What overlay.c, symbols.c and test_pattern.c share. */
#ifndef LM_OVERLAY_INTERNAL_H
#define LM_OVERLAY_INTERNAL_H

#include "lm/draw.h"
#include "lm/overlay.h"

static inline struct lm_pen lm_symbol_pen(const struct lm_glass *g)
{
    return lm_pen_for(&g->surface, g->palette->symbol);
}

/* Text on ground of its own, so that it can be read over a bright picture. The ground reaches one
 * dot beyond the text on every side. */
void lm_write(const struct lm_pen *pen, int32_t x, int32_t y, const char *words, uint32_t ground);

#endif
