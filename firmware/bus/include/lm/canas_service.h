/* Node services of CANaerospace V1.7 (section 4), as far as a display has any: it says what it is,
 * says how it is, and hears the time. None of the other services, which change the bus or write
 * memory, is authenticated by the protocol; they are refused, which is to say counted. */
#ifndef LM_CANAS_SERVICE_H
#define LM_CANAS_SERVICE_H

#include <stdbool.h>
#include <stdint.h>

#include "lm/port.h"

enum {
    LM_CANAS_REQUEST_ID = 128, /* node service channel 0, which every unit must serve */
    LM_CANAS_RESPONSE_ID = 129,
    LM_CANAS_STATE_ID = 1500 /* normal operation data, in the range that is free to use */
};

enum lm_canas_service_code {
    LM_CANAS_IDS = 0, /* identification: answered with revisions */
    LM_CANAS_NSS = 1, /* node synchronisation: the time stamp is taken */
    LM_CANAS_STS = 7  /* state transmission: the state word is sent */
};

/* An answer that could not be sent for this long is not sent any more: whoever asked has given up.
 */
#define LM_CANAS_ANSWER_US 100000

/* At least so long from one answer to the next, whatever is asked: a bus that is flooded with
 * requests is not flooded with answers too. */
#define LM_CANAS_ANSWER_PAUSE_US 10000

/* What the display remembers of services; the caller owns it. Counters only ever grow. */
struct lm_canas_service {
    uint8_t node; /* the display's own, 1..255; 0: it takes no part */
    uint8_t hardware_revision, software_revision;
    uint8_t state_code; /* message code of the next state word */
    bool is_ids_asked, is_sts_asked, has_answered, has_sync;
    uint64_t ids_asked_us, sts_asked_us; /* when the request that waits first came */
    uint64_t answered_us;
    uint32_t sync_stamp; /* the last time stamp of NSS, in the sender's unit */
    uint64_t sync_us;    /* when it came */
    struct {
        uint32_t asked[3]; /* IDS, NSS, STS: requests for this node or for all */
        uint32_t answered; /* frames sent */
        uint32_t late;     /* answers given up: the bus did not take them in time */
        uint32_t refused;  /* requests of other services */
        uint32_t malformed;
        uint32_t elsewhere; /* requests for other nodes */
    } count;
};

void lm_canas_service_init(struct lm_canas_service *s, uint8_t node, uint8_t hardware_revision,
                           uint8_t software_revision);

/* Take a frame, whatever it is: only requests on LM_CANAS_REQUEST_ID matter. A request that comes
 * while the same one waits is answered together with it. */
void lm_canas_service_take(struct lm_canas_service *s, const struct lm_can_frame *frame);

/* Send an answer that waits, at most one a call, the request that waits longest first. `state` is
 * the word that STS asks for. Call it in every step: a step of 4 ms answers within 4 ms while the
 * bus takes frames, within LM_CANAS_ANSWER_US or not at all when it does not. */
void lm_canas_service_answer(struct lm_canas_service *s, const struct lm_can *can, uint32_t state,
                             uint64_t now_us);

#endif
