/* Bus event: one value of one field, decoded from a frame. Navigation and weather see nothing else
 * of the bus. */
#ifndef LM_BUS_EVENT_H
#define LM_BUS_EVENT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "lm/bus_fields.h"

/* Bytes of a list of nodes. */
enum { LM_BUS_NODE_BYTES = 32 };

struct lm_bus_event {
    int32_t value;    /* in the field's unit: lm_bus_fields[field].unit */
    uint32_t step;    /* resolution of the frame's data type, in the unit of `value`; 0: below 1 */
    uint64_t time_us; /* arrival of the frame; of a DOUBLE, of the first of its two frames */
    uint32_t period_us; /* nominal time between two values of this sender */
    uint16_t stale_ms;  /* a value older than this is flagged */
    uint16_t dead_ms;   /* a value older than this is removed */
    uint8_t field;      /* enum lm_bus_field */
    uint8_t row;        /* row of the profile that decoded the value */
    uint8_t priority;   /* rank among the rows of this field: 0 is preferred */
    uint8_t channel;    /* redundancy channel, below LM_BUS_CHANNELS: 0 is preferred */
    uint8_t node;       /* sender, 1..255; 0: the frame does not tell */
    uint8_t service;    /* CANaerospace service code; of weather and live targets: their number */
    uint8_t code;       /* CANaerospace message code; of these: number of the set of values */
};

/* True if the list of nodes has this one: bit n % 8 of its byte n / 8. NULL has all. */
static inline bool lm_bus_is_heard(const uint8_t nodes[LM_BUS_NODE_BYTES], uint8_t node)
{
    return nodes == NULL || (nodes[node / 8] >> node % 8 & 1) != 0;
}

/* Most events of one frame; a packed frame holds several values. */
enum { LM_BUS_EVENTS = 8 };

#endif
