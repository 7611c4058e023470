/* BIT page: the built-in test's versions, counters and faults, as rows of text. */
#ifndef LM_BIT_H
#define LM_BIT_H

#include "lm/text.h"
#include "lm/unit.h"

enum { LM_BIT_ROWS = 22 };

/* The text of a row, 0..LM_BIT_ROWS - 1; it may be empty:
 *
 *     0..2    version, title and size of the image
 *     3..15   counters, two in a row, each a name and its number; the last is where the radar table
 *             in use comes from, and its name
 *     16      flags that are raised now
 *     17..20  the faults that rose last, the latest first
 *     21      cause of the board's last restart
 */
struct lm_text lm_bit_row(const struct lm_unit *u, uint32_t row);

#endif
