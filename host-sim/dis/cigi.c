#include "dis/cigi.h"

#include "bytes.h"
#include "dis/earth.h"

#include <math.h>

/* Where the fields stand, in bytes from the beginning of their packet. */
enum {
    AT_OPCODE = 0,
    AT_LENGTH = 1,
    AT_ID = 2,
    PACKET_LEAST = 2,
    CONTROL_MAJOR = 2,
    CONTROL_FLAGS = 4,
    CONTROL_MAGIC = 6,
    CONTROL_TIME = 12,
    CONTROL_LEAST = 8,
    CONTROL_BYTES = 24, /* from version 3.2 on; 16 before */
    ENTITY_FLAGS = 4,
    ENTITY_TYPE = 8,
    ENTITY_ROLL = 12,
    ENTITY_PITCH = 16,
    ENTITY_YAW = 20,
    ENTITY_LATITUDE = 24,
    ENTITY_LONGITUDE = 32,
    ENTITY_HEIGHT = 40,
    ENTITY_BYTES = 48,
    CLAMPED_YAW = 4,
    CLAMPED_LATITUDE = 8,
    CLAMPED_LONGITUDE = 16,
    CLAMPED_BYTES = 24,
    RATE_FLAGS = 5,
    RATE_LINEAR = 8,
    RATE_BYTES = 32
};

enum { MAJOR = 3, TIME_IS_VALID = 1 << 2 };
enum { STATE_MASK = 3, STATE_ACTIVE = 1, IS_ATTACHED = 1 << 2, CLAMP_MASK = 3 << 5 };
enum { RATE_OF_PART = 1, RATE_LOCAL = 2 };

#define RATE_MAX_M_S 12000.0

/* The magic number's bytes in the order of a host with the big end first, and with the little. */
static bool read_order(const uint8_t *magic, bool *is_little_endian)
{
    *is_little_endian = magic[0] == 0x00 && magic[1] == 0x80;
    return *is_little_endian || (magic[0] == 0x80 && magic[1] == 0x00);
}

static void copy(const struct dis_cigi_packet *p, size_t at, size_t count, uint8_t out[8])
{
    for (size_t i = 0; i < count; i++) {
        out[i] = p->bytes[at + (p->is_little_endian ? count - 1 - i : i)];
    }
}

static uint16_t u16_at(const struct dis_cigi_packet *p, size_t at)
{
    uint8_t bytes[8];
    copy(p, at, 2, bytes);
    return dis_u16(bytes);
}

static uint32_t u32_at(const struct dis_cigi_packet *p, size_t at)
{
    uint8_t bytes[8];
    copy(p, at, 4, bytes);
    return dis_u32(bytes);
}

static double f32_at(const struct dis_cigi_packet *p, size_t at)
{
    uint8_t bytes[8];
    copy(p, at, 4, bytes);
    return dis_f32(bytes);
}

static double f64_at(const struct dis_cigi_packet *p, size_t at)
{
    uint8_t bytes[8];
    copy(p, at, 8, bytes);
    return dis_f64(bytes);
}

enum dis_step dis_cigi_next(struct dis_cigi_message *m, struct dis_cigi_packet *packet,
                            enum dis_fault *fault)
{
    const uint8_t *bytes = m->bytes + m->offset;
    const size_t left = m->length - m->offset;
    if (left == 0) {
        return DIS_STEP_END;
    }
    *fault = left < PACKET_LEAST || bytes[AT_LENGTH] < PACKET_LEAST ? DIS_FAULT_HEADER
             : bytes[AT_LENGTH] > left                              ? DIS_FAULT_TRUNCATED
                                                                    : DIS_FAULT_NONE;
    if (*fault != DIS_FAULT_NONE) {
        m->offset = m->length;
        return DIS_STEP_BROKEN;
    }
    *packet =
        (struct dis_cigi_packet){bytes[AT_OPCODE], bytes, bytes[AT_LENGTH], m->is_little_endian};
    m->offset += packet->length;
    return DIS_STEP_PDU;
}

enum dis_fault dis_cigi_begin(struct dis_cigi_message *m, const uint8_t *bytes, size_t length)
{
    struct dis_cigi_packet control;
    enum dis_fault fault = DIS_FAULT_HEADER;
    *m = (struct dis_cigi_message){.bytes = bytes, .length = length};
    if (dis_cigi_next(m, &control, &fault) != DIS_STEP_PDU) {
        return fault;
    }
    if (control.opcode != DIS_CIGI_IG_CONTROL) {
        return DIS_FAULT_PROTOCOL;
    }
    if (control.length < CONTROL_LEAST) {
        return DIS_FAULT_SHORT;
    }
    if (bytes[CONTROL_MAJOR] != MAJOR || !read_order(bytes + CONTROL_MAGIC, &m->is_little_endian)) {
        return DIS_FAULT_PROTOCOL;
    }
    control.is_little_endian = m->is_little_endian;
    m->has_time = control.length >= CONTROL_BYTES && (bytes[CONTROL_FLAGS] & TIME_IS_VALID) != 0;
    m->time_10us = m->has_time ? u32_at(&control, CONTROL_TIME) : 0;
    return DIS_FAULT_NONE;
}

static enum dis_fault check(const struct dis_cigi_entity *e)
{
    const double sum =
        e->latitude_deg + e->longitude_deg + e->height_m + e->yaw_deg + e->pitch_deg + e->roll_deg;
    if (!isfinite(sum)) {
        return DIS_FAULT_NUMBER;
    }
    const bool is_near =
        e->is_child || (fabs(e->latitude_deg) <= 90 && fabs(e->longitude_deg) <= 180 &&
                        e->height_m >= -DIS_DEPTH_MAX_M && e->height_m <= DIS_HEIGHT_MAX_M);
    const bool is_angle =
        fabs(e->yaw_deg) <= 360 && fabs(e->pitch_deg) <= 90 && fabs(e->roll_deg) <= 360;
    return !is_near || !is_angle ? DIS_FAULT_PLACE : DIS_FAULT_NONE;
}

enum dis_fault dis_cigi_entity_read(const struct dis_cigi_packet *packet,
                                    struct dis_cigi_entity *entity)
{
    if (packet->length < ENTITY_BYTES) {
        return DIS_FAULT_SHORT;
    }
    const uint8_t flags = packet->bytes[ENTITY_FLAGS];
    *entity = (struct dis_cigi_entity){
        .id = u16_at(packet, AT_ID),
        .type = u16_at(packet, ENTITY_TYPE),
        .is_active = (flags & STATE_MASK) == STATE_ACTIVE,
        .is_child = (flags & IS_ATTACHED) != 0,
        .is_clamped = (flags & CLAMP_MASK) != 0,
        .latitude_deg = f64_at(packet, ENTITY_LATITUDE),
        .longitude_deg = f64_at(packet, ENTITY_LONGITUDE),
        .height_m = f64_at(packet, ENTITY_HEIGHT),
        .yaw_deg = f32_at(packet, ENTITY_YAW),
        .pitch_deg = f32_at(packet, ENTITY_PITCH),
        .roll_deg = f32_at(packet, ENTITY_ROLL),
    };
    /* Of one that is gone nothing else counts. */
    return entity->is_active ? check(entity) : DIS_FAULT_NONE;
}

enum dis_fault dis_cigi_clamped_read(const struct dis_cigi_packet *packet,
                                     struct dis_cigi_entity *entity)
{
    if (packet->length < CLAMPED_BYTES) {
        return DIS_FAULT_SHORT;
    }
    *entity = (struct dis_cigi_entity){
        .id = u16_at(packet, AT_ID),
        .is_active = true,
        .is_clamped = true,
        .latitude_deg = f64_at(packet, CLAMPED_LATITUDE),
        .longitude_deg = f64_at(packet, CLAMPED_LONGITUDE),
        .yaw_deg = f32_at(packet, CLAMPED_YAW),
    };
    return check(entity);
}

enum dis_fault dis_cigi_rate_read(const struct dis_cigi_packet *packet, struct dis_cigi_rate *rate)
{
    if (packet->length < RATE_BYTES) {
        return DIS_FAULT_SHORT;
    }
    *rate = (struct dis_cigi_rate){.id = u16_at(packet, AT_ID),
                                   .is_of_part = (packet->bytes[RATE_FLAGS] & RATE_OF_PART) != 0,
                                   .is_local = (packet->bytes[RATE_FLAGS] & RATE_LOCAL) != 0};
    double most_m_s = 0;
    for (size_t i = 0; i < 3; i++) {
        rate->rate_m_s[i] = f32_at(packet, RATE_LINEAR + 4 * i);
        if (!isfinite(rate->rate_m_s[i])) {
            return DIS_FAULT_NUMBER;
        }
        most_m_s = fmax(most_m_s, fabs(rate->rate_m_s[i]));
    }
    return most_m_s > RATE_MAX_M_S ? DIS_FAULT_SPEED : DIS_FAULT_NONE;
}
