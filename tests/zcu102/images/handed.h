/* What the host handed over in memory (scenario.h), as ports that go by a clock of whole steps. */
#ifndef HANDED_H
#define HANDED_H

#include "scenario.h"

struct handed {
    const struct scenario_header *header;
    const struct lm_can_frame *frames;
    const struct scenario_control *controls;
    const struct scenario_picture *pictures;
    uint32_t next_frame, next_control;
    const uint64_t *now_us; /* borrowed */
};

/* False when there is nothing in memory. */
bool handed_open(struct handed *h, const uint64_t *now_us);

/* The next control, or frame, that is due by *now_us: functions of struct lm_controls and lm_can,
 * whose ctx is the struct. */
int handed_next_control(void *handed, struct lm_control *control);
int handed_receive(void *handed, struct lm_can_frame *frame);

#endif
