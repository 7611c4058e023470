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

/* Lines that the step still has time for. Tracing an azimuth costs as much as drawing a line. */
static uint32_t lines_left(const struct lm_paced *paced, uint32_t azimuths)
{
    const uint32_t spent = paced->lines + AZIMUTHS_A_STEP - azimuths;
    return spent < LM_STEP_LINES ? LM_STEP_LINES - spent : 0;
}

struct lm_paced lm_draw_due_lines(struct lm_picture *p, bool may_draw, uint64_t now_us)
{
    uint32_t azimuths = AZIMUTHS_A_STEP;
    struct lm_paced paced = {0};
    lm_picture_prefetch(p);
    while (lines_left(&paced, azimuths) > 0 && is_drawing(p, may_draw, now_us) &&
           p->next_line_us <= now_us && lm_picture_draw_line(p, now_us, &azimuths)) {
        paced.lines++;
    }
    paced.left = p->is_step_spent ? 0 : lines_left(&paced, azimuths);
    p->is_step_spent = false;
    if (p->next_line_us <= now_us) {
        paced.dropped = drop_overdue_lines(p, may_draw, now_us);
    }
    return paced;
}
