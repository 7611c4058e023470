/* Acceptance filters of a CAN controller for the identifiers of a profile. */
#ifndef LM_BUS_FILTERS_H
#define LM_BUS_FILTERS_H

#include <stdbool.h>

#include "lm/bus_profile.h"
#include "lm/canas_control.h"
#include "lm/port.h"

/* What two displays tell each other (lm/swap.h). */
enum { LM_BUS_SWAP_ID = 1570 };

/* Most filters of any profile. It is below the 512 of a Linux socket. */
enum { LM_BUS_FILTERS_MAX = 2 * LM_BUS_ROWS_MAX + LM_CONTROL_ITEMS + 1 };

/* Write the filters of a profile, none of them twice, and return how many there are:
 *
 * - CANaerospace: for each row its 11-bit identifier, and its 29-bit one on any redundancy channel
 *   below LM_BUS_CHANNELS; requests of node services, control frames (lm/canas_control.h), and
 *   those of a partner, LM_BUS_SWAP_ID.
 * - packed: for each row its identifier and mask.
 *
 * All frames that the decoder takes pass. Two kinds of frames pass and are not taken: 29-bit
 * identifiers of channel 0, which lm_bus_take counts as foreign, and channels from LM_BUS_CHANNELS
 * up to the next power of two. Cost: grows with the square of the rows; call it when a bus is
 * opened. */
uint32_t lm_bus_filters(const struct lm_bus_profile *profile,
                        struct lm_can_filter filters[LM_BUS_FILTERS_MAX]);

/* True if a frame could be taken by both profiles. They must then not be heard on one interface:
 * its value would count twice, or as two things. *id, which may be NULL, is then an identifier that
 * both take. Requests of node services and controls, which every CANaerospace has, do not count.
 * Cost: as above. */
bool lm_bus_profiles_clash(const struct lm_bus_profile *a, const struct lm_bus_profile *b,
                           uint32_t *id);

#endif
