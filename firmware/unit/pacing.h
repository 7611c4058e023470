/* Pacing: how many lines a step draws: those that are due, as far as a step has time for them. */
#ifndef LM_UNIT_PACING_H
#define LM_UNIT_PACING_H

#include "lm/picture.h"

struct lm_paced {
    uint32_t lines;   /* drawn in this step */
    uint32_t dropped; /* 1 if drawing was too late and overdue lines were dropped, else 0 */
    uint32_t left;    /* lines that the step still had time for, 0..LM_STEP_LINES */
};

/* Draw the lines that are due, until lines and traced azimuths together reach LM_STEP_LINES. Draws
 * none unless `may_draw`; tiles are requested in either case. */
struct lm_paced lm_draw_due_lines(struct lm_picture *p, bool may_draw, uint64_t now_us);

#endif
