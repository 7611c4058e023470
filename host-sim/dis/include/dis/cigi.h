/* CIGI: what a host tells an image generator (Common Image Generator Interface, versions 3.0 to
 * 3.3), as far as it tells of vehicles. Its entities go into the gateway beside those of DIS.
 *
 * A datagram is one message: an IG Control packet, then others. Each packet begins with its number
 * and its length in bytes. Numbers are in the host's byte order, which the magic number 0x8000 of
 * IG Control tells.
 *
 * Source of the layouts: Wireshark's dissector packet-cigi.c, the Perl library Rinchi::CIGIPP and
 * the C++ library github.com/Dnarok/cigi, which agree in every field that is read here.
 *
 * Every byte is hostile: nothing is read beyond the length that a packet names, nor beyond the
 * datagram, and no number that is not finite or out of its range comes out. */
#ifndef DIS_CIGI_H
#define DIS_CIGI_H

#include "dis/gateway.h"

enum dis_cigi_opcode {
    DIS_CIGI_IG_CONTROL = 1,
    DIS_CIGI_ENTITY_CONTROL = 2,
    DIS_CIGI_CLAMPED_ENTITY = 3,
    DIS_CIGI_RATE_CONTROL = 8
};

struct dis_cigi_message {
    const uint8_t *bytes; /* borrowed */
    size_t length, offset;
    bool is_little_endian, has_time;
    uint32_t time_10us; /* of the host, if has_time */
};

struct dis_cigi_packet {
    uint8_t opcode;
    const uint8_t *bytes; /* `length` of them, all in the datagram */
    size_t length;
    bool is_little_endian;
};

/* Entity Control, or Conformal Clamped Entity Control, which has no type, state and height. */
struct dis_cigi_entity {
    uint16_t id, type;
    bool is_active, is_child, is_clamped;
    double latitude_deg, longitude_deg;
    double height_m; /* above mean sea level; of a clamped one above the ground */
    double yaw_deg, pitch_deg, roll_deg;
};

/* Rates of a whole entity. */
struct dis_cigi_rate {
    uint16_t id;
    bool is_of_part; /* of a part of it: not its motion */
    bool is_local;   /* along the axes of the body; else north, east, down */
    double rate_m_s[3];
};

/* Begin a message: its first packet must be IG Control of version 3. DIS_FAULT_NONE, or why the
 * datagram is refused: DIS_FAULT_HEADER, DIS_FAULT_TRUNCATED, DIS_FAULT_SHORT, or
 * DIS_FAULT_PROTOCOL for another version or no magic number. */
enum dis_fault dis_cigi_begin(struct dis_cigi_message *m, const uint8_t *bytes, size_t length);

/* Step to the next packet: DIS_STEP_PDU, DIS_STEP_END, or DIS_STEP_BROKEN with *fault. */
enum dis_step dis_cigi_next(struct dis_cigi_message *m, struct dis_cigi_packet *packet,
                            enum dis_fault *fault);

/* Read a packet of that opcode. DIS_FAULT_NONE, DIS_FAULT_SHORT, DIS_FAULT_NUMBER, or
 * DIS_FAULT_PLACE, DIS_FAULT_SPEED. */
enum dis_fault dis_cigi_entity_read(const struct dis_cigi_packet *packet,
                                    struct dis_cigi_entity *entity);
enum dis_fault dis_cigi_clamped_read(const struct dis_cigi_packet *packet,
                                     struct dis_cigi_entity *entity);
enum dis_fault dis_cigi_rate_read(const struct dis_cigi_packet *packet, struct dis_cigi_rate *rate);

/* What is known of the host's entities, and the gateway that they go to.
 *
 * - Entity 0 is the ownship.
 * - An entity is the type 0.DOMAIN.NUMBER of the table of kinds, NUMBER its Entity Type and DOMAIN
 * 1 for a clamped one, 2 else.
 * - Its velocity is that of Rate Control, or that of its places over DIS_CIGI_SPAN_S; one that is
 * not told for DIS_CIGI_STOP_S stands.
 * - It stays until it is not active any more, or the host is silent for the gateway's time-out.
 * - One that is attached to another is passed over. */
#define DIS_CIGI_SPAN_S 0.25
#define DIS_CIGI_STOP_S 0.5

struct dis_cigi;

/* `gateway` is borrowed; its ownship should be 0:0:0. NULL, with the error reported, when there is
 * no memory. */
struct dis_cigi *dis_cigi_new(struct dis_gateway *gateway, const struct dis_sea_level *sea);
void dis_cigi_free(struct dis_cigi *c);

/* Take a datagram that came at `now_us`; then call dis_gateway_step. */
void dis_cigi_take(struct dis_cigi *c, const uint8_t *bytes, size_t length, int64_t now_us);

#endif
