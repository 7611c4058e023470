/* Further images: the files that the options database.2 and on name, flown beside the database.
 * They come and go as the files do, in flight too:
 *
 *     EMPTY --a file is there, and stands still--> it is judged --> COMES --the unit opens it--+
 *       ^                                                                                      |
 *       +-- closed -- GONE <--nothing reads it-- GOES <--the file is gone, or another-- FLOWN <+
 *
 * A thread looks once a second, judges and closes; the loop tells the unit. A place belongs to the
 * thread while it is EMPTY or GONE, and to the loop otherwise; `state` hands it over. */
#ifndef PANEL_FURTHER_H
#define PANEL_FURTHER_H

#include <pthread.h>
#include <semaphore.h>
#include <stdatomic.h>
#include <sys/types.h>

#include "config.h"
#include "database.h"
#include "drv/flash_file.h"
#include "drv/flash_joined.h"
#include "lm/unit.h"

enum { FURTHER_PLACES = LM_IMAGES_MAX - 1, FURTHER_LOOK_MS = 1000 };

enum further_state {
    FURTHER_EMPTY,
    FURTHER_COMES,
    FURTHER_FLOWN, /* or told to the unit, which refused it */
    FURTHER_GOES,
    FURTHER_GONE,
    FURTHER_STAYS /* the unit has no other image */
};

/* What tells that a file is another one, or was written to. All zero: there is none. */
struct further_mark {
    dev_t device;
    ino_t inode;
    off_t bytes;
    int64_t changed_ns;
};

struct further_place {
    atomic_int state; /* enum further_state */
    struct drv_flash_file file;
    uint32_t crc;     /* record_image_crc */
    bool is_unsigned; /* struct database */
    bool is_told;     /* the loop's: the unit knows that it comes or goes */
    struct further_mark opened, seen, refused; /* the thread's */
};

struct further {
    const struct config *config; /* borrowed */
    struct further_place place[FURTHER_PLACES];
    struct drv_flash_joined joined; /* of the database and these */
    atomic_uint look_ms;            /* time between looks */
    pthread_t thread;
    bool is_joined, has_thread;
    sem_t stop;
    atomic_bool is_over;
};

/* Open the files that are there behind the database, whose flash is `first`, and fill LM_IMAGES_MAX
 * `parts` with where they lie. One that cannot be opened, or is refused as database_judge refuses,
 * is reported and left out; *verdict says UNSIGNED if one of them is. Returns `first` if none is
 * named. *f must not move. */
const struct lm_flash *further_join(struct further *f, const struct config *config,
                                    const struct lm_flash *first, struct lm_flash_part *parts,
                                    struct database *verdict);

/* Report what the unit made of them, at the start. */
void further_report(const struct further *f, const struct lm_unit *unit);

/* Start to look. Without a thread, which is reported, they stay as they are. */
void further_start(struct further *f);

/* True with a control if the unit has to be told of one. It then reads the flash, and waits. */
bool further_next(struct further *f, struct lm_control *control);

/* Behind each step: report what came, and let go what went. */
void further_settle(struct further *f, const struct lm_unit *unit);

/* Stop to look; and close the files, when nothing reads them. Safe on all zero. */
void further_stop(struct further *f);
void further_close(struct further *f);

#endif
