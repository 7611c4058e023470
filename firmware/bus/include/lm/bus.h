/* A frame of the bus in, the fields that it carries out, by whatever profile the bus follows. */
#ifndef LM_BUS_H
#define LM_BUS_H

#include "lm/canas.h"

/* What the decoder remembers; the caller owns it. Counters only ever grow. */
struct lm_bus {
    const struct lm_bus_profile *profile; /* borrowed */
    struct lm_canas canas;
    struct {
        uint32_t frames;                   /* all that were offered */
        uint32_t outcome[LM_BUS_OUTCOMES]; /* of each frame, or of each number of a packed one */
    } count;
};

void lm_bus_init(struct lm_bus *b, const struct lm_bus_profile *profile);

/* Decode a frame: the number of events filled, most often 0 or 1. Any contents of *frame are safe.
 * Cost: 340 instructions for a value of CANaerospace (x86-64, gcc -O2, counted). */
uint32_t lm_bus_take(struct lm_bus *b, const struct lm_can_frame *frame,
                     struct lm_bus_event events[LM_BUS_EVENTS]);

#endif
