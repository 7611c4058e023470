/* Node services of CANaerospace V1.7 (section 4): the display answers who it is and how it is, and
 * takes the time. The other services change the bus or write memory, and the protocol
 * authenticates none of them: they are counted and not obeyed. */
#ifndef LM_CANAS_SERVICE_H
#define LM_CANAS_SERVICE_H

#include <stdbool.h>
#include <stdint.h>

#include "lm/port.h"

/* Identifiers, 11 bits. */
enum {
    LM_CANAS_REQUEST_ID = 128,  /* node service channel 0, which every node must serve */
    LM_CANAS_RESPONSE_ID = 129, /* answers on that channel */
    LM_CANAS_STATE_ID = 1500    /* the state word, in the range that is free to use */
};

enum lm_canas_service_code {
    LM_CANAS_IDS = 0, /* identification: answered with revisions */
    LM_CANAS_NSS = 1, /* node synchronisation: the time stamp is kept */
    LM_CANAS_STS = 7  /* state transmission: answered with the state word */
};

/* An answer that the bus did not take for this long is dropped and counted as late. */
#define LM_CANAS_ANSWER_US 100000

/* Least time between two answers, so that a flood of requests is not doubled by answers. */
#define LM_CANAS_ANSWER_PAUSE_US 10000

/* State of the services; the caller owns it. Counters only ever grow. */
struct lm_canas_service {
    uint8_t node; /* the display's own, 1..255; 0: it takes no part */
    uint8_t hardware_revision, software_revision;
    uint8_t state_code; /* message code of the next state word */
    bool is_ids_asked, is_sts_asked, has_answered, has_sync;
    uint64_t ids_asked_us, sts_asked_us; /* when the waiting request first came */
    uint64_t answered_us;                /* when the last answer was sent */
    uint32_t sync_stamp;                 /* last time stamp of NSS, in the sender's unit */
    uint64_t sync_us;                    /* when that stamp came */
    struct {
        uint32_t asked[3];  /* requests IDS, NSS and STS for this node or for all */
        uint32_t answered;  /* frames sent */
        uint32_t late;      /* answers dropped after LM_CANAS_ANSWER_US */
        uint32_t refused;   /* requests of other services */
        uint32_t malformed; /* requests of a wrong length or type */
        uint32_t elsewhere; /* requests for other nodes */
    } count;
};

/* Begin with nothing asked. Node 0 takes no part: requests are neither counted nor answered. */
void lm_canas_service_init(struct lm_canas_service *s, uint8_t node, uint8_t hardware_revision,
                           uint8_t software_revision);

/* Take any frame; only requests on LM_CANAS_REQUEST_ID change anything. A request that comes while
 * the same one waits is answered together with it. Any contents of *frame are safe. */
void lm_canas_service_take(struct lm_canas_service *s, const struct lm_can_frame *frame);

/* Send at most one waiting answer, the oldest request first. `state` is the word that STS asks
 * for, `now_us` on the clock of the frames' time stamps. Nothing is sent when
 *
 * - nothing was asked, or can->send is NULL
 * - the last answer was less than LM_CANAS_ANSWER_PAUSE_US ago
 * - the bus has no room or is down: the answer waits, up to LM_CANAS_ANSWER_US
 *
 * Call it in every step. */
void lm_canas_service_answer(struct lm_canas_service *s, const struct lm_can *can, uint32_t state,
                             uint64_t now_us);

#endif
