/* When lines are drawn: as many as are due, and no more than a step has time for. */
#ifndef LM_UNIT_PACING_H
#define LM_UNIT_PACING_H

#include "lm/picture.h"

struct lm_paced {
    uint32_t lines;   /* that were drawn */
    uint32_t dropped; /* times that the picture was so late that it goes on from now */
};

/* Draw the lines whose time has come, at most LM_STEP_LINES with the azimuths traced for them; none
 * unless `may_draw`. Tiles are asked for either way. */
struct lm_paced lm_draw_due_lines(struct lm_picture *p, bool may_draw, uint64_t now_us);

#endif
