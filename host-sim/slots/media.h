/* The kinds of media. Each opens `path`, or returns an errno with nothing open; ENOTTY: not of this
 * kind. `*fd` is a descriptor to lock. The medium owns its context. */
#ifndef SLOTS_MEDIA_H
#define SLOTS_MEDIA_H

#include "slots/medium.h"
#include "slots/slot.h"

int slot_medium_mtd(struct slot_medium *m, const char *path, enum slot_use use, int *fd);

/* A file, or a block device; with chip_bytes other than 0 a chip's contents in a file. */
int slot_medium_file(struct slot_medium *m, const char *path, uint64_t chip_bytes,
                     enum slot_use use, int *fd);

#endif
