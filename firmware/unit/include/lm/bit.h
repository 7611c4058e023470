/* The BIT page: what the unit knows about itself, a row of text at a time. */
#ifndef LM_BIT_H
#define LM_BIT_H

#include "lm/text.h"
#include "lm/unit.h"

enum { LM_BIT_ROWS = 21 };

/* Row 0..LM_BIT_ROWS - 1. A number of the unit's counters stands behind each name. */
struct lm_text lm_bit_row(const struct lm_unit *u, uint32_t row);

#endif
