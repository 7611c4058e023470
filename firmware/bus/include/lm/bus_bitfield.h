/* Bit fields: frames with 29-bit identifiers whose data holds numbers of any number of bits: ARINC
 * 825-style items, those of NMEA 2000, and a project's own. */
#ifndef LM_BUS_BITFIELD_H
#define LM_BUS_BITFIELD_H

#include "lm/bus_event.h"
#include "lm/bus_profile.h"
#include "lm/port.h"

/* True if the frame's identifier is the row's under the row's mask. */
bool lm_bus_bitfield_is_row(const struct lm_bus_row *row, const struct lm_can_frame *frame);

/* Data of a frame, or of a message that was joined of several. */
struct lm_bus_payload {
    const uint8_t *data; /* borrowed */
    uint32_t length;
    uint64_t time_us;
};

/* Read the number that a row describes, from data that are the row's. LM_BUS_VALUE: value, step
 * and time of *event are set. Otherwise *event is unchanged, and the result is
 * - LM_BUS_BAD_LENGTH: the data end before the number does;
 * - LM_BUS_UNUSED: the row's `match` bits do not have its match_value;
 * - LM_BUS_NO_DATA, LM_BUS_NOT_A_NUMBER or LM_BUS_OUT_OF_RANGE, as enum lm_bus_outcome says.
 * Cost: about 60 instructions. */
enum lm_bus_outcome lm_bus_bitfield_read(const struct lm_bus_row *row,
                                         const struct lm_bus_payload *payload,
                                         struct lm_bus_event *event);

#endif
