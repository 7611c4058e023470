/* Fast packets of NMEA 2000 (lm/fast_packet.h).
 *
 * Invariant of a decoder: of each slot with a message under way the length is 1..223, and `missing`
 * has only bits of frames that such a message has.
 *
 * Proved: zeros keep it; any frame leaves any decoder that keeps it keeping it, so that every
 * sequence of frames does. No access leaves an object, the loop over slots ends. What is handed out
 * is one of the decoder's slots, whole, of 1..223 bytes.
 *
 * Assumed: nothing about the frame. */
#include "lm/fast_packet.h"

#include "prove.h"

struct lm_fast_packet nondet_fast_packet(void);
struct lm_can_frame nondet_frame(void);

/* Stands for the C library's: what is copied goes into `data` of one slot and comes from the data
 * bytes that the frame has. The bytes themselves are not followed. */
static struct lm_fast_packet f;
static struct lm_can_frame frame;
void *memcpy(void *restrict to, const void *restrict from, size_t len)
{
    const size_t at = __CPROVER_POINTER_OFFSET(to) % sizeof f.slot[0];
    const size_t from_at = __CPROVER_POINTER_OFFSET(from);
    PROVE(__CPROVER_same_object(to, &f) && __CPROVER_same_object(from, &frame));
    PROVE(from_at >= offsetof(struct lm_can_frame, data));
    PROVE(from_at + len <= offsetof(struct lm_can_frame, data) + frame.length);
    PROVE(at >= offsetof(struct lm_fast_packet_slot, data));
    PROVE(at + len <= offsetof(struct lm_fast_packet_slot, data) + LM_FAST_PACKET_BYTES);
    return to;
}

static bool is_kept(const struct lm_fast_packet *f)
{
    bool is_sound = true;
    for (uint32_t i = 0; i < LM_FAST_PACKET_SLOTS; i++) {
        const struct lm_fast_packet_slot *s = &f->slot[i];
        const uint32_t length = s->length, rest = length > 6 ? length - 6 : 0;
        const uint32_t frames = 1 + (rest + 6) / 7;
        const bool is_of_message = length >= 1 && length <= LM_FAST_PACKET_BYTES && frames <= 32 &&
                                   (s->missing & ~(UINT32_MAX >> (32 - frames))) == 0;
        is_sound = is_sound && (s->missing == 0 || is_of_message);
    }
    return is_sound;
}

void prove_zeros(void)
{
    const struct lm_fast_packet zeros = {0};
    PROVE(is_kept(&zeros));
}

void prove_take(void)
{
    f = nondet_fast_packet();
    frame = nondet_frame();
    ASSUME(is_kept(&f));
    const struct lm_fast_packet_slot *whole = lm_fast_packet_take(&f, &frame);
    PROVE(is_kept(&f));
    if (whole != NULL) {
        PROVE(whole >= f.slot && whole < f.slot + LM_FAST_PACKET_SLOTS);
        PROVE(whole->missing == 0 && whole->length >= 1 && whole->length <= LM_FAST_PACKET_BYTES);
    }
}
