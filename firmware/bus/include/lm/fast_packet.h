/* Fast packets: messages of NMEA 2000 with more than eight bytes, which come in up to 32 frames of
 * one identifier.
 *
 *     byte    0                    1             2..7
 *     frame 0 sequence << 5 | 0    total bytes   the first six
 *     frame n sequence << 5 | n    the next seven ...
 *
 * Frame 0 begins a message; those behind it may come in any order. */
#ifndef LM_FAST_PACKET_H
#define LM_FAST_PACKET_H

#include <stdbool.h>
#include <stdint.h>

#include "lm/port.h"

enum {
    LM_FAST_PACKET_BYTES = 223, /* of a whole message: 6 + 31 * 7 */
    LM_FAST_PACKET_SLOTS = 4,   /* messages under way at one time */
    LM_FAST_PACKET_US = 750000  /* a message with a longer pause is given up */
};

/* State; the caller owns it. It starts as zeros. Counters only ever grow. */
struct lm_fast_packet {
    struct lm_fast_packet_slot {
        uint64_t begun_us, last_us; /* arrival of frame 0, and of the last one */
        uint32_t id;
        uint32_t missing; /* bit n: frame n is still to come; 0: no message is under way */
        uint8_t sequence, length;
        uint8_t data[LM_FAST_PACKET_BYTES];
    } slot[LM_FAST_PACKET_SLOTS];
    struct {
        uint32_t whole; /* messages completed */
        uint32_t torn;  /* messages begun and never completed */
        uint32_t stray; /* frames that belong to none that was begun, or that it has already */
    } count;
};

/* Take a data frame. Returns the slot with the whole message if this frame completes it, which is
 * valid until the next call; else NULL. Any contents of *frame are safe. A message under way is
 * torn when its frame 0 comes again, after LM_FAST_PACKET_US, or when a fifth message begins: the
 * one that was silent longest then gives way. Cost: about 100 instructions. */
const struct lm_fast_packet_slot *lm_fast_packet_take(struct lm_fast_packet *f,
                                                      const struct lm_can_frame *frame);

#endif
