/* Load: an image into a slot that nobody flies.
 *
 *     record "loading" ─> image ─> sync ─> read back and check ─> record "whole"
 *
 * Whatever the moment at which power fails, the slot is whole or is not flown. A load that was cut
 * off is taken up by doing it again: pieces that are there already are compared, not written. */
#ifndef SLOTS_LOAD_H
#define SLOTS_LOAD_H

#include "slots/slot.h"

struct slot_load {
    uint64_t written_bytes, kept_bytes; /* pieces that were written, and those that were there */
    uint32_t bad_blocks;                /* that were taken out of use on the way */
    struct slot_fault fault;            /* where and why it failed */
};

/* Fill the slot with the image behind `source`, which slot_check has passed, and read all of it
 * back. The slot is not flown yet. Returns 0, or -1 with the cause in load->fault. `progress` may
 * be NULL; it runs to the end twice, for writing and for reading back. */
int slot_fill(struct slot *to, const struct lm_flash *source, slot_progress *writing,
              slot_progress *checking, void *ctx, struct slot_load *load);

/* Say that the slot is whole, as the load after `other`: from here on it is the one to fly. Returns
 * 0, or -1 with the cause. */
int slot_switch(struct slot *to, const struct slot *other, struct slot_load *load);

#endif
