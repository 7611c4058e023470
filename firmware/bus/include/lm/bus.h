/* Bus decoder: CAN frames in, events out, by the profile that the bus follows.
 *
 *     struct lm_bus bus;
 *     lm_bus_init(&bus, &lm_bus_canas17);
 *     struct lm_bus_event events[LM_BUS_EVENTS];
 *     const uint32_t count = lm_bus_take(&bus, &frame, events);
 *     for (uint32_t i = 0; i < count; i++) {
 *         lm_nav_take(&nav, &events[i]);
 *     }
 */
#ifndef LM_BUS_H
#define LM_BUS_H

#include "lm/canas.h"

/* State of a decoder; the caller owns it. Counters only ever grow. */
struct lm_bus {
    const struct lm_bus_profile *profile; /* borrowed */
    struct lm_canas canas;                /* used by framing LM_BUS_CANAEROSPACE alone */
    struct {
        uint32_t frames; /* offered to lm_bus_take, of every kind */
        /* CANaerospace: one outcome for each frame. Packed: one for each number of a frame, or
         * LM_BUS_UNUSED for a frame that no row takes. */
        uint32_t outcome[LM_BUS_OUTCOMES];
    } count;
};

/* Begin with nothing heard. `profile` must outlive *b. */
void lm_bus_init(struct lm_bus *b, const struct lm_bus_profile *profile);

/* Decode a frame. Returns how many events were filled, 0..LM_BUS_EVENTS; mostly 0 or 1. Events
 * beyond that number are unspecified. Any contents of *frame are safe; what cannot be believed is
 * counted by its outcome and gives no event. Cost: 350 instructions for a value of CANaerospace
 * (x86-64, gcc -O2, counted). */
uint32_t lm_bus_take(struct lm_bus *b, const struct lm_can_frame *frame,
                     struct lm_bus_event events[LM_BUS_EVENTS]);

#endif
