#include "lm/fast_packet.h"

#include <stddef.h>

#include "fx/mem.h"

enum { FIRST_BYTES = 6, NEXT_BYTES = 7 };

static bool is_late(const struct lm_fast_packet_slot *s, uint64_t now_us)
{
    return now_us < s->last_us || now_us - s->last_us > LM_FAST_PACKET_US;
}

/* Where a message of this identifier and sequence is under way; else a free slot, or the one that
 * was silent longest. */
static struct lm_fast_packet_slot *find_slot(struct lm_fast_packet *f, uint32_t id,
                                             uint8_t sequence, bool *is_under_way)
{
    struct lm_fast_packet_slot *best = &f->slot[0];
    for (uint32_t i = 0; i < LM_FAST_PACKET_SLOTS; i++) {
        struct lm_fast_packet_slot *s = &f->slot[i];
        if (s->missing != 0 && s->id == id && s->sequence == sequence) {
            *is_under_way = true;
            return s;
        }
        const bool is_better = s->missing == 0 || s->last_us < best->last_us;
        best = best->missing != 0 && is_better ? s : best;
    }
    *is_under_way = false;
    return best;
}

/* Begin a message by its frame 0. False if that is none. */
static bool begin(struct lm_fast_packet *f, struct lm_fast_packet_slot *s,
                  const struct lm_can_frame *frame)
{
    const uint8_t length = frame->data[1];
    const uint32_t rest = length > FIRST_BYTES ? length - (uint32_t)FIRST_BYTES : 0;
    const uint32_t frames = 1 + (rest + NEXT_BYTES - 1) / NEXT_BYTES; /* at most 32 */
    if (length == 0 || length > LM_FAST_PACKET_BYTES) {
        f->count.stray++;
        return false;
    }
    f->count.torn += s->missing != 0;
    s->id = frame->id;
    s->sequence = frame->data[0] >> 5;
    s->length = length;
    s->missing = UINT32_MAX >> (32 - frames);
    s->begun_us = frame->time_us;
    return true;
}

const struct lm_fast_packet_slot *lm_fast_packet_take(struct lm_fast_packet *f,
                                                      const struct lm_can_frame *frame)
{
    bool is_under_way;
    if (frame->length < 2 || frame->length > 8) {
        f->count.stray++;
        return NULL;
    }
    const uint32_t number = frame->data[0] & 31u;
    struct lm_fast_packet_slot *s = find_slot(f, frame->id, frame->data[0] >> 5, &is_under_way);
    if (is_under_way && is_late(s, frame->time_us)) {
        f->count.torn++;
        s->missing = 0;
        is_under_way = false;
    }
    if (number == 0 ? !begin(f, s, frame) : !is_under_way || (s->missing >> number & 1) == 0) {
        f->count.stray += number != 0;
        return NULL;
    }
    /* at + bytes <= length <= LM_FAST_PACKET_BYTES */
    const uint32_t at = number == 0 ? 0 : FIRST_BYTES + (number - 1) * NEXT_BYTES;
    const uint32_t head = number == 0 ? 2 : 1, left = s->length - at;
    const uint32_t held = frame->length - head;
    const uint32_t wanted = left < 8 - head ? left : 8 - head;
    if (held < wanted) {
        f->count.torn++;
        s->missing = 0;
        return NULL;
    }
    memcpy(s->data + at, frame->data + head, wanted);
    s->last_us = frame->time_us;
    s->missing &= ~(1u << number);
    f->count.whole += s->missing == 0;
    return s->missing == 0 ? s : NULL;
}
