/* Check of an image, section by section and record by record, by the firmware's own reader. It
 * reads through a flash port, so that it judges what the medium holds. */
#ifndef SLOTS_CHECK_H
#define SLOTS_CHECK_H

#include <stdint.h>

#include "lm/port.h"

/* First thing that is wrong. */
struct slot_fault {
    uint64_t offset; /* bytes from the start of the image */
    char cause[120];
};

/* Told how far the work is; may be NULL. */
typedef void slot_progress(void *ctx, uint64_t done_bytes, uint64_t total_bytes);

enum slot_depth {
    SLOT_TABLES, /* header, directory and all that is small: what a start has time for */
    SLOT_RECORDS /* every section's checksum, every directory entry and every tile record */
};

/* Returns 0, or -1 with the first fault in *fault. Cost: each byte of the image is read twice with
 * SLOT_RECORDS. No byte of the image is trusted. */
int slot_check(const struct lm_flash *flash, enum slot_depth depth, slot_progress *progress,
               void *ctx, struct slot_fault *fault);

#endif
