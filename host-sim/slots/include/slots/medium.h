/* Medium: what a slot lies on. A file, a block device or an MTD device; in tests a model that
 * loses power.
 *
 * A medium may lose, tear and reorder whatever was written since the last sync that returned 0.
 * Each function returns 0 or an errno. */
#ifndef SLOTS_MEDIUM_H
#define SLOTS_MEDIUM_H

#include <stdbool.h>
#include <stdint.h>

#include "lm/slot.h"

struct slot_medium {
    void *ctx;
    uint32_t unit_bytes; /* an image is written in pieces of this length, the last one shorter */
    uint64_t room_bytes; /* for an image; UINT64_MAX: a file system decides */

    /* Bytes of the image's place. Reading past the end of what is there is EIO. */
    int (*read)(void *ctx, uint64_t offset, void *to, uint32_t length);

    /* Write one piece. EAGAIN: a block has become bad and was taken out of use; what lies behind
     * `offset` has moved, and the load must begin again. */
    int (*write)(void *ctx, uint64_t offset, const void *from, uint32_t length);

    /* A copy of the record. A record that is not there reads as zeros. */
    int (*read_record)(void *ctx, uint32_t copy, struct lm_slot_record *record);
    int (*write_record)(void *ctx, uint32_t copy, const struct lm_slot_record *record);

    /* Make room for an image of this length, neither more nor less. */
    int (*resize)(void *ctx, uint64_t bytes);

    /* Wait until all that was written is on the medium. */
    int (*sync)(void *ctx);

    /* Forget what is cached, so that reads come from the medium where that can be had. */
    void (*forget)(void *ctx);

    void (*close)(void *ctx);
};

#endif
