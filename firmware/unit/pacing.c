#include "pacing.h"

enum {
    AZIMUTHS_A_STEP = 4, /* traced for a sector; a line that needs more waits for the next step */
    LATE_MOST_US = 50000
};

/* True if lines may be drawn now. Time spent in any other state creates no backlog. */
static bool is_drawing(struct lm_picture *p, bool may_draw, uint64_t now_us)
{
    return may_draw && lm_picture_is_ready(p, now_us);
}

/* Limit the backlog: if drawing is more than LATE_MOST_US late, drop the overdue lines and continue
 * from now. Returns 1 if lines were dropped, else 0. */
static uint32_t drop_overdue_lines(struct lm_picture *p, bool may_draw, uint64_t now_us)
{
    const bool is_late = is_drawing(p, may_draw, now_us);
    if (is_late && p->next_line_us + LATE_MOST_US > now_us) {
        return 0;
    }
    p->next_line_us = now_us;
    return is_late;
}

struct lm_paced lm_draw_due_lines(struct lm_picture *p, bool may_draw, uint64_t now_us)
{
    /* Tracing an azimuth costs as much as drawing a line. */
    uint32_t azimuths = AZIMUTHS_A_STEP;
    struct lm_paced paced = {0};
    lm_picture_prefetch(p);
    while (paced.lines + AZIMUTHS_A_STEP - azimuths < LM_STEP_LINES &&
           is_drawing(p, may_draw, now_us) && p->next_line_us <= now_us &&
           lm_picture_draw_line(p, now_us, &azimuths)) {
        paced.lines++;
    }
    if (p->next_line_us <= now_us) {
        paced.dropped = drop_overdue_lines(p, may_draw, now_us);
    }
    return paced;
}
