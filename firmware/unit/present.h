/* Presentation: the glass: the radar picture with its symbols, or a page of text, and the
 * labels. */
#ifndef LM_UNIT_PRESENT_H
#define LM_UNIT_PRESENT_H

#include "lm/unit.h"

/* Draw the glass and show it, if the display lends a surface; otherwise the next step tries again.
 * Writes only the unit's counters and next_frame_us. */
void lm_show_frame(struct lm_unit *u, uint64_t now_us);

#endif
