/* Bus decoder: frames of the avionics bus in, events out, by the bus's profile. */
#ifndef LM_BUS_H
#define LM_BUS_H

#include "lm/canas.h"
#include "lm/fast_packet.h"

/* State of the decoder; the caller owns it. Counters only ever grow. */
struct lm_bus {
    const struct lm_bus_profile *profile; /* borrowed as long as the decoder is used */
    struct lm_canas canas;
    struct lm_fast_packet fast;
    struct {
        uint32_t frames;                   /* given to lm_bus_take */
        uint32_t outcome[LM_BUS_OUTCOMES]; /* of each frame; of each number in a packed frame */
    } count;
};

/* Begin with nothing decoded. `profile` stays borrowed as long as *b is used. */
void lm_bus_init(struct lm_bus *b, const struct lm_bus_profile *profile);

/* Hear only the nodes of a list (lm_bus_is_heard), which stays borrowed; NULL: all. Frames of
 * others are LM_BUS_NODE_REFUSED and leave no trace in the decoder. The node of a packed frame is
 * its channel: in NMEA 2000 the address of its source. A packed profile without channels hears all.
 */
void lm_bus_hear_only(struct lm_bus *b, const uint8_t *nodes);

/* Decode a frame into `events`. Returns how many were filled, 0..LM_BUS_EVENTS; most often 0 or 1.
 * Any contents of *frame are safe; a refused frame is counted by its outcome. Cost: 340
 * instructions for a value of CANaerospace (x86-64, gcc -O2, counted). */
uint32_t lm_bus_take(struct lm_bus *b, const struct lm_can_frame *frame,
                     struct lm_bus_event events[LM_BUS_EVENTS]);

#endif
