/* What the glass shows: the radar picture with its symbols, or a page of text, and the labels. */
#ifndef LM_UNIT_PRESENT_H
#define LM_UNIT_PRESENT_H

#include "lm/unit.h"

/* Draw the glass and show it, where the display lends a surface; else again in the next step. Reads
 * the unit and writes only its counters and when the next frame is due. */
void lm_show_frame(struct lm_unit *u, uint64_t now_us);

#endif
