/* Where the slots of a panel are: its configuration names them, or nobody does. */
#ifndef SLOTS_PLACES_H
#define SLOTS_PLACES_H

enum { SLOT_PATH_BYTES = 128 };

#define SLOT_CONFIG "/etc/landmass-panel.conf"
#define SLOT_A      "/var/lib/landmass-panel/slot-a.lmdb"
#define SLOT_B      "/var/lib/landmass-panel/slot-b.lmdb"

struct slot_places {
    char path[2][SLOT_PATH_BYTES];
};

/* The options slot.a and slot.b of a panel's configuration; other lines are passed over. Without
 * the file at SLOT_CONFIG both are the defaults. Returns 0, or -1 with the error reported: another
 * file cannot be read, a path is too long, or a slot is `none`. */
int slot_places_read(struct slot_places *places, const char *config);

#endif
