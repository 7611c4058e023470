/* Drill: what a script says of an exercise, as frames beside those of the bench's bus. Only the
 * unit at hand hears them; they go out to no bus. */
#ifndef SIM_DRILL_H
#define SIM_DRILL_H

#include "lm/port.h"
#include "nav/exercise.h"

enum { DRILL_FRAMES = NAV_EXERCISE_FRAMES + 2 * NAV_MALFUNCTIONS };

struct drill {
    const struct nav_exercise *exercise; /* borrowed */
    const struct lm_can *behind;         /* borrowed; its frames come first */
    struct canas_codes codes;
    struct canas_frame frame[DRILL_FRAMES];
    int count, next;
    uint64_t now_us;
    uint32_t clash_id; /* of the first frame behind, of the drill's node, that tells what the drill
                          tells: a clock or malfunctions; 0: none */
    uint64_t clash_us; /* of the step that heard it */
};

/* A port that hears the bus `behind`, then the frames of the drill, and sends to that bus. The
 * port's ctx is `d`, which must not move. */
struct lm_can drill_open(struct drill *d, const struct nav_exercise *exercise,
                         const struct lm_can *behind);

/* Make the frames of the step of `step_us` that begins at `now_us`. Call once before each. */
void drill_advance(struct drill *d, uint64_t now_us, uint64_t step_us);

#endif
