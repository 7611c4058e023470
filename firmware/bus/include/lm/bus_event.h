/* Bus event: one value of one field, decoded from a frame. This is all that navigation and weather
 * learn of the bus. */
#ifndef LM_BUS_EVENT_H
#define LM_BUS_EVENT_H

#include <stdint.h>

#include "lm/bus_fields.h"

struct lm_bus_event {
    int32_t value;    /* in the field's unit */
    uint32_t step;    /* between neighbouring values of the type it came in; 0: less than 1 */
    uint8_t row;      /* of the profile */
    uint8_t channel;  /* redundancy channel; the lower is preferred */
    uint8_t node;     /* of the sender; 0 when the frame does not tell, */
    uint8_t service;  /* service code, likewise: of weather, which circle or jammer */
    uint8_t code;     /* message code, likewise: of weather, which set */
    uint64_t time_us; /* of arrival; for a DOUBLE that of the half that came first, when the value
                         existed already */
};

/* The most values that one frame may have: a packed frame has more than one. */
enum { LM_BUS_EVENTS = 8 };

#endif
