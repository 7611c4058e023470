/* Clock: the exercise's time for the displays, frames 1820 and 1821 (docs/bus.md, "Exercise
 * clock"). It begins at 0 when the run begins, stands between a Stop/Freeze and a Start/Resume PDU,
 * and is told once a second and when it stops or goes on. */
#ifndef DIS_CLOCK_H
#define DIS_CLOCK_H

#include "lm/port.h"

enum { DIS_CLOCK_FRAMES = 2, DIS_ID_EXERCISE_TIME = 1820, DIS_ID_EXERCISE_RATE = 1821 };

struct dis_clock {
    int64_t exercise_us; /* shown at `from_us` */
    int64_t from_us, told_us;
    bool has_begun, is_standing, is_due;
    uint8_t code; /* of the next frames */
};

/* Starts as zeros. Stop it at `now_us`, or let it go on. */
void dis_clock_set(struct dis_clock *c, bool is_standing, int64_t now_us);

/* What is to be told at `now_us`, the rate first: returns 0 or DIS_CLOCK_FRAMES. */
int dis_clock_frames(struct dis_clock *c, uint8_t node, int64_t now_us,
                     struct lm_can_frame frames[DIS_CLOCK_FRAMES]);

#endif
