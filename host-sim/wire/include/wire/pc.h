/* The PC's end of a load over a wire: it offers an image and answers what the panel asks.
 *
 * Every byte of the panel is hostile: it is told nothing but pieces of the image that was named. */
#ifndef WIRE_PC_H
#define WIRE_PC_H

#include "wire/message.h"

#include <stdbool.h>
#include <stdint.h>

enum wire_stage { WIRE_SENDING, WIRE_CHECKING };

struct wire_image {
    void *ctx;
    uint64_t bytes;
    int (*read)(void *ctx, uint64_t offset, void *to, uint32_t length); /* 0 or an errno */
};

struct wire_pc {
    const struct wire_link *link; /* borrowed */
    struct wire_image image;
    uint64_t session; /* another one for each load */
    uint32_t wait_ms; /* for a panel that works: writing and checking take their time */

    /* Told how far it is, while the panel is sent pieces and while it checks; may be NULL. */
    void (*progress)(void *ctx, enum wire_stage stage, uint64_t done_bytes, uint64_t all_bytes);
    /* Told once what the panel's slots hold; may be NULL. */
    void (*welcome)(void *ctx, const char *slots);
    void *ctx;

    struct wire_figures figures; /* of a load that has come to its end */
    char text[WIRE_TEXT_BYTES];  /* where it lies, in the panel's words; or why it was refused */
    uint64_t sent_bytes, same_bytes;
    uint32_t version; /* of the panel, if it is another one */
    struct wire_message in, out;
    uint8_t payload[WIRE_PAYLOAD_BYTES];
};

/* Offer the image and answer until the panel says how it ended. Returns
 * - 0: it is in a slot and will be flown; `figures` and `text` say where,
 * - ECANCELED: the panel has refused it; `text` says why,
 * - EIO: the image cannot be read; the panel was told,
 * - EPROTO: the panel asks for what it may not,
 * - an errno of wire_send or wire_receive. */
int wire_pc_run(struct wire_pc *pc);

#endif
