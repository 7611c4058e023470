/* Following: view and cursor move with the aircraft, and the range scale with the cursor. */
#ifndef LM_UNIT_FOLLOW_H
#define LM_UNIT_FOLLOW_H

#include "lm/unit.h"

/* Update view and cursor, and the range scale while it is automatic. Begins a window that waited
 * for the cursor to be placed. */
void lm_follow_cursor(struct lm_unit *u, uint64_t now_us);

/* Elevation of the map at a position, in metres * 1024 above mean sea level, or LM_NO_ELEVATION. A
 * tile that is missing is requested. */
int32_t lm_elevation_at(struct lm_unit *u, struct lm_position position);

#endif
