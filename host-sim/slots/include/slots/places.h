/* What a panel's configuration says of its slots, and of who may sign what is in them. */
#ifndef SLOTS_PLACES_H
#define SLOTS_PLACES_H

#include <stdbool.h>

enum { SLOT_PATH_BYTES = 128 };

#define SLOT_CONFIG "/etc/landmass-panel.conf"
#define SLOT_A      "/var/lib/landmass-panel/slot-a.lmdb"
#define SLOT_B      "/var/lib/landmass-panel/slot-b.lmdb"

#define SLOT_PROGRESS "/run/landmass-panel/load"
#define SLOT_SERIAL   "/var/lib/landmass-panel/serial"

struct slot_places {
    char path[2][SLOT_PATH_BYTES];
    char key[SLOT_PATH_BYTES], serial[SLOT_PATH_BYTES]; /* database.key, .serial; empty: none */
    char progress[SLOT_PATH_BYTES]; /* slot.progress: slots/progress.h; empty: none */
    bool is_any, is_older;          /* database.trust = any, database.older = fly */
};

/* The options slot.* and database.* of a panel's configuration; other lines are passed
 * over. Without the file at SLOT_CONFIG all are the defaults. Returns 0, or -1 with the error
 * reported: another file cannot be read, a path is too long, or a slot is `none`. */
int slot_places_read(struct slot_places *places, const char *config);

#endif
