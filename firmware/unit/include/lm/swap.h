/* Swap: two displays on one CANaerospace bus exchange the pages that they show. Each names the
 * other's node as its partner; nobody else is heard.
 *
 *     asking display                         its partner
 *     parts of its settings, ASK --------->  are they sound?
 *     are they sound?  <-------------------  parts of its settings, ANSWER
 *     TAKE ------------------------------->  takes the asking display's page
 *     takes the partner's page  <----------  TAKEN
 *
 * Both take a page or none does: TAKE is said when each has the other's settings whole and sound.
 * It is repeated for a second, so that only a bus that loses ten TAKEN in a row leaves the partner
 * alone with a new page. Who asks while it is asked answers if its node is the higher. Tables for
 * people: docs/bus.md, "Two displays". */
#ifndef LM_SWAP_H
#define LM_SWAP_H

#include <stdbool.h>
#include <stdint.h>

#include "lm/bus_filters.h"
#include "lm/port.h"
#include "lm/settings.h"

enum {
    LM_SWAP_ID = LM_BUS_SWAP_ID,
    LM_SWAP_PARTS = LM_SETTINGS_BYTES / 4, /* frames of settings */
    LM_SWAP_FRAMES_A_STEP = 4
};

/* Service codes: parts 0..15 of settings offered, the same plus 16 of an answer, and acts. */
enum lm_swap_act {
    LM_SWAP_OF_ANSWER = LM_SWAP_PARTS,
    LM_SWAP_ASK = 2 * LM_SWAP_PARTS,
    LM_SWAP_ANSWER,
    LM_SWAP_TAKE,
    LM_SWAP_TAKEN,
    LM_SWAP_SILENT /* nothing waits to be told */
};

enum lm_swap_state { LM_SWAP_IDLE, LM_SWAP_ASKING, LM_SWAP_ANSWERED, LM_SWAP_TAKING };

/* How long ANSWER, TAKE and TAKEN are awaited, and the time between two TAKE. */
enum {
    LM_SWAP_ASK_US = 500000,
    LM_SWAP_HOLD_US = 2000000,
    LM_SWAP_TAKE_US = 1000000,
    LM_SWAP_AGAIN_US = 100000
};

/* State; part of a unit. */
struct lm_swap {
    uint8_t node, partner; /* 1..255; a partner of 0: there is none */
    uint8_t state;         /* enum lm_swap_state */
    uint8_t exchange;      /* message code of the running exchange */
    uint8_t begun;         /* message code of the one that was begun here last */
    uint8_t item, code;    /* what is told next: a part or enum lm_swap_act, and its code */
    uint16_t done;         /* code of the one that the partner made last, plus 256; 0: none */
    uint16_t key;          /* code of what is heard, plus 256 for an answer */
    uint16_t missing;      /* bit n: part n of it has not come */
    uint64_t until_us;     /* the state ends then */
    uint64_t again_us;     /* TAKE is said again then */
    struct lm_settings heard, told;
    uint32_t refused; /* frames of a wrong form or out of turn; only grows */
};

#endif
