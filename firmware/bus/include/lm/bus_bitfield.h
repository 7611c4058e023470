/* Frames of 29-bit identifiers whose data is packed with numbers of any length: ARINC 825-style
 * items, single-frame items of NMEA 2000, and what a project made up for itself. */
#ifndef LM_BUS_BITFIELD_H
#define LM_BUS_BITFIELD_H

#include "lm/bus_event.h"
#include "lm/bus_profile.h"
#include "lm/port.h"

/* Is the frame this row's, by identifier? */
bool lm_bus_bitfield_is_row(const struct lm_bus_row *row, const struct lm_can_frame *frame);

/* The number that the row describes, of a frame that is the row's. *event gets value, step and time
 * for LM_BUS_VALUE and is left alone otherwise: LM_BUS_BAD_LENGTH when the frame ends before the
 * number does, LM_BUS_UNUSED when the row's condition is not met, LM_BUS_NO_DATA,
 * LM_BUS_NOT_A_NUMBER or LM_BUS_OUT_OF_RANGE. Cost: about 60 instructions. */
enum lm_bus_outcome lm_bus_bitfield_read(const struct lm_bus_row *row,
                                         const struct lm_can_frame *frame,
                                         struct lm_bus_event *event);

#endif
