/* The panel's end of a load over a wire: the image of the PC as a flash, which the loader of slots
 * reads like a file (slots/load.h).
 *
 *     wire_panel_wait ─> reads of panel.port ... ─> wire_panel_status ... ─> wire_panel_done or
 * _refuse
 *
 * Every byte of the PC is hostile. It decides nothing but what the image holds; what becomes of
 * that, slots and signatures decide. */
#ifndef WIRE_PANEL_H
#define WIRE_PANEL_H

#include "wire/message.h"

#include <stdbool.h>
#include <stdint.h>

#include "lm/port.h"

/* Bytes that the image may have in this place, because a load was cut off. Returns 0 or an errno.
 */
typedef int wire_guess(void *ctx, uint64_t offset, void *to, uint32_t length);

struct wire_panel {
    const struct wire_link *link; /* borrowed */
    uint32_t answer_ms;           /* the PC answers within it, or is given up */
    struct lm_flash port;         /* the image; its ctx is this struct, which must not move */
    wire_guess *guess;            /* NULL: nothing is there */
    void *guess_ctx;
    uint64_t session;
    int32_t percent;            /* told last; -1: none */
    int cause;                  /* errno of what ended the session; 0: it lasts */
    char text[WIRE_TEXT_BYTES]; /* the cause in the PC's words, if it told one */
    bool has_offer;             /* of the next session, which came in the middle of this one */
    uint64_t sent_bytes;        /* that came over the wire */
    uint64_t same_bytes;        /* that did not have to */
    uint32_t bad;               /* messages that were none, since the start */
    struct wire_message in, out;
    uint8_t payload[WIRE_PAYLOAD_BYTES];
};

void wire_panel_open(struct wire_panel *p, const struct wire_link *link, uint32_t answer_ms);

/* Wait for a PC with an image, for ever. Then port.size_bytes is what it says, and each read of the
 * port asks for the bytes and waits for them. Returns 0 or an errno of the link. A PC of another
 * version is refused, and waiting goes on. */
int wire_panel_wait(struct wire_panel *p);

/* Tell it what the slots hold. */
void wire_panel_welcome(struct wire_panel *p, const char *slots);

/* Tell how far the check of the slot is; seldom, whenever it is called. A PC that is gone is no
 * fault any more: all bytes are there. */
void wire_panel_status(struct wire_panel *p, uint64_t done_bytes, uint64_t all_bytes);

/* Tell how it ended: in a slot, or why not. */
void wire_panel_done(struct wire_panel *p, const struct wire_figures *figures, const char *text);
void wire_panel_refuse(struct wire_panel *p, const char *text);

#endif
