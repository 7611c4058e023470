/* Node services of CANaerospace V1.7 (section 4) that a display has: identification, state and
 * time. The other services change the bus or write memory, and the protocol authenticates none of
 * them: they are not answered, only counted. */
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

/* Age at which an answer that could not be sent is dropped: its asker has given up. */
#define LM_CANAS_ANSWER_US 100000

/* Least time between two answers: requests that flood the bus do not make answers flood it too. */
#define LM_CANAS_ANSWER_PAUSE_US 10000

/* State of the services; the caller owns it. Counters only ever grow. */
struct lm_canas_service {
    uint8_t node; /* the display's own, 1..255; 0: no services */
    uint8_t hardware_revision, software_revision;
    uint8_t state_code; /* message code of the next state word */
    bool is_ids_asked, is_sts_asked, has_answered, has_sync;
    uint64_t ids_asked_us, sts_asked_us; /* arrival of the waiting request */
    uint64_t answered_us;                /* time of the last answer */
    uint32_t sync_stamp;                 /* the last time stamp of NSS, in the sender's unit */
    uint64_t sync_us;                    /* arrival of sync_stamp */
    struct {
        uint32_t asked[3];  /* IDS, NSS, STS: requests for this node or for all */
        uint32_t answered;  /* frames sent */
        uint32_t late;      /* answers dropped: the bus did not take them in time */
        uint32_t refused;   /* requests of other services */
        uint32_t malformed; /* requests of a wrong length or type */
        uint32_t elsewhere; /* requests for other nodes */
    } count;
};

/* Begin as `node` (0: no services), with no request waiting. */
void lm_canas_service_init(struct lm_canas_service *s, uint8_t node, uint8_t hardware_revision,
                           uint8_t software_revision);

/* Take any frame; only requests on LM_CANAS_REQUEST_ID have an effect. A request that comes while
 * the same one waits is answered together with it. */
void lm_canas_service_take(struct lm_canas_service *s, const struct lm_can_frame *frame);

/* Tell the state word unasked, as if STS had asked for it. */
void lm_canas_service_tell_state(struct lm_canas_service *s, uint64_t now_us);

/* Send at most one answer, to the request that waits longest. `state` is the word that STS asks
 * for. Call it in every step: with steps of 4 ms a request is answered within 4 ms while the bus
 * takes frames. Otherwise it is answered within LM_CANAS_ANSWER_US or not at all. */
void lm_canas_service_answer(struct lm_canas_service *s, const struct lm_can *can, uint32_t state,
                             uint64_t now_us);

#endif
