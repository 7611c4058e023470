/* Acceptance filters for a CAN controller: which identifiers a profile takes. */
#ifndef LM_BUS_FILTERS_H
#define LM_BUS_FILTERS_H

#include "lm/bus_profile.h"
#include "lm/port.h"

/* The most filters of any profile. Below the 512 of a Linux socket. */
enum { LM_BUS_FILTERS_MAX = 2 * LM_BUS_ROWS_MAX + 1 };

/* List the filters of a profile, none twice, and return how many there are:
 *
 * - CANaerospace: for each row its 11-bit identifier, and its 29-bit one on any redundancy channel
 *   below LM_BUS_CHANNELS; and requests of node services.
 * - packed: for each row its identifier and mask.
 *
 * What the decoder takes passes. What passes and is not taken are 29-bit identifiers of channel 0,
 * which lm_bus_take counts as foreign, and channels up to the next power of two. Cost: rows
 * squared; call it when a bus is opened. */
uint32_t lm_bus_filters(const struct lm_bus_profile *profile,
                        struct lm_can_filter filters[LM_BUS_FILTERS_MAX]);

#endif
