/* CANaerospace V1.7 (Stock Flight Systems, revision of 12.1.2006), the part a display listens to:
 * one frame of the bus in, at most one value in fixed point out. One const table says what is
 * taken; the decoder, the socket's filters and docs/FORMATS.md section 2 all follow from it.
 *
 * Nothing here ever decides by message code whether a frame is new: a sender that restarts, repeats
 * or never counts is heard from its first frame on. The code serves to join the halves of a DOUBLE
 * and to count breaks. */
#ifndef LM_CANAS_H
#define LM_CANAS_H

#include <stdbool.h>
#include <stdint.h>

#include "lm/port.h"

/* What is taken from the bus; also the row in lm_canas_table. Signs are those of ISO 1151 as the
 * specification prescribes: nose up, right wing down and nose right are positive. */
enum lm_canas_field {
    LM_CANAS_LATITUDE,
    LM_CANAS_LONGITUDE,
    LM_CANAS_GPS_HEIGHT, /* above the ellipsoid */
    LM_CANAS_GROUND_SPEED,
    LM_CANAS_TRUE_TRACK,
    LM_CANAS_PITCH,
    LM_CANAS_ROLL,
    LM_CANAS_HEADING, /* true or magnetic: the specification does not say */
    LM_CANAS_TRUE_HEADING,
    LM_CANAS_BARO_ALTITUDE, /* corrected by the altimeter setting, about above mean sea level */
    LM_CANAS_TRUE_ALTITUDE, /* above mean sea level */
    LM_CANAS_ALTITUDE_RATE,
    LM_CANAS_EAST_VELOCITY,
    LM_CANAS_NORTH_VELOCITY,
    LM_CANAS_UP_VELOCITY,
    LM_CANAS_PITCH_RATE,
    LM_CANAS_YAW_RATE,
    LM_CANAS_UTC,
    LM_CANAS_FIELDS
};

/* What the number of a value means. */
enum lm_canas_unit {
    LM_CANAS_BAM,    /* angle: cast to fx_bam_t, or keep it signed; a rate is BAM a second */
    LM_CANAS_Q6,     /* metres * 64 */
    LM_CANAS_MM_S,   /* millimetres a second */
    LM_CANAS_SECONDS /* since midnight; 86,400 is a leap second */
};

/* Data type codes (byte 1) that some row takes; `types` of a row is a set of 1u << code. */
enum {
    LM_CANAS_NODATA = 0,
    LM_CANAS_ERROR = 1,
    LM_CANAS_FLOAT = 2,
    LM_CANAS_LONG =
        3, /* not in the specification for positions, but some senders use it: 1e-7 degree */
    LM_CANAS_SHORT2 = 12, /* value and full scale: value * scale / 32767 */
    LM_CANAS_CHAR4 = 15,  /* hours, minutes, seconds, 0 */
    LM_CANAS_DOUBLEH = 30,
    LM_CANAS_DOUBLEL = 31
};

struct lm_canas_row {
    const char *name;
    uint32_t types;
    int32_t low, high;  /* what is believed, both ends included; in the unit of the bus: deg, deg/s,
                           m, m/s, s */
    uint32_t period_us; /* nominal, from the specification's example; see FORMATS.md where it gives
                           none */
    uint16_t id;        /* on channel 0; channel n adds 65536 * n */
    uint8_t unit;       /* enum lm_canas_unit */
    uint16_t stale_ms;  /* older than this: flagged */
    uint16_t dead_ms;   /* older than this: removed */
};

/* One row for each field, in the order of enum lm_canas_field. */
extern const struct lm_canas_row lm_canas_table[LM_CANAS_FIELDS];

/* What became of a frame. Each frame has exactly one outcome, and each outcome its counter. */
enum lm_canas_outcome {
    LM_CANAS_VALUE,    /* the event is filled */
    LM_CANAS_HALF,     /* half of a DOUBLE, kept until the other one comes */
    LM_CANAS_NOT_DATA, /* remote frame, or the controller's report of an error */
    LM_CANAS_FOREIGN,  /* no identifier of CANaerospace: 29 bits on channel 0, or bits 11..15 set */
    LM_CANAS_OTHER_CHANNEL, /* a redundancy channel above 0; not used yet */
    LM_CANAS_UNUSED,        /* an identifier without a row */
    LM_CANAS_BAD_LENGTH,    /* too short for a header, or not 4 + what the type says */
    LM_CANAS_BAD_NODE,      /* node 0, which can only be addressed, as the sender */
    LM_CANAS_BAD_TYPE,      /* a type that this identifier does not take */
    LM_CANAS_NO_DATA,       /* NODATA or ERROR: the sender says that it has no value */
    LM_CANAS_NOT_A_NUMBER,  /* NaN, an infinity, a SHORT2 without a scale */
    LM_CANAS_OUT_OF_RANGE,
    LM_CANAS_OUTCOMES
};

struct lm_canas_event {
    enum lm_canas_field field;
    int32_t value;    /* in the row's unit */
    bool is_coarse;   /* came as SHORT2, whose step is the scale / 32767: 612 m for a latitude of
                         scale 180 */
    uint8_t node;     /* of the sender */
    uint64_t time_us; /* of arrival; for a DOUBLE that of the half that came first, when the value
                         existed already */
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

/* What the decoder remembers; the caller owns it. Counters only ever grow. */
struct lm_canas {
    struct lm_canas_pair pair[2]; /* latitude, longitude */
    struct {
        uint8_t node, code; /* node 0: nothing heard yet */
    } last[LM_CANAS_FIELDS];
    struct {
        uint32_t frames; /* all that were offered: the sum of the outcomes */
        uint32_t outcome[LM_CANAS_OUTCOMES];
        uint32_t torn_pairs;      /* halves dropped without their mate */
        uint32_t sequence_breaks; /* message code not one more than the last: lost, repeated or
                                     restarted */
    } count;
};

void lm_canas_init(struct lm_canas *c);

/* Decode a frame. *event is filled for LM_CANAS_VALUE and left alone otherwise. Any contents of
 * *frame are safe.
 *
 * Halves of a DOUBLE are joined when they have the same identifier and node, adjacent message
 * codes, nothing of that identifier between them, and at most one nominal period between their
 * arrivals. That alone would join the second half of one value to the first half of the next
 * whenever a frame is lost, and then for ever; so a sender's habit is learnt (mates
 * are those nearer in time) and only mates are joined. While the habit is not known the limit is
 * half a period, so that a sender at the nominal rate is never misread; one that is faster, and
 * whose very first half was lost, may give one value whose halves are neighbours, wrong by 14 m at
 * most. A lone half never makes a value.
 *
 * Cost: 270 instructions for a value (x86-64, gcc -O2, counted). */
enum lm_canas_outcome lm_canas_take(struct lm_canas *c, const struct lm_can_frame *frame,
                                    struct lm_canas_event *event);

#endif
