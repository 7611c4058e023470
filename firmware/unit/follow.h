/* What follows the aircraft and the cursor from step to step. */
#ifndef LM_UNIT_FOLLOW_H
#define LM_UNIT_FOLLOW_H

#include "lm/unit.h"

/* Move view and cursor on, and the range where it follows the cursor. A window that waits for the
 * cursor begins once that is placed. */
void lm_follow_cursor(struct lm_unit *u, uint64_t now_us);

#endif
