/* CANaerospace decoder, for V1.7 (Stock Flight Systems, revision of 12.1.2006), the part that a
 * display receives: one frame in, at most one value in fixed point out.
 *
 * The message code never decides whether a frame is new: a sender that restarts, repeats or never
 * counts is heard from its first frame on. The code serves only to join the halves of a DOUBLE and
 * to count breaks. */
#ifndef LM_CANAS_H
#define LM_CANAS_H

#include <stdbool.h>
#include <stdint.h>

#include "lm/bus_event.h"
#include "lm/bus_profile.h"
#include "lm/port.h"

/* Data type codes (byte 1) that the code names; lm_canas_types has all. */
enum {
    LM_CANAS_NODATA = 0,
    LM_CANAS_ERROR = 1,
    LM_CANAS_FLOAT = 2,
    LM_CANAS_LONG = 3,
    LM_CANAS_ULONG = 4,
    LM_CANAS_BLONG = 5,
    LM_CANAS_CHAR = 9,
    LM_CANAS_UCHAR = 10,
    LM_CANAS_SHORT2 = 12, /* value and full scale: value * scale / 32767 */
    LM_CANAS_CHAR4 = 15,
    LM_CANAS_UCHAR4 = 16,
    LM_CANAS_UCHAR2 = 19,
    LM_CANAS_UCHAR3 = 27,
    LM_CANAS_DOUBLEH = 30,
    LM_CANAS_DOUBLEL = 31,
    LM_CANAS_TYPES = 32 /* 32..99 are reserved, 100..255 the user's */
};

/* Kind of a data type. */
enum lm_canas_kind {
    LM_CANAS_KIND_NONE,
    LM_CANAS_KIND_FLOAT,
    LM_CANAS_KIND_SIGNED,
    LM_CANAS_KIND_UNSIGNED,
    LM_CANAS_KIND_BITS, /* a set of bits; also addresses, checksums and error codes */
    LM_CANAS_KIND_TEXT,
    LM_CANAS_KIND_HALF /* half of a DOUBLE */
};

/* A data type: `elements` numbers of `element_bytes` each, big-endian, in bytes 4 and up. */
struct lm_canas_type {
    const char *name;
    uint8_t kind; /* enum lm_canas_kind */
    uint8_t element_bytes, elements;
};

extern const struct lm_canas_type lm_canas_types[LM_CANAS_TYPES];

/* Identifier ranges that are not normal operation data (sections 2.1 and 4). */
enum {
    LM_CANAS_SERVICE_FIRST = 128, /* node service channels 0..35: request 128 + 2n, response + 1 */
    LM_CANAS_SERVICE_LAST = 199,
    LM_CANAS_LOW_SERVICE_FIRST = 2000, /* channels 100..115 */
    LM_CANAS_LOW_SERVICE_LAST = 2031,
    LM_CANAS_ROW_FIRST = 200, /* what a row may have */
    LM_CANAS_ROW_LAST = 1999
};

/* Frames with one message code after which a sender that has counted is stuck: its transmitter
 * repeats an old frame, which looks like fresh data. */
enum { LM_CANAS_STILL = 8 };

/* Pair: a half of a DOUBLE that waits for the other, and the order in which its sender sends
 * them. */
struct lm_canas_pair {
    enum { LM_CANAS_EMPTY, LM_CANAS_WAITING, LM_CANAS_JOINED } state;
    uint8_t type, node, code; /* of the last half received */
    uint32_t word;            /* data of the last half */
    uint64_t time_us;         /* arrival of the last half */
    /* Habit of the sender: the code of DOUBLEL minus that of DOUBLEH, 1 or -1, times 2 if DOUBLEH
     * comes last; 0 while unknown. */
    int8_t habit;
    uint32_t habit_gap_us; /* time between the two halves that the habit was learnt from */
};

/* State of the decoder; the caller owns it. It starts as zeros. Counters only ever grow. */
struct lm_canas {
    struct lm_canas_pair pair[2][LM_BUS_CHANNELS]; /* latitude, longitude */
    struct {
        uint8_t node, code; /* node 0: nothing heard yet */
        uint8_t still;      /* frames since the code last changed, up to LM_CANAS_STILL */
        bool has_counted;   /* the node has changed its code at least once */
    } last[LM_BUS_ROWS_MAX][LM_BUS_CHANNELS];
    const uint8_t *nodes; /* borrowed; lm_bus_hear_only */
    uint8_t stuck_node;   /* of the frame of count.stuck that came last */
    struct {
        uint32_t torn_pairs;      /* halves dropped without the other half */
        uint32_t sequence_breaks; /* message codes that are not one more than the last: a frame
                                     was lost or repeated, or the sender restarted */
        uint32_t stuck; /* frames of a sender whose code stands still: the LM_CANAS_STILL-th
                           of one code, and those behind it */
    } count;
};

/* Decode a frame by a profile of framing LM_BUS_CANAEROSPACE. LM_BUS_VALUE: *event holds what the
 * frame says, and the row's number. lm_bus_take adds what the profile says of that row: field,
 * priority, period and ages. Any other outcome: *event is unchanged. Any contents of *frame are
 * safe.
 *
 * Two halves of a DOUBLE are joined iff they have
 * - the same identifier, channel and node;
 * - adjacent message codes;
 * - no frame of that identifier and channel between them;
 * - at most one nominal period between their arrivals; half a period while the sender's habit is
 *   unknown;
 * - the order of the sender's habit, once it is known.
 * Without the habit, one lost frame would join the second half of each value to the first half of
 * the next for ever. It is learnt from the pair that is nearer in time. Half a period is safe for a
 * sender at the nominal rate. A faster sender whose very first half was lost may give one value of
 * mismatched halves, wrong by at most 14 m. A single half never makes a value. */
enum lm_bus_outcome lm_canas_take(struct lm_canas *c, const struct lm_bus_profile *profile,
                                  const struct lm_can_frame *frame, struct lm_bus_event *event);

/* True if a row of this field may have this type:
 * - FLOAT, integers and SHORT2: every field;
 * - halves of a DOUBLE: latitude and longitude;
 * - three or four single bytes: the clock. */
bool lm_canas_fits(enum lm_bus_field field, uint8_t type);

#endif
