/* Slots of a panel: two places for a database image, of which one is flown while the other is
 * written (lm/slot.h). A slot is
 *
 * - a file, with its records in a second file "PATH.state",
 * - a block device, with its records in its last 128 KiB,
 * - an MTD device, with its records in its last two good blocks. Bad blocks are stepped over,
 * - the contents of a flash chip in a file of its length, laid out as a block device.
 *
 * The image begins at the start of each, so that every program that reads images can read it there.
 *
 * Usage: slot_open both, slot_judge both, slot_choose; slot_close. */
#ifndef SLOTS_SLOT_H
#define SLOTS_SLOT_H

#include <stdbool.h>
#include <stdint.h>

#include "lm/port.h"
#include "slots/check.h"
#include "slots/medium.h"

enum slot_verdict {
    SLOT_ABSENT,  /* no such file, or it cannot be opened */
    SLOT_EMPTY,   /* no record says that anything is there */
    SLOT_CUT_OFF, /* a load has begun and has not come to its end */
    SLOT_DAMAGED, /* its record says that it is whole, and it is not */
    SLOT_WHOLE
};

struct slot {
    const char *path; /* borrowed */
    struct slot_medium medium;
    bool is_open;
    int fd;                       /* to lock; -1: none */
    struct lm_slot_record record; /* zero, if none is sound */
    enum slot_verdict verdict;
    struct slot_fault fault; /* of one that is absent or damaged */
    struct lm_flash port;    /* the image, as the firmware reads it */
    int last_status;         /* of the port */
};

enum slot_use { SLOT_TO_READ, SLOT_TO_WRITE };

/* Open a slot. To write, a file is made if it is not there. Returns 0 or an errno; the slot is then
 * absent, with the cause in fault. *s must not move, and must be closed in any case. */
int slot_open(struct slot *s, const char *path, enum slot_use use);

/* The same of a chip's contents. To write, a file that is shorter is filled up with FFh, which is
 * erased flash. EINVAL: it has another length than chip_bytes. */
int slot_open_chip(struct slot *s, const char *path, uint64_t chip_bytes, enum slot_use use);

/* Use a medium of the caller's. */
void slot_lend(struct slot *s, const char *path, const struct slot_medium *medium);

/* Read the record and check the image to this depth: sets record, verdict, fault and port. */
void slot_judge(struct slot *s, enum slot_depth depth, slot_progress *progress, void *ctx);

/* The one to fly: of the whole ones the later. -1: none. */
int slot_choose(const struct slot slots[LM_SLOTS]);

/* Write both copies of a record, each to the medium before the next. The slot must have been
 * judged. Sets generation and checksum, and keeps it in s->record. Returns 0 or an errno; what
 * counts is then the record before or this one. */
int slot_write_record(struct slot *s, struct lm_slot_record record);

/* The port of an image of this length in the slot. */
void slot_set_port(struct slot *s, uint64_t image_bytes);

/* Locks tell programs apart. Whoever flies a slot holds it shared, whoever writes it alone. Both
 * return 0, EWOULDBLOCK if another program forbids it, or another errno. They last until the slot
 * is closed. */
int slot_lock_to_fly(const struct slot *s);
int slot_lock_to_write(const struct slot *s);

/* Does a program hold a lock on it? */
bool slot_is_in_use(const struct slot *s);

/* One word: "whole", "cut off". */
const char *slot_word(enum slot_verdict verdict);

void slot_close(struct slot *s);

#endif
