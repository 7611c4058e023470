/* Node services of CANaerospace (lm/canas_service.h).
 *
 * Proved, for any state, frame, time and answer of the driver: no access outside an object, no
 * overflow; a node 0 hears nothing; at most one frame a call is sent, of 8 bytes and with an
 * identifier of a service's answer; it is sent only where a request waited, and not within the
 * pause behind another.
 *
 * Assumed: nothing. */
#include "firmware/bus/canas_service.c"

#include "prove.h"

struct lm_canas_service nondet_service(void);
struct lm_can_frame nondet_frame(void);

void prove_take(void)
{
    struct lm_canas_service s = nondet_service();
    const struct lm_can_frame frame = nondet_frame();
    const bool was_asked = s.is_ids_asked || s.is_sts_asked;
    lm_canas_service_take(&s, &frame);
    PROVE(s.node != 0 || was_asked || (!s.is_ids_asked && !s.is_sts_asked));
    PROVE(frame.id == LM_CANAS_REQUEST_ID || was_asked == (s.is_ids_asked || s.is_sts_asked));
}

static uint32_t sent;

static int send(void *ctx, const struct lm_can_frame *frame)
{
    PROVE(ctx == NULL && frame->length == 8);
    PROVE(frame->id == LM_CANAS_RESPONSE_ID || frame->id == LM_CANAS_STATE_ID);
    sent++;
    return nondet_i32();
}

void prove_answer(void)
{
    struct lm_canas_service s = nondet_service();
    const struct lm_can can = {.send = nondet_bool() ? send : NULL};
    const uint64_t now_us = nondet_u64();
    const bool was_asked = s.is_ids_asked || s.is_sts_asked;
    const bool is_pause = s.has_answered && now_us >= s.answered_us &&
                          now_us - s.answered_us < LM_CANAS_ANSWER_PAUSE_US;
    sent = 0;
    lm_canas_service_answer(&s, &can, nondet_u32(), now_us);
    PROVE(sent <= (was_asked && !is_pause ? 1u : 0u));
}
