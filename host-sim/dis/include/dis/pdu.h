/* PDU: the messages of DIS (IEEE 1278.1), versions 6 and 7, as they lie in a datagram. Those that
 * tell of vehicles, or start and stop an exercise, are read; the others are stepped over.
 *
 * Source of the layouts: IEEE Std 1278.1-2012, 6.2 (records) and 7.2.2, 7.2.3, 7.5.4, 7.5.5 (PDUs);
 * the same fields stand in IEEE Std 1278.1a-1998. Numbers are big-endian.
 *
 * Every byte is hostile: nothing is read beyond the length that the header names, nor beyond the
 * datagram, and no number that is not finite or lies off the Earth comes out. */
#ifndef DIS_PDU_H
#define DIS_PDU_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum dis_pdu_type {
    DIS_ENTITY_STATE = 1,
    DIS_START_RESUME = 13,
    DIS_STOP_FREEZE = 14,
    DIS_ENTITY_STATE_UPDATE = 67
};

enum { DIS_HEADER_BYTES = 12, DIS_ENTITY_STATE_BYTES = 144, DIS_DATAGRAM_MAX = 65536 };

/* What a step through a datagram meets. */
enum dis_step {
    DIS_STEP_END,     /* nothing is left, or fewer than 8 zero bytes of filling */
    DIS_STEP_PDU,     /* a PDU of version 6 or 7 */
    DIS_STEP_VERSION, /* a PDU of version 1 to 5; stepped over */
    DIS_STEP_BROKEN   /* none: the rest of the datagram is not to be trusted and is given up */
};

/* Why a PDU is refused. */
enum dis_fault {
    DIS_FAULT_NONE,
    DIS_FAULT_HEADER,    /* fewer than 12 bytes are left, or the length named is less */
    DIS_FAULT_PROTOCOL,  /* a version that the standard does not have: this is no DIS */
    DIS_FAULT_TRUNCATED, /* the length named is more than is left of the datagram */
    DIS_FAULT_SHORT,     /* the PDU is shorter than its fields and its variable records */
    DIS_FAULT_NUMBER,    /* a number that is not finite */
    DIS_FAULT_PLACE,     /* a place that is not near the Earth: dis/earth.h */
    DIS_FAULT_SPEED,     /* faster than 12 km/s, 1 km/s2 or 100 rad/s */
    DIS_FAULT_ID,        /* an entity without a number, or one that means "all" */
    DIS_FAULT_COUNT
};

struct dis_pdu {
    uint8_t version, exercise, type;
    uint32_t timestamp;   /* as sent: dis_timestamp_s */
    const uint8_t *bytes; /* borrowed from the datagram; the header included */
    size_t length;        /* DIS_HEADER_BYTES or more; all of it lies in the datagram */
};

struct dis_datagram {
    const uint8_t *bytes; /* borrowed */
    size_t length, offset;
};

struct dis_id {
    uint16_t site, application, entity;
};

struct dis_type {
    uint8_t kind, domain;
    uint16_t country;
    uint8_t category, subcategory, specific, extra;
};

/* Position and axes are geocentric: metres from the Earth's centre, x through 0 N 0 E, y through
 * 0 N 90 E, z through the north pole. Velocity and acceleration are so too, or along the body's
 * axes, as the algorithm of dead reckoning says. */
struct dis_motion {
    double place_m[3];
    double velocity_m_s[3], acceleration_m_s2[3];
    double psi_rad, theta_rad, phi_rad; /* axes of the Earth to axes of the body: z, then y, x */
    double turn_rad_s[3];               /* about the axes of the body */
    uint8_t algorithm;                  /* as sent: dis/reckon.h */
    bool is_frozen;                     /* it stands, whatever the velocity says */
};

struct dis_entity_state {
    struct dis_id id;
    uint8_t force;
    struct dis_type type;
    struct dis_motion motion;
    bool is_deactivated; /* the entity leaves the exercise with this PDU */
    bool is_update;      /* an update: type, force, algorithm, acceleration and turn are not told */
    char marking[12];    /* printable ASCII, ended by 0; others are '?' */
};

/* A Start/Resume or Stop/Freeze PDU. */
struct dis_command {
    bool is_start;
    struct dis_id sender, receiver; /* 65535 in a place of the receiver: all */
    double real_s, exercise_s;      /* seconds since 1970-01-01; exercise_s: of a start only */
    uint8_t reason, behaviour;      /* of a stop only */
};

/* Begin a datagram of `length` bytes, and step to its next PDU. `pdu` is written for
 * DIS_STEP_PDU and DIS_STEP_VERSION, *fault for DIS_STEP_BROKEN. */
void dis_datagram_begin(struct dis_datagram *d, const uint8_t *bytes, size_t length);
enum dis_step dis_datagram_next(struct dis_datagram *d, struct dis_pdu *pdu, enum dis_fault *fault);

/* Read an Entity State or Entity State Update PDU, or a Start/Resume or Stop/Freeze. Return
 * DIS_FAULT_NONE, or why the PDU is refused; what was written is then not to be used. */
enum dis_fault dis_entity_state_read(const struct dis_pdu *pdu, struct dis_entity_state *state);
enum dis_fault dis_command_read(const struct dis_pdu *pdu, struct dis_command *command);

/* Seconds after the full hour, 0..3600, and whether they are the UTC hour's (absolute). */
double dis_timestamp_s(uint32_t timestamp, bool *is_absolute);

/* The cause in words, "shorter than its fields", and its key in a report, "short". */
const char *dis_fault_text(enum dis_fault fault);
const char *dis_fault_key(enum dis_fault fault);

#endif
