/* Following: view and cursor move with the aircraft, and the range scale with the cursor. */
#ifndef LM_UNIT_FOLLOW_H
#define LM_UNIT_FOLLOW_H

#include "lm/unit.h"

/* Update view and cursor, and the range scale while it is automatic. Begins a window that waited
 * for the cursor to be placed. */
void lm_follow_cursor(struct lm_unit *u, uint64_t now_us);

#endif
