/* Slots of the board's flash: which one is flown, and why, on the console and on the BIT page. */
#ifndef ZCU102_SLOTS_H
#define ZCU102_SLOTS_H

#include "board.h"

enum { ZCU102_FLASH_POLLS = 1000000 /* after which a read at the start is given up */ };

/* Choose what is flown (lm/slot_flash.h) and say so on the console. `scratch` is borrowed for the
 * call. */
void zcu102_choose_slot(struct zcu102 *z, void *scratch, uint32_t scratch_bytes);

/* Make z->controls: the first control says the same to the unit's BIT page, and all that follow are
 * the bezel's. So a recording has it. */
void zcu102_tell_slots(struct zcu102 *z);

#endif
