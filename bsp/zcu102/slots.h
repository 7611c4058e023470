/* Slots of the board's flash: which one is flown, and why, on the console and on the BIT page. */
#ifndef ZCU102_SLOTS_H
#define ZCU102_SLOTS_H

#include "board.h"

enum { ZCU102_FLASH_POLLS = 1000000 /* after which a read at the start is given up */ };

/* Choose what is flown (lm/slot_flash.h) and say so on the console. `scratch` is borrowed for the
 * call. */
void zcu102_choose_slot(struct zcu102 *z, void *scratch, uint32_t scratch_bytes);

/* Hand the same to the unit's BIT page. After lm_unit_init. */
void zcu102_show_slots(struct zcu102 *z);

#endif
