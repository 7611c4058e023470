#include "dis/pdu.h"

#include "bytes.h"
#include "dis/earth.h"

#include <math.h>

/* Where the fields stand, in bytes from the beginning of the PDU: IEEE Std 1278.1-2012, tables of
 * 6.2.66 (header), 7.2.2 (Entity State), 7.2.3 (Entity State Update), 7.5.4 and 7.5.5. */
enum {
    AT_VERSION = 0,
    AT_EXERCISE = 1,
    AT_TYPE = 2,
    AT_TIMESTAMP = 4,
    AT_LENGTH = 8,
    AT_ID = 12,
    AT_FORCE = 18,
    AT_RECORDS = 19,
    RECORD_BYTES = 16,
    STATE_TYPE = 20,
    STATE_VELOCITY = 36,
    STATE_ALGORITHM = 88,
    STATE_ACCELERATION = 104,
    STATE_TURN = 116,
    STATE_MARKING = 128,
    UPDATE_VELOCITY = 20,
    UPDATE_BYTES = 72,
    /* From the velocity on both have the same order. */
    PLACE_BEHIND = 12,
    ORIENTATION_BEHIND = 36,
    APPEARANCE_BEHIND = 48,
    COMMAND_RECEIVER = 18,
    COMMAND_REAL_TIME = 24,
    START_EXERCISE_TIME = 32,
    START_BYTES = 44,
    STOP_REASON = 32,
    STOP_BYTES = 40
};

enum { NEWEST_VERSION = 7, OLDEST_READ = 6, MARKING_CHARACTERS = 11 };

/* Bits of the appearance of every platform, life form and munition (SISO-REF-010). */
#define APPEARANCE_FROZEN      (UINT32_C(1) << 21)
#define APPEARANCE_DEACTIVATED (UINT32_C(1) << 23)

#define SPEED_MAX_M_S         12000.0
#define ACCELERATION_MAX_M_S2 1000.0
#define TURN_MAX_RAD_S        100.0

void dis_datagram_begin(struct dis_datagram *d, const uint8_t *bytes, size_t length)
{
    *d = (struct dis_datagram){bytes, length, 0};
}

/* Some senders fill a datagram up to a multiple of eight bytes. */
static bool is_filling(const uint8_t *bytes, size_t length)
{
    uint8_t any = 0;
    for (size_t i = 0; i < length; i++) {
        any |= bytes[i];
    }
    return length < 8 && any == 0;
}

static enum dis_fault check_header(const uint8_t *bytes, size_t left)
{
    if (left < DIS_HEADER_BYTES) {
        return DIS_FAULT_HEADER;
    }
    if (bytes[AT_VERSION] < 1 || bytes[AT_VERSION] > NEWEST_VERSION) {
        return DIS_FAULT_PROTOCOL;
    }
    const size_t length = dis_u16(bytes + AT_LENGTH);
    return length < DIS_HEADER_BYTES ? DIS_FAULT_HEADER
           : length > left           ? DIS_FAULT_TRUNCATED
                                     : DIS_FAULT_NONE;
}

enum dis_step dis_datagram_next(struct dis_datagram *d, struct dis_pdu *pdu, enum dis_fault *fault)
{
    const uint8_t *bytes = d->bytes + d->offset;
    const size_t left = d->length - d->offset;
    if (is_filling(bytes, left) && (left == 0 || d->offset > 0)) {
        return DIS_STEP_END;
    }
    *fault = check_header(bytes, left);
    if (*fault != DIS_FAULT_NONE) {
        d->offset = d->length;
        return DIS_STEP_BROKEN;
    }
    *pdu = (struct dis_pdu){.version = bytes[AT_VERSION],
                            .exercise = bytes[AT_EXERCISE],
                            .type = bytes[AT_TYPE],
                            .timestamp = dis_u32(bytes + AT_TIMESTAMP),
                            .bytes = bytes,
                            .length = dis_u16(bytes + AT_LENGTH)};
    d->offset += pdu->length;
    return pdu->version < OLDEST_READ ? DIS_STEP_VERSION : DIS_STEP_PDU;
}

static struct dis_id read_id(const uint8_t *p)
{
    return (struct dis_id){dis_u16(p), dis_u16(p + 2), dis_u16(p + 4)};
}

static struct dis_type read_type(const uint8_t *p)
{
    return (struct dis_type){p[0], p[1], dis_u16(p + 2), p[4], p[5], p[6], p[7]};
}

static void read_floats(const uint8_t *p, double out[3])
{
    for (int i = 0; i < 3; i++) {
        out[i] = dis_f32(p + 4 * i);
    }
}

/* `p`: the velocity, which place, orientation and appearance follow in either PDU. */
static void read_motion(const uint8_t *p, struct dis_motion *m)
{
    double angles_rad[3];
    read_floats(p, m->velocity_m_s);
    for (int i = 0; i < 3; i++) {
        m->place_m[i] = dis_f64(p + PLACE_BEHIND + 8 * i);
    }
    read_floats(p + ORIENTATION_BEHIND, angles_rad);
    m->psi_rad = angles_rad[0];
    m->theta_rad = angles_rad[1];
    m->phi_rad = angles_rad[2];
    m->is_frozen = (dis_u32(p + APPEARANCE_BEHIND) & APPEARANCE_FROZEN) != 0;
}

static void read_marking(const uint8_t *p, char out[MARKING_CHARACTERS + 1])
{
    for (int i = 0; i < MARKING_CHARACTERS; i++) {
        const uint8_t c = p[1 + i]; /* p[0] is the character set */
        out[i] = (char)(c == 0 || (c >= ' ' && c <= '~') ? c : '?');
    }
    out[MARKING_CHARACTERS] = '\0';
}

/* False also for what is not a number. */
static bool is_within(const double v[3], double most)
{
    return hypot(hypot(v[0], v[1]), v[2]) <= most;
}

static bool is_finite(const double v[3])
{
    return isfinite(v[0]) && isfinite(v[1]) && isfinite(v[2]);
}

static enum dis_fault check_motion(const struct dis_motion *m)
{
    const double angles_rad[3] = {m->psi_rad, m->theta_rad, m->phi_rad};
    if (!is_finite(m->place_m) || !is_finite(m->velocity_m_s) || !is_finite(angles_rad) ||
        !is_finite(m->acceleration_m_s2) || !is_finite(m->turn_rad_s)) {
        return DIS_FAULT_NUMBER;
    }
    if (!dis_is_near_earth(m->place_m)) {
        return DIS_FAULT_PLACE;
    }
    return is_within(m->velocity_m_s, SPEED_MAX_M_S) &&
                   is_within(m->acceleration_m_s2, ACCELERATION_MAX_M_S2) &&
                   is_within(m->turn_rad_s, TURN_MAX_RAD_S)
               ? DIS_FAULT_NONE
               : DIS_FAULT_SPEED;
}

static enum dis_fault check_id(const struct dis_id *id)
{
    const bool is_one = id->entity != 0 && id->entity != UINT16_MAX && id->site != UINT16_MAX &&
                        id->application != UINT16_MAX;
    return is_one ? DIS_FAULT_NONE : DIS_FAULT_ID;
}

enum dis_fault dis_entity_state_read(const struct dis_pdu *pdu, struct dis_entity_state *state)
{
    const uint8_t *p = pdu->bytes;
    const bool is_update = pdu->type == DIS_ENTITY_STATE_UPDATE;
    const size_t fixed = is_update ? UPDATE_BYTES : DIS_ENTITY_STATE_BYTES;
    if (pdu->length < fixed || pdu->length < fixed + (size_t)p[AT_RECORDS] * RECORD_BYTES) {
        return DIS_FAULT_SHORT;
    }
    const uint8_t *moving = p + (is_update ? UPDATE_VELOCITY : STATE_VELOCITY);
    *state = (struct dis_entity_state){.id = read_id(p + AT_ID), .is_update = is_update};
    read_motion(moving, &state->motion);
    state->is_deactivated = (dis_u32(moving + APPEARANCE_BEHIND) & APPEARANCE_DEACTIVATED) != 0;
    if (!is_update) {
        state->force = p[AT_FORCE];
        state->type = read_type(p + STATE_TYPE);
        state->motion.algorithm = p[STATE_ALGORITHM];
        read_floats(p + STATE_ACCELERATION, state->motion.acceleration_m_s2);
        read_floats(p + STATE_TURN, state->motion.turn_rad_s);
        read_marking(p + STATE_MARKING, state->marking);
    }
    const enum dis_fault fault = check_id(&state->id);
    return fault != DIS_FAULT_NONE ? fault : check_motion(&state->motion);
}

/* A clock time: hours since 1970, signed, and a part of the hour as in a timestamp. */
static double read_clock_s(const uint8_t *p)
{
    bool is_absolute;
    return (double)(int32_t)dis_u32(p) * 3600 + dis_timestamp_s(dis_u32(p + 4), &is_absolute);
}

enum dis_fault dis_command_read(const struct dis_pdu *pdu, struct dis_command *command)
{
    const uint8_t *p = pdu->bytes;
    const bool is_start = pdu->type == DIS_START_RESUME;
    if (pdu->length < (is_start ? START_BYTES : STOP_BYTES)) {
        return DIS_FAULT_SHORT;
    }
    *command = (struct dis_command){.is_start = is_start,
                                    .sender = read_id(p + AT_ID),
                                    .receiver = read_id(p + COMMAND_RECEIVER),
                                    .real_s = read_clock_s(p + COMMAND_REAL_TIME)};
    if (is_start) {
        command->exercise_s = read_clock_s(p + START_EXERCISE_TIME);
    } else {
        command->reason = p[STOP_REASON];
        command->behaviour = p[STOP_REASON + 1];
    }
    return DIS_FAULT_NONE;
}

double dis_timestamp_s(uint32_t timestamp, bool *is_absolute)
{
    *is_absolute = (timestamp & 1) != 0;
    return (double)(timestamp >> 1) * (3600.0 / 2147483648.0);
}

static const char *const fault_words[DIS_FAULT_COUNT][2] = {
    [DIS_FAULT_NONE] = {"none", "none"},
    [DIS_FAULT_HEADER] = {"no whole header", "header"},
    [DIS_FAULT_PROTOCOL] = {"of another protocol or version", "protocol"},
    [DIS_FAULT_TRUNCATED] = {"longer than what is left of its datagram", "truncated"},
    [DIS_FAULT_SHORT] = {"shorter than its fields", "short"},
    [DIS_FAULT_NUMBER] = {"a number that is not finite", "number"},
    [DIS_FAULT_PLACE] = {"a place that is not near the Earth", "place"},
    [DIS_FAULT_SPEED] = {"faster than anything that moves", "speed"},
    [DIS_FAULT_ID] = {"an entity without a number of its own", "id"},
};

const char *dis_fault_text(enum dis_fault fault)
{
    return fault_words[fault][0];
}

const char *dis_fault_key(enum dis_fault fault)
{
    return fault_words[fault][1];
}
