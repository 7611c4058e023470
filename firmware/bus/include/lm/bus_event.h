/* Bus event: one value of one field, decoded from a frame. This is all that navigation and weather
 * learn of the bus. */
#ifndef LM_BUS_EVENT_H
#define LM_BUS_EVENT_H

#include <stdint.h>

#include "lm/bus_fields.h"

struct lm_bus_event {
    int32_t value;      /* in the field's unit: lm_bus_fields[field].unit */
    uint32_t step;      /* distance of neighbouring values in the data type of the frame, in the
                           unit of `value`; 0: less than 1 */
    uint64_t time_us;   /* of the frame's arrival. For a DOUBLE, which takes two frames: of the
                           first of them */
    uint32_t period_us; /* nominal, between two values of this sender */
    uint16_t stale_ms;  /* a value older than this is flagged */
    uint16_t dead_ms;   /* a value older than this is removed */
    uint8_t field;      /* enum lm_bus_field */
    uint8_t row;        /* of the profile that the value was decoded by */
    uint8_t priority;   /* among the rows of this field: 0 is preferred */
    uint8_t channel;    /* redundancy channel, below LM_BUS_CHANNELS: 0 is preferred */
    uint8_t node;       /* sender, 1..255; 0: the frame does not tell */
    uint8_t service;    /* CANaerospace service code; of weather: which circle or jammer */
    uint8_t code;       /* CANaerospace message code; of weather: which set of values */
};

/* The most events of one frame: a packed frame holds several values. */
enum { LM_BUS_EVENTS = 8 };

#endif
