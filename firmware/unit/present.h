/* Presentation: the glass: the radar picture with its symbols, or a page of text, and the
 * labels. */
#ifndef LM_UNIT_PRESENT_H
#define LM_UNIT_PRESENT_H

#include "lm/unit.h"

/* Compose a part of the frame that is due, and show the glass when it is complete. If the display
 * lends no surface, the next step tries again. `lines_left` is how many lines the step still has
 * time for, of LM_STEP_LINES: where it is 0 nothing is composed, unless the frame has taken
 * LM_FRAME_STEPS. Writes only the unit's composer, counters and next_frame_us. */
void lm_show_frame(struct lm_unit *u, uint32_t lines_left, uint64_t now_us);

/* Compose at most `pixels` of the glass on the composer's surface. True if the surface is complete:
 * it then shows what the unit shows now. */
bool lm_compose_glass(const struct lm_unit *u, struct lm_composer *c, uint32_t pixels);

#endif
