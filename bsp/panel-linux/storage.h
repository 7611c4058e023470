/* Storage: the database of the panel: the newest slot that is whole (host-sim/slots), or else the
 * file or device that the option `database` names. Why it is which one goes to the journal. */
#ifndef PANEL_STORAGE_H
#define PANEL_STORAGE_H

#include "config.h"
#include "database.h"
#include "drv/flash_file.h"
#include "drv/flash_joined.h"
#include "drv/flash_mtd.h"
#include "lm/controls.h"
#include "slots/slot.h"

struct storage {
    struct slot slots[LM_SLOTS]; /* the one that is flown stays open, and locked */
    struct drv_flash_mtd mtd;    /* of the option `database`, as the file */
    struct drv_flash_file file;
    struct drv_flash_file further[LM_IMAGES_MAX - 1]; /* of the options database.2 and on */
    const char *further_path[LM_IMAGES_MAX - 1];      /* of those that are open */
    uint32_t further_count;
    struct drv_flash_joined joined; /* of the database and these */
    int flown;                      /* number of the slot; -1: none */
    const char *path;               /* of what is flown, for messages; borrowed from the config */
    const char *trouble; /* why it is not what it should be, for the status; NULL: it is */
};

/* Choose, judge the signature (database.h) and open; what a slot has that is not accepted gives way
 * to the other slot. Waits for the medium. `is_check`: no serial number is remembered. Returns the
 * flash, which waits for each read, and what is known of its signature; or NULL with the cause
 * reported, *verdict then says whether there was one that was refused: is_flown is false. *d must
 * not move. */
const struct lm_flash *storage_open(struct storage *d, const struct config *config, bool is_check,
                                    struct database *verdict);
/* Open the further images behind the database, which is `first`, and fill LM_IMAGES_MAX `parts`
 * with where they lie. One that cannot be opened, or is refused as database_judge refuses, is
 * reported and left out; *verdict says UNSIGNED if one of them is. Returns `first` if there are
 * none. */
const struct lm_flash *storage_join(struct storage *d, const struct config *config, bool is_check,
                                    const struct lm_flash *first, struct lm_flash_part *parts,
                                    struct database *verdict);
void storage_close(struct storage *d);

/* The slots as they were found at the start. */
struct lm_slots_state storage_state(const struct storage *d);

/* For --check: opens what would be flown, and closes it. False if its signature is refused. */
bool storage_check(const struct config *config);

#endif
