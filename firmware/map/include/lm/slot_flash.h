/* Slot flash: one flash with two slots (lm/slot.h), for a board that reads it without an operating
 * system. Each half of the flash is a slot, with its records as on a block device (docs/slots.md).
 *
 *     0                        half                       end
 *     | image     |rec 0|rec 1 | image        |rec 0|rec 1 |
 *       slot A                   slot B
 *
 * Usage, at the start: lm_slot_flash_open, then hand f.port to the unit. */
#ifndef LM_SLOT_FLASH_H
#define LM_SLOT_FLASH_H

#include "lm/db.h"
#include "lm/port.h"
#include "lm/slot.h"

enum {
    LM_SLOT_RECORD_STEP = 64 << 10, /* from copy to copy; the second one is so far from the end */
    LM_SLOT_CHECKED_BYTES = 128 << 10, /* of a slot's sections, whose checksums are compared */
    LM_SLOT_SCRATCH_BYTES = 4096       /* at least */
};

/* What is known of a slot. */
enum lm_slot_verdict {
    LM_SLOT_EMPTY,     /* neither copy of its record is sound */
    LM_SLOT_CUT_OFF,   /* a load has not come to its end */
    LM_SLOT_DAMAGED,   /* its record says that it is whole, and it is not */
    LM_SLOT_STANDS_BY, /* its record says that it is whole: not looked at, the other is newer */
    LM_SLOT_FLOWN,
    LM_SLOT_VERDICTS
};

struct lm_slot_flash {
    const struct lm_flash *flash; /* borrowed */
    struct lm_flash port; /* of what is flown; its ctx is this struct, which must not move */
    uint64_t start;       /* of the port, in the flash */
    struct {
        enum lm_slot_verdict verdict;
        uint64_t sequence; /* of the load; 0: none is whole */
    } slot[LM_SLOTS];
};

/* Choose what to fly: of the slots whose records say that they are whole the later, if it verifies;
 * else the other, if it does. A flash whose slot A has no sound record and whose slot B is not
 * flown is one image without slots, as it was before there were any: then no slot is flown, and
 * the port is the whole flash. Otherwise the port has no bytes, and each read of it fails.
 *
 * A slot verifies if the header at its start is the one that its record was written for,
 * lm_db_open accepts it, and the checksums of its sections fit, in the header's order as far as
 * they fit into LM_SLOT_CHECKED_BYTES; longer ones are left out. Tiles, vector detail and directory
 * entries have checksums of their own, which are compared when they are read.
 *
 * `db` and `scratch` (LM_SLOT_SCRATCH_BYTES or more, 8-byte aligned) are borrowed for the call.
 * For start-up only, like lm_db_read. Cost: four reads of 64 bytes, and for each slot that is
 * looked at those of lm_db_open and LM_SLOT_CHECKED_BYTES more at most. */
void lm_slot_flash_open(struct lm_slot_flash *f, const struct lm_flash *flash, struct lm_db *db,
                        void *scratch, uint32_t scratch_bytes, uint32_t poll_limit);

#endif
