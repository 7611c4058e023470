#include "lm/canas_service.h"

#include <stddef.h>

#include "lm/canas.h"

enum { HEADER_BYTES = 4, IDS_COUNT = 0, NSS_COUNT = 1, STS_COUNT = 2 };

void lm_canas_service_init(struct lm_canas_service *s, uint8_t node, uint8_t hardware_revision,
                           uint8_t software_revision)
{
    *s = (struct lm_canas_service){.node = node,
                                   .hardware_revision = hardware_revision,
                                   .software_revision = software_revision};
}

static uint32_t big_endian_32(const uint8_t *bytes)
{
    return (uint32_t)bytes[0] << 24 | (uint32_t)bytes[1] << 16 | (uint32_t)bytes[2] << 8 | bytes[3];
}

static void ask(bool *is_asked, uint64_t *asked_us, uint64_t now_us)
{
    if (!*is_asked) {
        *is_asked = true;
        *asked_us = now_us;
    }
}

static void take_sync(struct lm_canas_service *s, const struct lm_can_frame *frame)
{
    if (frame->data[1] != LM_CANAS_ULONG || frame->length != HEADER_BYTES + 4) {
        s->count.malformed++;
        return;
    }
    s->count.asked[NSS_COUNT]++;
    s->sync_stamp = big_endian_32(frame->data + HEADER_BYTES);
    s->sync_us = frame->time_us;
    s->has_sync = true;
}

/* True for a request without data. Some senders fill such a frame up to 8 bytes. */
static bool is_plain(const struct lm_can_frame *frame)
{
    return frame->data[1] == LM_CANAS_NODATA;
}

static void take_request(struct lm_canas_service *s, const struct lm_can_frame *frame)
{
    switch (frame->data[2]) {
    case LM_CANAS_IDS:
        if (is_plain(frame)) {
            s->count.asked[IDS_COUNT]++;
            ask(&s->is_ids_asked, &s->ids_asked_us, frame->time_us);
            return;
        }
        break;
    case LM_CANAS_NSS:
        take_sync(s, frame);
        return;
    case LM_CANAS_STS:
        if (is_plain(frame)) {
            s->count.asked[STS_COUNT]++;
            ask(&s->is_sts_asked, &s->sts_asked_us, frame->time_us);
            return;
        }
        break;
    default:
        s->count.refused++;
        return;
    }
    s->count.malformed++;
}

void lm_canas_service_take(struct lm_canas_service *s, const struct lm_can_frame *frame)
{
    if (s->node == 0 || frame->is_error || frame->is_remote || frame->is_extended ||
        frame->id != LM_CANAS_REQUEST_ID) {
        return;
    }
    if (frame->length < HEADER_BYTES || frame->length > 8) {
        s->count.malformed++;
    } else if (frame->data[0] != 0 && frame->data[0] != s->node) {
        s->count.elsewhere++;
    } else {
        take_request(s, frame);
    }
}

void lm_canas_service_tell_state(struct lm_canas_service *s, uint64_t now_us)
{
    if (s->node != 0) {
        ask(&s->is_sts_asked, &s->sts_asked_us, now_us);
    }
}

/* Drop a request that has waited too long, or whose time is ahead because the clock was set
 * back. */
static void expire(struct lm_canas_service *s, bool *is_asked, uint64_t *asked_us, uint64_t now_us)
{
    if (*is_asked &&
        (now_us > *asked_us ? now_us - *asked_us : *asked_us - now_us) > LM_CANAS_ANSWER_US) {
        *is_asked = false;
        s->count.late++;
    }
}

static int send_identity(const struct lm_canas_service *s, const struct lm_can *can)
{
    const struct lm_can_frame frame = {
        .id = LM_CANAS_RESPONSE_ID,
        .length = 8,
        /* Standard identifier distribution, standard header. */
        .data = {s->node, LM_CANAS_UCHAR4, LM_CANAS_IDS, 0, s->hardware_revision,
                 s->software_revision, 0, 0},
    };
    return can->send(can->ctx, &frame);
}

static int send_state(const struct lm_canas_service *s, const struct lm_can *can, uint32_t state)
{
    const struct lm_can_frame frame = {
        .id = LM_CANAS_STATE_ID,
        .length = 8,
        .data = {s->node, LM_CANAS_BLONG, 0, s->state_code, (uint8_t)(state >> 24),
                 (uint8_t)(state >> 16), (uint8_t)(state >> 8), (uint8_t)state},
    };
    return can->send(can->ctx, &frame);
}

void lm_canas_service_answer(struct lm_canas_service *s, const struct lm_can *can, uint32_t state,
                             uint64_t now_us)
{
    expire(s, &s->is_ids_asked, &s->ids_asked_us, now_us);
    expire(s, &s->is_sts_asked, &s->sts_asked_us, now_us);
    const bool is_soon = s->has_answered && now_us >= s->answered_us &&
                         now_us - s->answered_us < LM_CANAS_ANSWER_PAUSE_US;
    if ((!s->is_ids_asked && !s->is_sts_asked) || is_soon || can->send == NULL) {
        return;
    }
    const bool is_identity =
        s->is_ids_asked && (!s->is_sts_asked || s->ids_asked_us <= s->sts_asked_us);
    if ((is_identity ? send_identity(s, can) : send_state(s, can, state)) != LM_OK) {
        return;
    }
    if (is_identity) {
        s->is_ids_asked = false;
    } else {
        s->is_sts_asked = false;
        s->state_code++;
    }
    s->has_answered = true;
    s->answered_us = now_us;
    s->count.answered++;
}
