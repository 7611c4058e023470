/* Reading what the glass says, dot by dot. */
#ifndef GLASS_TEXT_H
#define GLASS_TEXT_H

#include "lm/draw.h"

#include <stdbool.h>

/* Where these words stand on the surface, in the size of its text, every dot of them of `colour`
 * and every other dot of their cells of `ground`. False when nowhere; *at may be NULL. */
bool glass_find(const struct lm_surface *s, const char *words, uint32_t colour, uint32_t ground,
                struct lm_point *at);

/* Pixels of a colour. */
uint32_t glass_count(const struct lm_surface *s, uint32_t colour);

#endif
