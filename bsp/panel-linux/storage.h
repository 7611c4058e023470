/* Storage: the database of the panel: the newest slot that is whole (host-sim/slots), or else the
 * file or device that the option `database` names. Why it is which one goes to the journal. */
#ifndef PANEL_STORAGE_H
#define PANEL_STORAGE_H

#include "config.h"
#include "database.h"
#include "drv/flash_file.h"
#include "drv/flash_mtd.h"
#include "lm/controls.h"
#include "slots/slot.h"

struct storage {
    struct slot slots[LM_SLOTS]; /* the one that is flown stays open, and locked */
    struct drv_flash_mtd mtd;    /* of the option `database`, as the file */
    struct drv_flash_file file;
    int flown;           /* number of the slot; -1: none */
    const char *path;    /* of what is flown, for messages; borrowed from the config */
    const char *trouble; /* why it is not what it should be, for the status; NULL: it is */
};

/* Choose, judge the signature (database.h) and open; what a slot has that is not accepted gives way
 * to the other slot. Waits for the medium. `is_check`: no serial number is remembered. Returns the
 * flash, which waits for each read, and what is known of its signature; or NULL with the cause
 * reported, *verdict then says whether there was one that was refused: is_flown is false. *d must
 * not move. */
const struct lm_flash *storage_open(struct storage *d, const struct config *config, bool is_check,
                                    struct database *verdict);
void storage_close(struct storage *d);

/* The slots as they were found at the start. */
struct lm_slots_state storage_state(const struct storage *d);

/* For --check: opens what would be flown, and closes it. False if its signature is refused. */
bool storage_check(const struct config *config);

#endif
