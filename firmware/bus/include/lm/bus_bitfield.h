/* Bit fields of packed frames: data frames with 29-bit identifiers that hold numbers of any length
 * at any bit, such as ARINC 825 items and single-frame items of NMEA 2000. */
#ifndef LM_BUS_BITFIELD_H
#define LM_BUS_BITFIELD_H

#include "lm/bus_event.h"
#include "lm/bus_profile.h"
#include "lm/port.h"

/* True when the frame's identifier is one of the row's: 29 bits, equal under the row's mask. */
bool lm_bus_bitfield_is_row(const struct lm_bus_row *row, const struct lm_can_frame *frame);

/* Read the number that a row describes from a frame for which lm_bus_bitfield_is_row is true.
 * Returns LM_BUS_VALUE and fills value, step and time_us of *event. Otherwise *event is left alone
 * and the answer is
 *
 * - LM_BUS_BAD_LENGTH: the frame ends before the number does
 * - LM_BUS_UNUSED: the bits of the row's condition are not its match_value
 * - LM_BUS_NO_DATA: the number is the row's code for "not available"
 * - LM_BUS_NOT_A_NUMBER: NaN or an infinity
 * - LM_BUS_OUT_OF_RANGE: outside of low..high of the row
 *
 * Cost: about 60 instructions. */
enum lm_bus_outcome lm_bus_bitfield_read(const struct lm_bus_row *row,
                                         const struct lm_can_frame *frame,
                                         struct lm_bus_event *event);

#endif
