#include "lm/bus.h"

#include <stddef.h>

#include "lm/bus_bitfield.h"

void lm_bus_init(struct lm_bus *b, const struct lm_bus_profile *profile)
{
    *b = (struct lm_bus){.profile = profile};
}

void lm_bus_hear_only(struct lm_bus *b, const uint8_t *nodes)
{
    b->canas.nodes = nodes;
}

/* Number of a redundant sender: the identifier's bits under the mask, moved together to the
 * right. */
static uint32_t channel_of(uint32_t id, uint32_t mask)
{
    uint32_t channel = 0, place = 0;
    for (uint32_t bit = 0; bit < 29; bit++) {
        if (mask >> bit & 1) {
            channel |= (id >> bit & 1) << place++;
        }
    }
    return channel;
}

/* Complete an event with what the profile says of its row. */
static void add_row(struct lm_bus_event *event, const struct lm_bus_row *row)
{
    event->field = row->field;
    event->priority = row->priority;
    event->period_us = row->period_us;
    event->stale_ms = row->stale_ms;
    event->dead_ms = row->dead_ms;
}

/* Read a number for each row that takes the data; the first of these rows is `first`. */
static uint32_t read_rows(struct lm_bus *b, const struct lm_can_frame *frame, uint32_t first,
                          const struct lm_bus_payload *payload,
                          struct lm_bus_event events[LM_BUS_EVENTS])
{
    const struct lm_bus_profile *p = b->profile;
    uint32_t count = 0;
    for (uint32_t i = first; i < p->row_count && count < LM_BUS_EVENTS; i++) {
        if (!lm_bus_bitfield_is_row(&p->rows[i], frame)) {
            continue;
        }
        enum lm_bus_outcome outcome = LM_BUS_NO_DATA;
        if ((frame->id & p->invalid_mask) == 0) {
            outcome = lm_bus_bitfield_read(&p->rows[i], payload, &events[count]);
        }
        b->count.outcome[outcome]++;
        if (outcome == LM_BUS_VALUE) {
            events[count].row = (uint8_t)i;
            events[count].channel = (uint8_t)channel_of(frame->id, p->channel_mask);
            events[count].node = events[count].service = events[count].code = 0;
            add_row(&events[count], &p->rows[i]);
            count++;
        }
    }
    return count;
}

/* A frame of fast packets is kept until its message is whole. All rows of a frame agree on what it
 * is. */
static uint32_t take_packed(struct lm_bus *b, const struct lm_can_frame *frame,
                            struct lm_bus_event events[LM_BUS_EVENTS])
{
    const struct lm_bus_profile *p = b->profile;
    struct lm_bus_payload payload = {frame->data, frame->length, frame->time_us};
    uint32_t first = 0;
    while (first < p->row_count && !lm_bus_bitfield_is_row(&p->rows[first], frame)) {
        first++;
    }
    if (first == p->row_count || frame->length > 8) {
        b->count.outcome[first == p->row_count ? LM_BUS_UNUSED : LM_BUS_BAD_LENGTH]++;
        return 0;
    }
    if (p->channel_mask != 0 &&
        !lm_bus_is_heard(b->canas.nodes, (uint8_t)channel_of(frame->id, p->channel_mask))) {
        b->count.outcome[LM_BUS_NODE_REFUSED]++;
        return 0;
    }
    if (p->rows[first].packing.is_fast) {
        const struct lm_fast_packet_slot *whole = lm_fast_packet_take(&b->fast, frame);
        if (whole == NULL) {
            b->count.outcome[LM_BUS_HALF]++;
            return 0;
        }
        payload = (struct lm_bus_payload){whole->data, whole->length, whole->begun_us};
    }
    return read_rows(b, frame, first, &payload, events);
}

uint32_t lm_bus_take(struct lm_bus *b, const struct lm_can_frame *frame,
                     struct lm_bus_event events[LM_BUS_EVENTS])
{
    b->count.frames++;
    enum lm_bus_outcome outcome;
    if (frame->is_error || frame->is_remote) {
        outcome = LM_BUS_NOT_DATA;
    } else if (b->profile->framing == LM_BUS_CANAEROSPACE) {
        outcome = lm_canas_take(&b->canas, b->profile, frame, &events[0]);
    } else if (!frame->is_extended || frame->id > 0x1fffffff) {
        outcome = LM_BUS_FOREIGN;
    } else {
        return take_packed(b, frame, events);
    }
    b->count.outcome[outcome]++;
    if (outcome != LM_BUS_VALUE) {
        return 0;
    }
    add_row(&events[0], &b->profile->rows[events[0].row]);
    return 1;
}
