/* CANaerospace V1.7 (Stock Flight Systems, revision of 12.1.2006), the part a display listens to:
 * one frame of the bus in, at most one value in fixed point out.
 *
 * Nothing here ever decides by message code whether a frame is new: a sender that restarts, repeats
 * or never counts is heard from its first frame on. The code serves to join the halves of a DOUBLE
 * and to count breaks. */
#ifndef LM_CANAS_H
#define LM_CANAS_H

#include <stdbool.h>
#include <stdint.h>

#include "lm/bus_event.h"
#include "lm/bus_profile.h"
#include "lm/port.h"

/* Data type codes (byte 1) that are named somewhere; lm_canas_types has all. */
enum {
    LM_CANAS_NODATA = 0,
    LM_CANAS_ERROR = 1,
    LM_CANAS_FLOAT = 2,
    LM_CANAS_LONG = 3,
    LM_CANAS_ULONG = 4,
    LM_CANAS_BLONG = 5,
    LM_CANAS_UCHAR = 10,
    LM_CANAS_SHORT2 = 12, /* value and full scale: value * scale / 32767 */
    LM_CANAS_CHAR4 = 15,
    LM_CANAS_UCHAR4 = 16,
    LM_CANAS_UCHAR3 = 27,
    LM_CANAS_DOUBLEH = 30,
    LM_CANAS_DOUBLEL = 31,
    LM_CANAS_TYPES = 32 /* 32..99 are reserved, 100..255 the user's */
};

enum lm_canas_kind {
    LM_CANAS_KIND_NONE,
    LM_CANAS_KIND_FLOAT,
    LM_CANAS_KIND_SIGNED,
    LM_CANAS_KIND_UNSIGNED,
    LM_CANAS_KIND_BITS, /* each bit for itself; also addresses, checksums and error codes */
    LM_CANAS_KIND_TEXT,
    LM_CANAS_KIND_HALF /* of a double */
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
    LM_CANAS_LOW_SERVICE_LAST = 2031
};

/* A half of a DOUBLE, and what is known of the way its sender arranges them. */
struct lm_canas_pair {
    enum { LM_CANAS_EMPTY, LM_CANAS_WAITING, LM_CANAS_JOINED } state;
    uint8_t type, node, code; /* of the half that came last */
    uint32_t word;
    uint64_t time_us;
    /* How this sender arranges its halves: the code of DOUBLEL minus that of DOUBLEH, 1 or -1,
     * times 2 when DOUBLEH comes last; 0 while it is not known. */
    int8_t habit;
    uint32_t habit_gap_us; /* time between the two halves that told */
};

/* What the decoder remembers; the caller owns it. Starts as zeros. Counters only ever grow. */
struct lm_canas {
    struct lm_canas_pair pair[2][LM_BUS_CHANNELS]; /* latitude, longitude */
    struct {
        uint8_t node, code; /* node 0: nothing heard yet */
    } last[LM_BUS_ROWS_MAX][LM_BUS_CHANNELS];
    struct {
        uint32_t torn_pairs;      /* halves dropped without their mate */
        uint32_t sequence_breaks; /* message code not one more than the last: lost, repeated or
                                     restarted */
    } count;
};

/* Decode a frame by a profile of framing LM_BUS_CANAEROSPACE. For LM_BUS_VALUE *event holds what
 * the frame says, and row; what the profile says of that row (field, priority, period, ages) is
 * left to lm_bus_take. For any other outcome *event is left alone. Any contents of *frame are safe.
 *
 * Halves of a DOUBLE are joined when they have the same identifier, channel and node, adjacent
 * message codes, nothing of that identifier and channel between them, and at most one nominal
 * period between their arrivals. That alone would join the second half of one value to the first
 * half of the next whenever a frame is lost, and then for ever; so a sender's habit is learnt
 * (mates are those nearer in time) and only mates are joined. While the habit is not known the
 * limit is half a period, so that a sender at the nominal rate is never misread; one that is
 * faster, and whose very first half was lost, may give one value whose halves are neighbours, wrong
 * by 14 m at most. A lone half never makes a value. */
enum lm_bus_outcome lm_canas_take(struct lm_canas *c, const struct lm_bus_profile *profile,
                                  const struct lm_can_frame *frame, struct lm_bus_event *event);

/* Can a row of this field take this type? FLOAT, whole numbers, SHORT2; halves of a DOUBLE for
 * latitude and longitude; three or four single bytes for the clock. */
bool lm_canas_fits(enum lm_bus_field field, uint8_t type);

#endif
